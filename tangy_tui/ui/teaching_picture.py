"""The teaching screen's view of a session: steps, room, dialogue, and the current state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from textual.geometry import Region
from textual.screen import Screen
from textual.widgets import Static

from tangy_profiles.state import ActivityState, Situation
from tangy_tui.app.tour import Tour, TourStop
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.conflicts import called_wrong
from tangy_tui.learning.coverage import Coverage, coverage, missing_words, standing
from tangy_tui.learning.library import read_library
from tangy_tui.learning.teaching_events import (
    Announced,
    Begun,
    Executed,
    Finished,
    NoRule,
    Remark,
    Ruled,
    RuleUndone,
    Settled,
    StepUndone,
    TeachingEvent,
)
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.monitoring.attention import goes_to_people
from tangy_tui.text import teaching as text
from tangy_tui.text.activities import with_activity
from tangy_tui.text.coach import arranged_words, coach_words, unseen_words, with_examples
from tangy_tui.text.keys import with_keys
from tangy_tui.text.remarks import remark_words, settled_words
from tangy_tui.text.situations import step_words
from tangy_tui.text.tour import tour_words
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.panels import KeyLine
from tangy_tui.ui.screens.teach_keys import TOUR_GOES_ON, TOUR_KEYS
from tangy_tui.ui.widgets.call_board import CallBoard
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.coverage_list import CoverageList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.sayable_list import SayableList
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript


class ShownSoFar:
    """Counts the situations of a session; reads the library once per game, not per step."""

    def __init__(self, workspace: Workspace, teaching: TeachingSession) -> None:
        self._workspace = workspace
        self._teaching = teaching
        self._before = Coverage(dict.fromkeys(workspace.activity.situations, 0))

    def begin(self) -> None:
        """Count the situations shown before this game, without those it replaces."""
        activity, present = self._workspace.activity, self._teaching.demonstration
        replaced = {present.id, *present.of}
        finished = read_library(self._workspace.store, activity.name).finished
        self._before = coverage(activity, [d for d in finished if d.id not in replaced])

    def now(self) -> Coverage:
        """Count all situations shown up to now."""
        here = self.here().times
        return Coverage({s: times + here[s] for s, times in self._before.times.items()})

    def here(self) -> Coverage:
        """Count the situations shown in this game; a step counts once it is no slip."""
        shown = standing(self._teaching.demonstration, self._teaching.remark)
        return coverage(self._workspace.activity, [shown])

    def first(self, situation: Situation) -> bool:
        """Return whether the last step was the first one ever in its situation."""
        here = coverage(self._workspace.activity, [self._teaching.demonstration])
        return self._before.times.get(situation, 0) + here.times.get(situation, 0) == 1


WRAPPING = 14  # characters that wrapping may waste on two lines
NOW_LINES = 2  # of what is going on
DRIVING_PACE = 4.0
"""The speed-up of the robot's animation, so that nobody waits for it."""


