"""What the teaching screen shows of a session: the steps, the room, what was seen, what is now."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from textual.screen import Screen
from textual.widgets import Static

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.coverage import Coverage, missing_words
from tangy_tui.learning.teaching_events import (
    Begun,
    Contradicted,
    EndedEarly,
    Executed,
    Finished,
    Overlooked,
    Remark,
    Settled,
    StepUndone,
    TeachingEvent,
    WrongPerson,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text import teaching as text
from tangy_tui.text.remarks import remark_words, settled_words
from tangy_tui.text.situations import state_words, step_words
from tangy_tui.ui.shown_so_far import ShownSoFar
from tangy_tui.ui.widgets.coverage_list import CoverageList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

DRIVING_PACE = 4.0
"""How many times faster than the robot the picture of it drives: nobody waits for a picture."""


class TeachingPicture:
    """Puts what happens in a session on the widgets of its screen."""

    def __init__(
        self, screen: Screen[Any], workspace: Workspace, teaching: TeachingSession
    ) -> None:
        self._screen = screen
        self._workspace = workspace
        self._teaching = teaching
        self._shown = ShownSoFar(workspace, teaching)

    def tell(self, event: TeachingEvent) -> None:
        """Show what followed from a command."""
        match event:
            case Executed():
                self.step(event)
            case Contradicted() | Overlooked() | WrongPerson() | EndedEarly():
                self.remark(event)
            case Settled():
                self._log.write(settled_words(event, self._teaching.activity), "dim")
            case StepUndone():
                self._screen.query_one(Transcript).remove_last()
            case Begun(_, resumed):
                self.beginning(resumed)
            case Finished(demonstration):
                self._log.write(text.complete_words(len(demonstration.steps)), "good")

    def step(self, event: Executed) -> None:
        """Show a step that was carried out."""
        activity, situation = self._teaching.activity, event.step.state.situation
        self._screen.query_one(Transcript).append(
            step_words(activity, event.step, self._teaching.name)
        )
        if self._shown.first(situation):
            self._log.write(text.new_words(activity.in_words(situation)), "good")
        self._log.write(event.speech)
        self._screen.query_one(RoomView).say(event.speech)
        self._scene(event.step.state.place)

    def remark(self, remark: Remark) -> None:
        """Tell of a step that may have overlooked something."""
        teaching = self._teaching
        game = teaching.demonstration.id
        self._log.write(remark_words(remark, teaching.activity, teaching.name, game), "warn")

    def undone(self, undone: Sequence[StepUndone]) -> None:
        """Tell of steps that were taken back, the last one first."""
        self._log.write(text.undone_words(undone), "warn")
        self._screen.query_one(RoomView).say("")
        self._scene(self._teaching.world.observe().place)

    def beginning(self, resumed: bool) -> None:
        """Show a game that begins, or that goes on with the steps it has."""
        teaching = self._teaching
        shown = teaching.demonstration
        self._shown.begin()
        self._screen.query_one(Transcript).fill(
            [step_words(teaching.activity, s, teaching.name) for s in shown.steps]
        )
        self._scene(teaching.world.observe().place)
        goes_on = resumed or shown.origin == "again"
        words = text.beginning_words(teaching, resumed=resumed)
        self._log.write(words, "good" if goes_on else "dim")

    def state(self) -> None:
        """Show where the game is, and what was shown up to here."""
        teaching = self._teaching
        shown = teaching.demonstration
        state = teaching.world.observe()
        found = self._shown.now()
        self._coverage(found)
        self._screen.query_one(StatusLine).show(
            Status(
                mode="guided" if shown.guided else "teach",
                stage=state.stage if not teaching.world.over else "over",
                seen=f"{len(found.seen)}/{len(found.times)}",
                step=len(shown.steps),
                note=f"game {shown.seed}, {teaching.teacher}",
            )
        )
        words = (
            text.OVER
            if teaching.world.over
            else state_words(teaching.activity, state, teaching.world.scene(), teaching.name)
        )
        self._screen.query_one("#now", Static).update(f"Now: {words}")

    def _scene(self, came_from: str) -> None:
        room = self._screen.query_one(RoomView)
        scene = self._teaching.world.scene()
        room.hold(False)
        if came_from != scene.place:
            stand, people = self._workspace.room.stand, self._teaching.people
            way = stand(came_from, people).distance(stand(scene.place, people))
            room.drive(scene.place, way / self._workspace.robot.speed / DRIVING_PACE)
        room.show(scene)

    def _coverage(self, found: Coverage) -> None:
        activity = self._teaching.activity
        seen = [(activity.in_words(s), found.times[s]) for s in found.seen]
        here = len(self._shown.here().seen)
        self._screen.query_one(CoverageList).show(missing_words(activity, found), seen, here)

    @property
    def _log(self) -> LogView:
        return self._screen.query_one(LogView)
