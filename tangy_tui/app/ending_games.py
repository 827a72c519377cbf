"""The ways in which staff stop or end a game, or interrupt it for a new person."""

from __future__ import annotations

import threading
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.errors import TangyError
from tangy_profiles.process_log import serving
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.app.autonomy import AutonomyDial
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import TAKEN_OVER, Joins, StaffNote
from tangy_tui.app.robot_controls import ENDED, RobotControls
from tangy_tui.monitoring.supervision import Event, Supervision

if TYPE_CHECKING:
    from tangy_tui.app.joining import Admission

LEAVES_SECONDS = 1.0  # in which the current behaviour is aborted


class EndingGames:
    """The part of the controller that stops and ends games."""

    supervision: Supervision
    robot: RobotControls
    autonomy: AutonomyDial
    stopped: bool
    stopped_by = ""
    """The onlooker who stopped the robot last; empty: staff at this console."""
    going: bool
    _turn: threading.RLock

    joined = False
    """Whether the game was interrupted because a person joined, and is to be resumed with them."""
    _admitted = False
    goes_on = False
    """Whether a resumed game continues at once, rather than when staff say so.

    When a person has joined: whether the game was going.
    """
    admission: Admission | None = None
    """Adds people to the participants; None: nobody can join."""

    def refusal(self, *, asking: bool = True) -> StaffNote | None:
        """Return what staff have to do first, None if nothing."""
        raise NotImplementedError

    def note(self, did: StaffActionKind, *, by: str = "", **what: Any) -> None:
        """Log what staff did (see `Supervision.note`)."""
        raise NotImplementedError

    def wait_for_turn(self, seconds: float) -> bool:
        """Wait up to some s for the current behaviour to end; return whether it has ended."""
        if self._turn.acquire(timeout=seconds):
            self._turn.release()
            return True
        return False

    def break_off(self) -> None:
        """Abort the robot's current behaviour, because the game ends."""
        self.supervision.stopped_by_staff()
        self.robot.stop(ENDED)

    def _stop(self, by: str) -> list[Result]:
        before, self.stopped, self.going = self.stopped, True, False
        if by or not before:
            self.stopped_by = by
        self.supervision.stopped_by_staff()
        self.robot.stop()
        if by or not before:
            self.note("stopped", by=by)
        return [StaffNote("stopped")]

    def _end(self) -> list[Result]:
        self.note("ended")
        game = self.supervision
        asked = game.question is not None and game.question.fault != TAKEN_OVER
        events = game.give_up() if asked or game.halted is not None else game.leave()
        return [StaffNote("ended"), *events]

    def _let_join(self, command: Joins) -> list[Result]:
        """Send the robot to the front, let a person in, and interrupt the game."""
        if self.admission is None:
            return [StaffNote("nobody joins")]
        if self.joined and self._admitted:
            return [StaffNote("joining")]
        if refused := self.refusal() or self.admission.refusal(command):
            return [refused]
        if not self.joined and not self._goes_to_front():
            return [StaffNote("not at front")]
        joins = self.admission.admit(command)
        self.note("came", person=joins.about)
        if self.joined:  # the robot is set up once, for all who have come
            return [joins]
        self.supervision.interrupt()
        self.joined, self.goes_on, self.going = True, self.going, True
        return [joins]

    def _goes_to_front(self) -> bool:
        """Drive to the front; return whether the robot has arrived, not if it was stopped."""
        with suppress(DeviceError):
            return self.robot.go_to_front()
        return False

    def admit_no_more(self) -> None:
        """Admit nobody else: the robot is being set up for those who have joined."""
        with self._turn:
            self._admitted = True

    def end_joined(self, reason: str) -> None:
        """End a game that is interrupted for a new person, if staff do not go on with it.

        Args:
            reason: why it ended, for people who read the log.
        """
        if self.joined and self.admission is not None:
            self.joined = False
            self.admission.end_game(reason)

    def follow(self, before: EndingGames) -> None:
        """Go on as the controller of a game that a person has joined, perhaps before a step.

        A STOP that fell while the robot was switched on again holds: the game begins when staff let
        it go on. Attach this controller to the door first, so that none falls between the two.
        """
        self.goes_on = before.goes_on
        if before.stopped:
            self.stopped, self.going, self.goes_on = True, False, True
            self.stopped_by = before.stopped_by
            self.robot.stop()
        self.autonomy.turn(before.autonomy.level)
        gathering = self.supervision.game.changes.gathering
        if gathering is not None:
            gathering.choose(before.supervision.game.changes.plan)

    def abandon(self, patience: float = LEAVES_SECONDS) -> list[Event]:
        """Stop the robot, wait up to `patience` s for it, and log that the game was left."""
        self.stopped = True
        self.break_off()
        if not self._turn.acquire(timeout=patience):
            return []
        try:
            with suppress(TangyError):  # a full log must not keep anyone from leaving
                return self.supervision.leave()
        finally:
            self._turn.release()
        return []

    def give_up(self) -> list[Event]:
        """End a game that waits for an answer or a clearance that nobody gives."""
        with self._turn, serving():
            return self.supervision.give_up()
