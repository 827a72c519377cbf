"""The view of a game: shows its events on the panels of a screen."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from textual.screen import Screen

from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.speech import with_names
from tangy_profiles.game_records import CallMade, CallStage
from tangy_profiles.planned_game import as_planned
from tangy_profiles.present_moment import as_present
from tangy_profiles.scene import Scene
from tangy_tui.app.staff_view import next_step
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import (
    Acted,
    BeliefUpdated,
    DoneOnce,
    GameBegun,
    GameChanged,
    GameEnded,
    ResumedGame,
    Taught,
    Unsure,
)
from tangy_tui.monitoring.fault import ENDINGS, Diagnosed, FaultEvent, Moved
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.activities import with_activity
from tangy_tui.text.calls import logged_words
from tangy_tui.text.changes import changed_lines
from tangy_tui.text.fault_moves import move_words
from tangy_tui.text.fault_views import WAITS
from tangy_tui.text.faults import kind_words
from tangy_tui.text.games import (
    PRESS_GO_ON,
    begun_words,
    earlier_steps_words,
    ended_words,
    over_words,
    response_words,
    resumed_words,
)
from tangy_tui.text.keys import with_keys
from tangy_tui.text.learnt import replay_words
from tangy_tui.text.messages import GONE, fault_at, fault_message
from tangy_tui.text.situations import OVER_NOW, lesson_words, moment_words, once_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.keys import keymap_of
from tangy_tui.ui.message_history import date_last, remember
from tangy_tui.ui.reasons import DecisionGround, why_asked, why_now, why_row, why_step
from tangy_tui.ui.screens.policy import policy_rows
from tangy_tui.ui.widgets.log_view import Kind, LogView
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.posteriors import Posteriors
from tangy_tui.ui.widgets.room_view import RoomView
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.transcript import Transcript

DRIVING_SHARE = 0.5
"""The fraction of a step's duration in which the robot's drive is animated."""

NOT_DONE = "not done: "
"""The prefix of a behaviour that was not completed."""

TAUGHT_SECONDS = 12.0
"""Duration of the message with the lesson of an answer, in s."""


class GamePicture:
    """Shows the events of games on room, steps, policy, posteriors and log of a screen."""

    def __init__(self, screen: Screen[Any], workspace: Workspace, supervision: Supervision) -> None:
        self.grounds: list[DecisionGround] = []
        """The ground of each step of the present game."""
        self.lesson = ""
        """The lesson of the last answer, until the next question tells it."""
        self.goes_on = False
        """Whether a resumed game continues at once."""
        self.counts: Callable[[], bool] | None = None
        """Whether the time to the next call is counted down; None: the screen is not for staff."""
        self.scene: Callable[[], Scene] = supervision.world.scene
        """Returns the scene to show."""
        self.played: Callable[[], float] = lambda: 0.0
        """Returns the time played, in s."""
        self.over: Callable[[], str] = lambda: OVER_NOW
        """Returns the stage while no game runs."""
        self._stage = self._spoken = ""
        self._step: int | None = None
        self._game: int | None = None
        self._screen = screen
        self._workspace = workspace
        self._supervision = supervision
        self._policy = supervision.policy

    @property
    def said(self) -> str:
        """Tangy's speech in this or the last step of the present game, "" before that.

        In a game that was resumed, it is what the chest screen still shows, such as a question.
        """
        now = as_present(self._supervision.world)
        if now is not None and (said := now.saying or now.said_before):
            return with_names(said, self._workspace.name)
        planned = as_planned(self._supervision.world)
        if planned is not None and planned.said:  # also while it speaks, and besides its steps
            return planned.said
        return self.grounds[-1].acted.speech if self.grounds else ""

    def show_speech(self) -> None:
        """Show what the robot says besides its steps, such as the answer to a claim."""
        planned = as_planned(self._supervision.world)
        said = "" if planned is None else planned.said
        if said != self._spoken:
            self._spoken = said
            self._screen.query_one(RoomView).say(said)

    def forget(self) -> None:
        """Show nothing more that Tangy said in the last game, while the next one begins."""
        self.grounds.clear()
        self._screen.query_one(RoomView).say("")

    def begin(self) -> None:
        """Show the state before the first game."""
        self._show_policy()
        self._show_beliefs(None)

    def tell(self, events: Sequence[Event], pace: float) -> None:
        """Show events; `pace` is a ratio to real time (0: no animation)."""
        taught = next((event for event in events if isinstance(event, Taught | DoneOnce)), None)
        log = self._screen.query_one(LogView)
        for event in events:
            match event:
                case GameBegun(game, _, state) | ResumedGame(game, _, _, state):
                    number = self._supervision.game.log.number(game)
                    resumed = event.steps if isinstance(event, ResumedGame) else 0
                    log.write(self._again(number) if resumed else begun_words(number))
                    room = self._screen.query_one(RoomView)
                    room.say("")
                    room.put(state.place)
                    transcript = self._screen.query_one(Transcript)
                    transcript.clear(resumed, earlier_steps_words(resumed))
                    if isinstance(event, GameBegun) and event.number > 1:
                        app = self._screen.app
                        app.call_later(app.clear_notifications)  # those of the game before
                    self.grounds.clear()
                    self.lesson = ""
                    self._stage = self._workspace.activity.in_words(state.situation)
                    self._game, self._step = number, None
                    self.show_scene(0, drive=False, pace=pace)
                case Acted():
                    self._show_step(event, taught.teacher if taught else "", pace)
                case BeliefUpdated(response, belief):
                    log.write(
                        response_words(response, belief, self._workspace.name),
                        "good" if response.complied else "dim",
                    )
                    self._show_beliefs((response.person, response.strategy))
                case Unsure(_, _, reason):
                    log.write(f"Tangy asks. {reason}", "warn")
                case Taught():
                    self._show_lesson(event)
                case DoneOnce(_, instead):
                    once = once_words(self._workspace.activity.behaviour_words(instead))
                    log.write(once, "good")
                    self._screen.notify(once, markup=False)
                case Diagnosed() | Moved():
                    write_fault(self._screen, event, shows_end=self.counts is not None)
                    self.show_scene(0, drive=False, pace=pace)
                case CallMade():
                    write_call(self._screen, event)
                case GameChanged():
                    lines = changed_lines(event, self._workspace.activity, self._workspace.name)
                    for line in lines:
                        log.write(line.strip())
                    self.show_scene(0, drive=False, pace=pace)
                case GameEnded(stopped=None):
                    words = over_words(event, self._calls)
                    log.write(with_keys(words, keymap_of(self._screen.app)), "good")
                case GameEnded():
                    log.write(ended_words(event, self._calls), "bad")

    @property
    def _calls(self) -> int:
        """How many numbers count as called."""
        planned = as_planned(self._supervision.world)
        return 0 if planned is None else len(planned.called_now)

    def _again(self, number: int) -> str:
        """Tell that a game goes on where it was."""
        how = "" if self.goes_on else with_keys(PRESS_GO_ON, keymap_of(self._screen.app))
        return resumed_words(number, self._calls, self.played(), how)

    def show_status(self, robot: str, note: str, mode: str) -> None:
        """Update the status line: robot, stage and note; for staff without the step."""
        counts = self.counts is not None and self.counts()
        self._screen.query_one(StatusLine).show(
            Status(
                mode=with_activity(mode, self._workspace.activity),
                robot=robot,
                stage="" if counts else self._stage_now(),
                game=self._game,
                step=self._step if self.counts is None else None,
                note=note,
                alarm=robot != "OK" and not robot.startswith(WAITS),
            )
        )

    def show_stage(self) -> None:
        """Update the stage on the status line during a behaviour, if the world tells it."""
        if as_present(self._supervision.world) is None:
            return
        line = self._screen.query_one(StatusLine)
        if line.status.stage != (stage := self._stage_now()):
            line.show(replace(line.status, stage=stage))

    def _stage_now(self) -> str:
        if self._game and self._supervision.over:
            return self.over()
        now = as_present(self._supervision.world)
        if now is not None and self._game:
            self._stage = self._workspace.activity.in_words(joint_state(now.ahead).situation)
        elif self.counts is not None and self._game:  # live: it may change during a step
            ahead = next_step(self._supervision.world, self._supervision.policy)
            if ahead is not None:
                self._stage = self._workspace.activity.in_words(ahead[1].situation)
        return self._stage

    def why(self, chosen: int | None, coming: str = "") -> WhyDialog | None:
        """Explain the chosen step, Tangy's question, or the next step and the last; None: no step.

        `coming` is the next step in words, "" if it is unknown.
        """
        question = self._supervision.question
        if chosen is None and question is not None:
            return why_asked(self._workspace, self._policy, question.state.situation)
        ahead = next_step(self._supervision.world, self._supervision.policy)
        if chosen is None and coming and ahead is not None:
            ground = self.grounds[-1] if self.grounds else None
            ahead_of = coming, ahead[1].situation
            return why_now(self._workspace, self._supervision.policy, ahead_of, ground)
        last = self.grounds[-1].acted.number if self.grounds else 0
        return self.why_step(last if chosen is None else chosen)

    def why_step(self, number: int) -> WhyDialog | None:
        """Explain a step of this game; None: there is no such step."""
        found = (ground for ground in self.grounds if ground.acted.number == number)
        ground = next(found, None)  # a resumed game has no grounds of its earlier steps
        return None if ground is None else why_step(self._workspace, ground, number)

    def why_row(self, index: int) -> WhyDialog:
        """Explain a row of the policy."""
        situation = self._workspace.activity.situations[index]
        return why_row(self._workspace, self._policy, situation)

    def _show_step(self, event: Acted, teacher: str, pace: float) -> None:
        workspace, screen = self._workspace, self._screen
        self.grounds.append(DecisionGround(self._policy, event, teacher))
        words = workspace.activity.in_words(event.state.situation)
        target = f" ({workspace.name(event.action.target)})" if event.action.target else ""
        how = f", {event.choice.strategy}" if event.choice else ""
        who = f", {teacher} answered" if teacher else ""
        done = "" if event.outcome.completed else NOT_DONE
        told = moment_words(workspace.activity, event.state, workspace.name)
        screen.query_one(Transcript).append(
            f"{told} -> {done}{event.action.behaviour.question}{target}{how}{who}"
        )
        screen.query_one(LogView).write(event.speech)
        screen.query_one(RoomView).say(event.speech)
        screen.query_one(PolicyTable).highlight(words)
        if event.choice is not None:
            self._show_beliefs((event.choice.person, event.choice.strategy))
        self._stage = workspace.activity.in_words(event.after.situation)
        self._step = event.number
        self.show_scene(
            event.outcome.seconds, drive=event.state.place != event.after.place, pace=pace
        )

    def _show_lesson(self, taught: Taught) -> None:
        """Show the lesson and the changes in the replay, and the new row of the policy."""
        activity, lesson = self._workspace.activity, taught.lesson
        learnt = lesson_words(activity, lesson)
        log = self._screen.query_one(LogView)
        log.write(learnt, "good")
        replayed = replay_words(activity, lesson.replay)
        log.write(replayed, "warn" if lesson.replay.changed else "good")
        self.lesson = clean(f"{learnt} {replayed}")
        self._screen.notify(
            self.lesson,
            severity="warning" if lesson.replay.changed else "information",
            timeout=TAUGHT_SECONDS,
            markup=False,
        )
        self._policy = lesson.policy
        self._show_policy(activity.in_words(lesson.demonstration.steps[-1].state.situation))

    def _show_policy(self, highlight: str | None = None) -> None:
        rows = policy_rows(self._workspace.activity, self._policy)
        self._screen.query_one(PolicyTable).show(rows, highlight)

    def show_scene(self, seconds: float, *, drive: bool, pace: float) -> None:
        """Show the room after a step of some s, `pace` times as fast as real (0: at once)."""
        room = self._screen.query_one(RoomView)
        scene = self.scene()
        if drive and pace:
            room.drive(scene.place, seconds / pace * DRIVING_SHARE)
        room.show(scene)

    def _show_beliefs(self, highlight: tuple[str, str] | None) -> None:
        beliefs = self._supervision.persuasion.beliefs
        self._screen.query_one(Posteriors).show(beliefs, self._workspace.names, highlight)


CALLS: Mapping[CallStage, Kind] = {"answered": "good", "reached": "good", "failed": "bad"}


def write_call(screen: Screen[Any], made: CallMade) -> None:
    """Write the outcome of a call to the log."""
    words = logged_words(made.role, made.way, made.stage, made.said)
    screen.query_one(LogView).write(words, CALLS.get(made.stage, "warn"))


def write_fault(screen: Screen[Any], event: FaultEvent, *, shows_end: bool = False) -> None:
    """Write a fault or a recovery event to the log and the messages, with Tangy's speech.

    With `shows_end`, a message tells that a fault is over, where the screen hides the log.
    """
    fault, log = event.fault, screen.query_one(LogView)
    if isinstance(event, Moved) and event.move.speech:
        screen.query_one(RoomView).say(event.move.speech)
    if fault.asks_only:
        return  # Tangy's question tells all of it
    kind: Kind = "bad" if fault.critical else "warn"
    if isinstance(event, Diagnosed):
        log.write(f"Fault, {kind_words(fault)}: {fault.name}. {fault.console}", kind)
        remember(screen.app, fault_message(event))
        date_last(screen.app, fault_at(event))
        return
    move = event.move
    if move.kind in ENDINGS:
        kind = "good"
    elif move.kind not in ("halted", "still there", "escalated", "given up"):
        kind = "dim"
    log.write(f"{fault.name}: {move_words(move)}.", kind)
    if move.speech:
        log.write(move.speech)
    if shows_end and move.kind in GONE and not log.display:
        screen.notify(fault_message(event), markup=False)
    else:
        remember(screen.app, fault_message(event))
    date_last(screen.app, fault_at(event))
