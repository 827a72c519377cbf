"""The controller of games: carries out the commands of staff from every interface.

One thread runs a game (calls `next` repeatedly), other threads send commands (`apply`). Urgent
commands reach the robot at once, the rest wait for the current behaviour. All are logged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, TypeAlias, assert_never

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.declared.whom import target_of
from tangy_profiles.errors import TangyError
from tangy_profiles.past_game import PastGame
from tangy_profiles.process_log import serving
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.app.answers import AnswerCollector
from tangy_tui.app.autonomy import AutonomyDial
from tangy_tui.app.fault_commands import Result, attend
from tangy_tui.app.game_commands import (
    AT_ONCE,
    WITHOUT_GAME,
    Accept,
    Acknowledge,
    AskFor,
    CallAgain,
    CallExpert,
    ClaimCard,
    Clear,
    Confirm,
    Drive,
    EndGame,
    GameCommand,
    GiveBack,
    GoOn,
    HasCard,
    Joins,
    OneStep,
    Pause,
    Phase,
    PlanCommand,
    PlanTime,
    Reached,
    SetAutonomy,
    StopRobot,
    TakeOver,
    Tell,
    VoidResponse,
)
from tangy_tui.app.handing_over import HandingOver
from tangy_tui.app.plan_controls import GamePlanControls
from tangy_tui.app.planned_time import PlannedTime
from tangy_tui.app.robot_controls import RobotControls
from tangy_tui.app.staff_notes import Proposal, StaffNote
from tangy_tui.app.staff_view import StaffView, StaffWatch, next_step
from tangy_tui.learning.verification import Verification
from tangy_tui.monitoring.supervision import Event, Supervision

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld

ControllerOutput: TypeAlias = Result | Verification


class GameController(HandingOver):
    """Games in which staff can intervene. `begin` each, then call `next` until it is over."""

    def __init__(
        self,
        supervision: Supervision,
        by: str,
        *,
        robot: LiveWorld | None = None,
        paced: bool = True,
        void: Callable[[str], bool] = lambda person: False,
        past: PastGame | None = None,
    ) -> None:
        """Take charge of games.

        Args:
            supervision: runs the games.
            by: who gives the commands, for the log.
            robot: the world of a real robot; None: the games are simulated.
            paced: leave people time between two calls of a real robot.
            void: discards the last response of a person; returns whether there was one.
            past: an interrupted game to resume first.
        """
        self.past = past
        self.supervision = supervision
        self.autonomy = AutonomyDial()
        self.stopped = self.taking_over = False
        self.stepping = False
        """Whether a step is being carried out now."""
        self.obeys: tuple[Behaviour, str | None] | None = None
        """The behaviour and its target, if Tangy is doing now what staff told it to do."""
        self.nudge = threading.Event()
        """Set when something changed, for the thread that waits to call `next`."""
        self.changed: Callable[[], object] = lambda: None
        """Called after each command, in the thread that carried it out."""
        self.awake: Callable[[], bool] = lambda: True
        """Returns False after the program was frozen; then no step is taken."""
        self.by = by
        self.robot = RobotControls(robot, self.note, lambda: self.stopped, paced=paced)
        self.plan = GamePlanControls(supervision, self.note, by)
        self.time = PlannedTime(supervision, past, by)
        self.answers = AnswerCollector(supervision)
        """Verifies answers to Tangy's questions; `answer` then carries them out."""
        self._void = void
        self.beginning = False
        """Whether a game begins now: a robot first drives to the front."""
        self.going = True
        self.single = False
        self.paused_itself = False
        self._calls_again = threading.Lock()
        """Held while a repeat of the last number waits for its turn: it is said once."""
        self._turn = threading.RLock()
        """Guards the supervision and the robot."""
        self._watch = StaffWatch()
        supervision.game.permits = self.autonomy.permits

    # ----------------------------------------------------------------------------- the game

    @property
    def phase(self) -> Phase:
        """The phase of the game."""
        if self.supervision.over:
            return "joining" if self.joined else "idle"
        if self.stopped:
            return "stopped"
        if self.supervision.halted is not None:
            return "halted"
        if self.robot.driving or self.taking_over:
            return "staff"
        if self.supervision.question is not None or self.proposal is not None:
            return "asking"
        if not self.going:
            return "paused"
        return "asking" if self._unanswered else "running"

    @property
    def repeats_call(self) -> bool:
        """Whether the last number is said once more, or will be as soon as Tangy can."""
        return self._calls_again.locked()

    @property
    def waits(self) -> bool:
        """Whether the game waits for staff."""
        return self.phase not in ("idle", "running", "joining")

    @property
    def proposal(self) -> Proposal | None:
        """The next action, on which staff are asked."""
        return self.autonomy.proposal

    def begin(self) -> list[Event]:
        """Release the robot and begin a game, or resume one, paused.

        If the robot is stopped, it stays so: a game is resumed, but no new one begins.

        Raises:
            NotResumable: the world cannot restore the state of the interrupted game.
        """
        with self._turn, serving():
            stopped = self.stopped
            if stopped and self.past is None:
                return []
            self.ending = self.taking_over = self.single = self.paused_itself = False
            self.going = not stopped and (self.past is None or self.goes_on)
            self.autonomy.reset()
            if not stopped:
                self.robot.release(everybody=True)
                if self.stopped:  # in the meantime
                    self.robot.stop()
                    return []
            joined = self._interrupted_at is not None
            past = self._take_past()
            first = past is None and not self.supervision.games
            waits = self.robot.wait_on(self.supervision.store) if first else {}
            if past is None:  # from now on nobody is shown the game before
                self._watch.begin(self.supervision.world.seconds, waits)
            self.beginning = past is None
            try:
                events = self.supervision.begin(past, self.by)
            finally:
                self.beginning = False
            if stopped and not joined:  # before there was a game to log it in
                self.note("stopped", by=self.stopped_by)
            world = self.supervision.world
            self.plan.take_up(() if past is None else past.claims)
            if past is None:
                self._watch.begin(world.seconds, waits)
            else:
                self._watch.resume(world.seconds, past, world.activity)
                if not self.going:
                    self._watch.pause(world.seconds)
            return events

    def next(self) -> list[Event]:
        """Carry out the next behaviour if it is permitted; otherwise only check the devices."""
        with self._turn, serving():
            game = self.supervision
            self.nudge.clear()
            if game.over or self.ending:
                return []
            waits = self.stopped or self._holds or not self.going or game.halted is not None
            if waits or game.question is not None or self.proposal is not None:
                return game.look()
            if left := self.plan.check_left():
                return left
            if self.plan.tell_left():  # staff read so before the next step
                return []
            if self.taking_over and not game.waiting:
                return self._ask_next()
            if not (self._may_step() and self.awake()):
                return []
            if self.single:
                self.single, self.going = False, False
            self.stepping = True
            try:
                return game.step()
            finally:
                self.stepping = False
                self._keep_no_longer()
                self.autonomy.done()
                self.view()

    @property
    def counts_down(self) -> bool:
        """Whether Tangy does nothing but wait for the time of the next call."""
        if self.phase != "running" or self.stepping:
            return False
        ahead = next_step(self.supervision.world, self.supervision.policy)
        return ahead is not None and self.robot.rests(ahead[0])

    def view(self) -> StaffView:
        """Return the present state of the game for staff; from any thread, at any time."""
        world = self.supervision.world
        if self.supervision.over and not self.beginning:
            self._watch.end(world.seconds)
        return self._watch.look(self.plan.scene, world.people, world.seconds, world)

    def look(self) -> list[Event] | None:
        """Check the devices and return new events; None while a behaviour is being carried out."""
        if not self._turn.acquire(blocking=False):
            return None
        try:
            return self.supervision.look()
        finally:
            self._turn.release()

    def _may_step(self) -> bool:
        """Return whether the next behaviour may be carried out now; propose it to staff if not."""
        game = self.supervision
        alone = self.autonomy.level == "alone" and not self.robot.paced
        if alone or game.waiting:
            return True
        state = game.world.observe()
        decision = game.policy.decide(state.situation)
        if self.robot.rests(decision):
            return False
        does = game.world.activity.behaviours.get(decision.behaviour)
        target = target_of(game.policy.whom, does, state)
        if not decision.sure or self.autonomy.permits(decision, target):
            return True
        self.autonomy.propose(decision, target)
        return False

    # ----------------------------------------------------------------------------- what staff do

    def apply(self, command: GameCommand) -> list[Result]:
        """Carry out a command of staff; return its results, or why it was refused."""
        try:
            return self.carry_out(command)
        except TangyError as error:
            return [StaffNote("ends") if self._stands_at_end else StaffNote("cannot", str(error))]

    def carry_out(self, command: GameCommand) -> list[Result]:
        """Carry out a command of staff; raises TangyError if that fails or cannot be logged."""
        with serving():
            if isinstance(command, CallAgain) and not self._calls_again.acquire(blocking=False):
                return [StaffNote("calls again soon")]
            try:
                if isinstance(command, AT_ONCE):
                    return self._dispatch(command)
                if isinstance(command, EndGame):
                    self.break_off()
                self.plan.say_early(command)
                with self._turn:
                    return self._dispatch(command)
            finally:
                if isinstance(command, CallAgain):
                    self._calls_again.release()
                if isinstance(command, EndGame):
                    self._ended()
                self.plan.forget_early(command)
                self._tell_all()

    def _tell_all(self) -> None:
        self._keep_no_longer()
        self.nudge.set()
        self.changed()

    def _dispatch(self, command: GameCommand) -> list[Result]:
        too = self.joined and isinstance(command, Joins)
        if self.supervision.over and not too and not isinstance(command, WITHOUT_GAME):
            return [self._without_game(command)]
        if self._stands_at_end and not isinstance(command, StopRobot | EndGame):
            return [StaffNote("ends")]
        if isinstance(command, ClaimCard) and self.plan.refuses(command) is None:
            self.robot.keep_claimed(command)
        if isinstance(command, PlanCommand):
            return self.plan.do(command)
        match command:
            case StopRobot(by):
                return self._stop(by)
            case Pause(unasked):
                return self._pause(unasked=unasked)
            case GoOn():
                return self._go_on()
            case OneStep():
                return self._one_step()
            case TakeOver():
                return self._take_over()
            case GiveBack():
                return self._give_back()
            case SetAutonomy(level):
                self.autonomy.turn(level)
                self.note("autonomy", detail=level)
                return [StaffNote("autonomy", level)]
            case Confirm(yes):
                return self._confirm(yes=yes)
            case Joins():
                return self._let_in(command)
            case PlanTime():
                return [self.time.plan(command)]
            case Tell() | HasCard():
                return [self.robot.do(command)]
            case CallAgain() | Drive() | AskFor():
                return [self.refuses(command) or self.robot.do(command)]
            case VoidResponse(person):
                return [self._voided(person)]
            case Acknowledge() | CallExpert() | Reached() | Clear() | Accept():
                return attend(self.supervision, command, self.by)
            case EndGame():
                return self._end()
            case forgotten:
                assert_never(forgotten)

    def note(self, did: StaffActionKind, *, by: str = "", **what: Any) -> None:
        """Log what staff did (see `Supervision.note`), unless the log is full."""
        with suppress(TangyError):
            self.supervision.note(did, by or self.by, **what)

    def _voided(self, person: str) -> StaffNote:
        if not self._void(person):
            return StaffNote("nothing to void", person)
        self.supervision.persuasion.recall(person)
        self.note("response voided", person=person)
        return StaffNote("voided", person)

    def refuses(self, command: GameCommand) -> StaffNote | None:
        """Return why a command is refused at once, before its turn; None if it is not."""
        if isinstance(command, CallAgain | Drive):
            return self.refusal(asking=False)
        if isinstance(command, AskFor) and (self.supervision.over or not self.robot.there):
            return None  # another refusal comes first
        return self.plan.refuses(command)

    def refusal(self, *, asking: bool = True) -> StaffNote | None:
        """Return what staff have to do first, None if nothing."""
        if self.stopped:
            return StaffNote("stopped first", words=self.stopped_by)
        if self.supervision.halted is not None:
            return StaffNote("halted first")
        if asking and self.supervision.question is not None:
            return self.asks_first()
        return None

    def answer(self, behaviour: Behaviour, target: str | None) -> list[Result]:
        """Carry out an answer and learn from it; blocks until it is done.

        Raises:
            TangyError: it could not be stored; nothing of it is kept.
        """
        with self._turn, serving():
            refused = StaffNote("ends") if self._stands_at_end else self.refusal(asking=False)
            if refused is not None:
                return [refused]
            self.stepping, self.obeys = True, (behaviour, target)
            try:
                return list(self.supervision.answer(behaviour, target, self.by))
            finally:
                self.stepping, self.obeys = False, None
                self._tell_all()
