"""The ways in which staff end a game."""

from __future__ import annotations

import threading
from contextlib import suppress
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_profiles.process_log import serving
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.app.autonomy import AutonomyDial
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import asked_for
from tangy_tui.app.robot_controls import ENDED, PROGRAM_ENDS, RobotControls
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.monitoring.supervision import Event, Supervision

LEAVES_SECONDS = 1.0  # in which the current behaviour is aborted


class EndingGames:
    """The part of the controller that ends games."""

    supervision: Supervision
    robot: RobotControls
    autonomy: AutonomyDial
    stopped: bool
    going: bool
    ending = False
    """Whether staff have ended the game, and its end is still to be carried out."""
    _turn: threading.RLock

    def refusal(self, *, asking: bool = True) -> StaffNote | None:
        """Return what staff have to do first, None if nothing."""
        raise NotImplementedError

    def note(self, did: StaffActionKind, *, by: str = "", **what: Any) -> None:
        """Log what staff did (see `Supervision.note`)."""
        raise NotImplementedError

    @property
    def _stands_at_end(self) -> bool:
        """Whether a robot already stands because staff have ended the game."""
        return self.ending and self.robot.there

    def wait_for_turn(self, seconds: float) -> bool:
        """Wait up to some s for the current behaviour to end; return whether it has ended."""
        if self._turn.acquire(timeout=seconds):
            self._turn.release()
            return True
        return False

    def break_off(self) -> None:
        """Abort the robot's current behaviour, and begin no other, because the game ends."""
        self.ending = True
        self._abort(ENDED)

    def _abort(self, why: str) -> None:
        self.supervision.stopped_by_staff()
        self.robot.stop(why)

    def hold(self, why: str) -> None:
        """Abort the robot's current behaviour, and take no further step."""
        self.stopped = True
        self._abort(why)

    def interrupt(self, patience: float = LEAVES_SECONDS) -> None:
        """Stop the robot, wait up to `patience` s for it, and leave the game to be resumed."""
        self.hold(PROGRAM_ENDS)
        if self.wait_for_turn(patience):
            self.supervision.interrupt()

    def _end(self) -> list[Result]:
        self.note("ended")
        game = self.supervision
        asked = game.question is not None and not asked_for(game.question)
        events = game.give_up() if asked or game.halted is not None else game.leave(ends=True)
        return [StaffNote("ended"), *events]

    def _ended(self) -> None:
        """Note that an end was carried out; a game that could not be ended stands still."""
        self.ending = False
        self.stopped |= not self.supervision.over

    def abandon(self, patience: float = LEAVES_SECONDS) -> list[Event]:
        """Stop the robot, wait up to `patience` s for it, and log that the game was left."""
        self.hold(ENDED)
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
