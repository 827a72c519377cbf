"""The controller of games: every door by which staff act leads here, and each game runs by it.

A game goes on in one thread (`next`, again and again), commands come from another (`apply`). What
must not wait, a STOP above all, goes to the robot at once; what has to do with the game waits for
its turn. All that staff did is in the log with who did it.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, TypeAlias, assert_never

from tangy_profiles.errors import TangyError
from tangy_profiles.process_log import serving
from tangy_tui.app.game_commands import (
    Accept,
    Acknowledge,
    AskFor,
    Autonomy,
    CallAgain,
    CallExpert,
    Clear,
    Confirm,
    Drive,
    EndGame,
    GameCommand,
    GiveBack,
    GoOn,
    OneStep,
    Pause,
    Phase,
    Proposal,
    SetAutonomy,
    StaffNote,
    StopRobot,
    TakeBackCall,
    TakeOver,
    VoidResponse,
)
from tangy_tui.app.robot_controls import ENDED, RobotControls
from tangy_tui.learning.policy import Decision
from tangy_tui.learning.verification import (
    Asked,
    Offered,
    Reply,
    Say,
    Verification,
    Verified,
    Verifier,
)
from tangy_tui.monitoring.supervision import Event, Supervision

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld

Told: TypeAlias = Event | StaffNote | Verification

SURE = 0.9
"""The share of votes from which a decision is not asked about where Tangy asks when unsure."""
TOOK_OVER = "You say what Tangy does next."
LEAVES_SECONDS = 1.0  # in which what is being done is broken off
AT_ONCE = (StopRobot, Pause, TakeOver, GiveBack, SetAutonomy, AskFor)
"""What does not wait for its turn."""


class GameController:
    """Games with staff who can step in. `begin` each, then call `next` until it is over."""

    def __init__(
        self,
        supervision: Supervision,
        by: str,
        *,
        robot: LiveWorld | None = None,
        void: Callable[[str], bool] = lambda person: False,
    ) -> None:
        """Take charge of games.

        Args:
            supervision: what runs them.
            by: who acts, for the log.
            robot: the world of a robot that is there; None: the games are simulated.
            void: lets the last response of a person not count; says whether there was one.
        """
        self.supervision = supervision
        self.autonomy: Autonomy = "alone"
        self.stopped = False
        self.taking_over = False
        self.proposal: Proposal | None = None
        """What Tangy would do next, and asks staff about."""
        self.nudge = threading.Event()
        """Is set when something has changed for whoever waits to do the next thing."""
        self._by = by
        self.robot = RobotControls(robot, self.note, lambda: self.stopped)
        self._void = void
        self._going = True
        self._single = False
        self._confirmed: tuple[str, str | None] | None = None
        self._verifier: Verifier | None = None
        self._turn = threading.RLock()
        """Whoever has it has the supervision, and the robot."""
        supervision.game.permits = self.permits

    # ----------------------------------------------------------------------------- the game

    @property
    def phase(self) -> Phase:
        """How the game stands."""
        if self.supervision.over:
            return "idle"
        if self.stopped:
            return "stopped"
        if self.supervision.halted is not None:
            return "halted"
        if self.robot.driving or self.taking_over:
            return "staff"
        if self.supervision.question is not None or self.proposal is not None:
            return "asking"
        return "running" if self._going else "paused"

    def begin(self) -> list[Event]:
        """Begin the next game; the robot may move: staff have said that all is well."""
        with self._turn, serving():
            self.stopped = self.taking_over = self._single = False
            self.proposal = self._confirmed = self._verifier = None
            self._going = True
            self.robot.release(everybody=True)
            return self.supervision.begin()

    def next(self) -> list[Event]:
        """Do the next thing if it may be done now; else only look at the devices."""
        with self._turn, serving():
            game = self.supervision
            self.nudge.clear()
            if game.over:
                return []
            waits = self.stopped or not self._going or game.halted is not None
            if waits or game.question is not None or self.proposal is not None:
                return game.look()
            if self.taking_over and not game.waiting:
                self.taking_over = False
                return list(game.game.ask(TOOK_OVER, "Say what it does.", "took over"))
            if not self._may_step():
                return []
            if self._single:
                self._single, self._going = False, False
            try:
                return game.step()
            finally:
                self._confirmed = None

    def _may_step(self) -> bool:
        """Say whether the next behaviour may be done now, or ask staff about it first."""
        game = self.supervision
        if game.waiting:
            return True
        state = game.world.observe()
        decision = game.policy.decide(state.situation)
        if self.robot.rests(decision):
            return False
        behaviour = game.world.activity.behaviours.get(decision.behaviour)
        target = state.attended if behaviour is not None and behaviour.attends else None
        if not decision.sure or self.permits(decision, target):
            return True
        self.proposal = Proposal(decision.behaviour, target, decision.share)
        return False

    def asks_about(self, decision: Decision) -> bool:
        """Say whether staff are to be asked before a decision is carried out."""
        unsure = self.autonomy == "unsure" and decision.share < SURE
        return self.autonomy == "each" or unsure

    def confirm(self, chosen: tuple[str, str | None] | None) -> None:
        """Keep what staff said yes to, and for whom: it alone is done next; None: nothing."""
        self._confirmed = chosen

    def permits(self, decision: Decision, target: str | None) -> bool:
        """Say, as a step is done, whether staff said yes to it: they may have to be asked anew.

        People ask for things while a question stands, and what would be done is another then.
        """
        return not self.asks_about(decision) or self._confirmed == (decision.behaviour, target)

    # ----------------------------------------------------------------------------- what staff do

    def apply(self, command: GameCommand) -> list[Told]:
        """Carry out a command of staff, and return what came of it."""
        with serving():
            try:
                if isinstance(command, AT_ONCE):
                    return self._carry_out(command)
                if isinstance(command, EndGame):
                    self.robot.stop(ENDED)  # what it does is broken off
                with self._turn:
                    return self._carry_out(command)
            except TangyError as error:
                return [StaffNote("cannot", str(error))]
            finally:
                self.nudge.set()

    def _carry_out(self, command: GameCommand) -> list[Told]:
        if self.supervision.over and not isinstance(command, StopRobot | GoOn | SetAutonomy):
            return [StaffNote("no game")]
        match command:
            case StopRobot():
                return self._stop()
            case Pause():
                self._going = False
                return [StaffNote("paused")]
            case GoOn():
                return self._go_on()
            case OneStep():
                return self._one_step()
            case TakeOver():
                return self._take_over()
            case GiveBack():
                return self._give_back()
            case SetAutonomy(level):
                self.autonomy, self.proposal = level, None
                self.note(f"autonomy: {level}")
                return [StaffNote("autonomy", level)]
            case Confirm(yes):
                return self._confirm(yes=yes)
            case AskFor():
                return [self.robot.do(command)]
            case CallAgain() | TakeBackCall() | Drive():
                refused = self._refused(asking=False)
                return [refused or self.robot.do(command)]
            case VoidResponse(person):
                return [self._voided(person)]
            case Acknowledge() | CallExpert() | Clear():
                return self._attend(command)
            case Accept():
                return list(self.supervision.accept(self._by)) or [StaffNote("not acceptable")]
            case EndGame():
                return self._end()
            case forgotten:
                assert_never(forgotten)

    def note(self, what: str) -> None:
        """Log what staff did; a log that is full does not keep them from doing it."""
        with suppress(TangyError):
            self.supervision.note(what, self._by)

    def _stop(self) -> list[Told]:
        self.stopped, self._going = True, False
        self.robot.stop()
        self.note("the robot was stopped")
        return [StaffNote("stopped")]

    def _go_on(self) -> list[Told]:
        if self.stopped:
            if self.supervision.halted is None:
                self.robot.release()
            self.stopped = False
            self.note("the robot was let go on")
        elif self.supervision.over and self.robot.frozen:
            self.robot.release(everybody=True)
        self._going = True
        return [StaffNote("goes on")]

    def _one_step(self) -> list[Told]:
        if refused := self._refused():
            return [refused]
        self._single = self._going = True
        return [StaffNote("one step")]

    def _take_over(self) -> list[Told]:
        if refused := self._refused():
            return [refused]
        self.taking_over, self.proposal, self._going = True, None, True
        self.note("staff take over")
        return [StaffNote("takes over")]

    def _give_back(self) -> list[Told]:
        taken = self.taking_over or self.supervision.question is not None
        if not taken:
            return [StaffNote("nothing asked")]
        self.taking_over = False
        question = self.supervision.question
        if question is not None and question.fault == "took over":
            self.supervision.game.withdraw()
            self._verifier = None
        return [StaffNote("given back")]

    def _confirm(self, *, yes: bool) -> list[Told]:
        proposal, self.proposal = self.proposal, None
        if proposal is None:
            return [StaffNote("nothing asked")]
        if yes:
            self._confirmed = proposal.behaviour, proposal.target
            return [StaffNote("goes on")]
        return self._take_over()

    def _voided(self, person: str) -> StaffNote:
        if not self._void(person):
            return StaffNote("nothing to void", person)
        self.supervision.persuasion.recall(person)
        self.note(f"staff: the last response of {person} does not count")
        return StaffNote("voided", person)

    def _attend(self, command: Acknowledge | CallExpert | Clear) -> list[Told]:
        """Act on the fault that halts Tangy."""
        fault = self.supervision.halted
        if fault is None:
            return [StaffNote("not halted")]
        match command:
            case Acknowledge():
                return list(self.supervision.acknowledge(self._by)) or [StaffNote("seen before")]
            case CallExpert():
                return list(self.supervision.call_expert(self._by))
            case Clear():
                if not fault.acknowledged:
                    return [StaffNote("not seen yet")]
                return list(self.supervision.clear(self._by))

    def _end(self) -> list[Told]:
        self.note("staff ended the game")
        return [StaffNote("ended"), *self.supervision.leave()]

    def abandon(self) -> None:
        """Stop the robot, and let the log say that the game was left: the program ends."""
        self.stopped = True
        self.robot.stop(ENDED)
        if self._turn.acquire(timeout=LEAVES_SECONDS):  # it is breaking off what it did
            try:
                with suppress(TangyError):
                    self.supervision.leave()
            finally:
                self._turn.release()

    def _refused(self, *, asking: bool = True) -> StaffNote | None:
        """Say what has to be done first, None if nothing has."""
        if self.stopped:
            return StaffNote("stopped first")
        if self.supervision.halted is not None:
            return StaffNote("halted first")
        if asking and self.supervision.question is not None:
            return StaffNote("asks first")
        return None

    # ----------------------------------------------------------------------------- the question

    def say(self, text: str) -> list[Told]:
        """Take words as the answer to what Tangy asks; they are verified before they are done."""
        with self._turn, serving():
            if self.supervision.question is None:
                return [StaffNote("nothing asked")]
            self._verifier = self._verifier or self.supervision.verifier()
            return [self._verifier.say(Say(text))]

    def reply(self, reply: Reply) -> list[Told]:
        """Answer the verification, and have done what was verified."""
        with self._turn, serving():
            if self._verifier is None or self._verifier.question is None:
                return [StaffNote("nothing asked")]
            said = self._verifier.reply(reply)
            if not isinstance(said, Verified):
                return [said]
            if refused := self._refused(asking=False):
                return [refused]
            self._verifier = None
            try:
                return list(self.supervision.answer(said.behaviour, said.target, self._by))
            except TangyError as error:
                return [StaffNote("cannot", str(error))]
            finally:
                self.nudge.set()

    @property
    def verifying(self) -> Asked | Offered | None:
        """The verification that is open, where a command waits for its Y."""
        return None if self._verifier is None else self._verifier.question

    def give_up(self) -> list[Event]:
        """End a game in which Tangy asks or is halted, and nobody is there."""
        with self._turn, serving():
            return self.supervision.give_up()