class TeachingPicture:
    """Shows a session on the widgets of its screen."""

    def __init__(
        self,
        screen: Screen[Any],
        workspace: Workspace,
        teaching: TeachingSession,
        keys: Callable[[], Sequence[str]] = tuple,
    ) -> None:
        """Create the view; `keys` are those at the foot without a tour."""
        self._screen, self._keys = screen, keys
        self._workspace = workspace
        self._teaching = teaching
        self._shown = ShownSoFar(workspace, teaching)
        self._new: Situation | None = None  # of the last step, and not told yet
        self.tour: Tour | None = None
        """The tour, while a new teacher takes it."""

    def tell(self, event: TeachingEvent, *, asked: bool) -> None:
        """Show the result of a command; an `asked` remark is shown in its dialog only."""
        if isinstance(event, Remark):
            if not asked:
                self.remark(event)
            return
        match event:
            case Executed():
                self.step(event)
            case Settled():
                self._log.write(settled_words(event, self._teaching.activity), "dim")
                self.mark_wrong()
            case Announced(arranged):
                words = arranged_words(self._teaching.activity, arranged, self._teaching.name)
                self._log.write(words, "good")
            case Ruled() | RuleUndone() | NoRule():
                refused = isinstance(event, NoRule)
                words = text.rule_words(event, self._teaching.activity)
                self._log.write(words, "warn" if refused else "good")
                if not isinstance(event, NoRule):
                    self._rule(event)
            case StepUndone():
                self._screen.query_one(Transcript).remove_last()
            case Begun(_, resumed):
                self.beginning(resumed)
            case Finished():
                self._log.write(text.complete_words(self._teaching), "good")

    def mark_wrong(self) -> None:
        """Mark the steps that a teacher called wrong."""
        library = read_library(self._workspace.store, self._teaching.activity.name)
        steps = self._teaching.demonstration.steps
        wrong = [called_wrong(library.resolutions, step) for step in steps]
        for shown in self._screen.query(Transcript):
            if shown.count == len(steps):
                shown.mark_wrong(wrong)

    def _rule(self, event: Ruled | RuleUndone) -> None:
        """Show the last step as a rule, or again as a step."""
        rule = event if isinstance(event, Ruled) else event.rule
        activity, steps = self._teaching.activity, self._screen.query_one(Transcript)
        words = step_words(activity, rule.step, self._teaching.name)
        steps.remove_last()
        steps.append(
            text.ruled_step(words, rule.facts, activity) if isinstance(event, Ruled) else words
        )

    def step(self, event: Executed) -> None:
        """Show a completed step."""
        activity, situation = self._teaching.activity, event.step.state.situation
        self._screen.query_one(Transcript).append(
            step_words(activity, event.step, self._teaching.name, event.outcome.numbers)
        )
        self._tell_new()
        self._new = situation if self._shown.first(situation) else None
        if self._stands:
            self._tell_new()
        self._log.write(event.speech)
        self._screen.query_one(RoomView).say(event.speech)
        self._scene(event.step.state.place)

    @property
    def _stands(self) -> bool:
        shown = self._teaching.demonstration
        return standing(shown, self._teaching.remark) is shown

    def _tell_new(self) -> None:
        """Tell that the last step was in a situation new to Tangy, once the step stands."""
        if self._new is not None:
            words = self._teaching.activity.in_words(self._new)
            self._log.write(text.new_words(words), "good")
            self._new = None

    def remark(self, remark: Remark) -> None:
        """Show a remark on a step that may have overlooked something."""
        teaching = self._teaching
        game = teaching.demonstration.id
        self._log.write(remark_words(remark, teaching.activity, teaching.name, game), "warn")

    def undone(self, undone: Sequence[StepUndone]) -> None:
        """Show steps that were undone, the last one first."""
        words = text.undone_words(undone, self._teaching.activity)
        self._log.write(self._told(words), "warn")
        self._new = None
        self.mark_wrong()
        self._screen.query_one(RoomView).say("")
        self._scene(self._teaching.world.observe().place)

    def beginning(self, resumed: bool) -> None:
        """Show the start of a game, or a resumed one with its steps."""
        teaching = self._teaching
        shown = teaching.demonstration
        self._shown.begin()
        self._new = None
        self._screen.query_one(Transcript).fill(
            [
                step_words(teaching.activity, step, teaching.name, numbers)
                for step, numbers in zip(shown.steps, teaching.numbers, strict=True)
            ]
        )
        self.mark_wrong()
        self._scene(teaching.world.observe().place)
        goes_on = resumed or shown.origin == "again"
        words = text.beginning_words(teaching, resumed=resumed)
        self._log.write(words, "good" if goes_on else "dim")

    def state(self) -> None:
        """Show the stage of the game, and the coverage so far."""
        teaching = self._teaching
        shown = teaching.demonstration
        state = teaching.world.observe()
        if self._stands:
            self._tell_new()
        found = self._shown.now()
        self._coverage(found)
        mode = "guided" if shown.guided else "teach"
        self._screen.query_one(StatusLine).show(
            Status(
                mode=with_activity(mode, teaching.activity),
                seen=f"{len(found.seen)}/{len(found.times)}",
                step=len(shown.steps),
                note=f"game {shown.seed}, {shown.teacher}",
            )
        )
        self._now(self._told(text.OVER) if shown.finished else self._coach(state))
        if shown.finished:
            self._screen.query_one(SayableList).show(text.AFTERWARDS)
        else:
            self._screen.query_one(SayableList).show(teaching.sayable)
        self._screen.query_one(CallBoard).show(teaching.world.scene().called)

    def _coach(self, state: ActivityState) -> str:
        teaching = self._teaching
        activity, wide = teaching.activity, self._screen.size.width - 2
        said = coach_words(activity, state, teaching.world.scene(), teaching.name)
        room = NOW_LINES * wide - WRAPPING * (NOW_LINES - 1) - len(text.now_words(""))
        return with_examples(said, activity, state, teaching.sayable, room)

    def _now(self, words: str) -> None:
        """Show the coach's line; during the tour, the tour's line."""
        at = None if self.tour is None else self.tour.at
        now = self._screen.query_one("#now", Static)
        now.set_class(at is not None, "-tour")
        now.update(text.now_words(words) if at is None else self._tour_words(at))
        if self.tour is not None:
            keys = self._keys() if at is None else TOUR_KEYS
            goes_on = (TOUR_GOES_ON,) if self.tour.enter_goes_on else ()
            self._screen.query_one(KeyLine).show(*goes_on, *keys, typing=True)

    def tours(self, *, skip: bool) -> bool:
        """Return whether there is a tour that can be skipped, or continued with Enter."""
        if self.tour is None or self.tour.at is None:
            return False
        return skip or (
            self.tour.enter_goes_on and not any(bar.text for bar in self._screen.query(CommandBar))
        )

    def go_on_tour(self, *, skip: bool = False) -> None:
        """Go to the next stop of the tour, or end it."""
        if self.tour is not None:
            if skip:
                for bar in self._screen.query(CommandBar):
                    if bar.text or bar.lists:
                        bar.drop()  # Esc first clears the line
                        return
                self.tour.skip()
            else:
                self.tour.go_on()
            self.state()

    def follow_tour(self, events: Sequence[TeachingEvent]) -> None:
        """Continue the tour if the teacher has done what it asks for."""
        if self.tour is not None and self.tour.follow(events):
            self.state()

    def _tour_words(self, at: TourStop) -> str:
        teaching = self._teaching
        phrase = next(iter(teaching.sayable), "")
        visits = goes_to_people(teaching.activity)
        words = tour_words(at, teaching.teacher, teaching.activity.title, phrase, visits=visits)
        return self._told(words)

    def _told(self, words: str) -> str:
        """Insert the keys of actions into a sentence."""
        return with_keys(words, keymap_of(self._screen.app), typing=True)

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
        self._unseen(found, 2)

    def _unseen(self, found: Coverage, lines: int) -> None:
        """Name the missing situations in one or two lines."""
        room = lines * (self._screen.size.width - 4) - WRAPPING * (lines - 1)
        words = unseen_words(self._teaching.activity, found.missing, room)
        self._screen.query_one("#unseen", Static).update(words)

    def covered(self, region: Region) -> None:
        """Keep what is still to show above a dialog that covers a part of it.

        Its own lines may have changed at the same time: they are laid out first.
        """
        self._screen.call_after_refresh(self._keep_above, region)

    def _keep_above(self, region: Region) -> None:
        unseen = self._screen.query_one("#unseen", Static).region
        if region.overlaps(unseen) and region.y > unseen.y:
            self._unseen(self._shown.now(), region.y - unseen.y)

    @property
    def _log(self) -> LogView:
        return self._screen.query_one(LogView)
