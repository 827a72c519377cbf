"""The ways in which staff pause a game, stop the robot, and let both go on.

Each pause is logged, and its time counts as part of the game: the planned length is the time that
the home has, and lunch does not wait.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from tangy_tui.app.fault_commands import Result
from tangy_tui.app.joining_games import JoiningGames
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.staff_view import StaffWatch


class PausingGames(JoiningGames):
    """The part of the controller that pauses games and stops the robot."""

    stopped_by = ""
    """The onlooker who stopped the robot last; empty: staff at this console."""
    going: bool
    """Whether the next behaviour may run; False: the game is paused."""
    single: bool
    """Whether the game pauses after the next behaviour."""
    paused_itself: bool
    """Whether the program paused the game, and not staff."""
    _watch: StaffWatch
    _by_hand = False
    """Whether staff drive by keys: then the game waits, and what follows is kept in `_goes`."""
    _goes = False
    """Whether the game goes on after staff have driven."""
    _holds = 0
    """The number of questions that hold the game, until what staff confirm is carried out."""
    _unanswered = 0
    """The number of these that staff have not answered yet."""

    def _tell_all(self) -> None:
        raise NotImplementedError

    @property
    def _continues(self) -> bool:
        """Whether the game goes on, or will when staff have driven."""
        return self._goes if self._by_hand else self.going

    def _pause(self, *, unasked: bool) -> list[Result]:
        before = self._continues
        self._goes, self.going, self.paused_itself = False, False, unasked
        self.single = False  # that step is not wanted any more
        self.goes_on = self.goes_on and not self.joined
        self._stands(did=before and not unasked)
        return [StaffNote("paused")]

    def _stands(self, *, did: bool) -> None:
        """Begin a pause, unless there is one; `did`: log that staff paused the game."""
        if self._watch.pause(self.supervision.world.seconds) and did:
            self.note("paused")

    @contextmanager
    def driving(self) -> Iterator[None]:
        """Let staff drive by keys while the game waits, also if they say meanwhile that it goes on.

        Their voice, or a freeze of the program, can pause the game or let it go on meanwhile.
        """
        self._goes, self.going = self.going, False
        self._by_hand = self.robot.driving = True
        try:
            yield
        finally:
            self._by_hand = self.robot.driving = False
            self.going = self._goes and not self.stopped
            self.note("drove")
            self._tell_all()

    @contextmanager
    def holding(self) -> Iterator[Callable[[], None]]:
        """Hold the game and its count-down, while staff are asked whether they mean a command.

        Yield a function to call when staff have answered: until the end of the context the game
        waits for what they confirmed, and no longer for them.
        """
        waits = True

        def answered() -> None:
            nonlocal waits
            self._unanswered -= waits
            waits = False

        self._holds += 1
        self._unanswered += 1
        self.robot.hold_calls(held=True)
        try:
            yield answered
        finally:
            answered()
            self._holds -= 1
            self.robot.hold_calls(held=bool(self._holds))
            self._tell_all()

    def _lets_go_on(self, *, single: bool = False) -> None:
        """Let the game go on, for a single step or more; if staff drive, once they have driven."""
        self._goes, self.going, self.single = True, not self._by_hand, single

    def _stop(self, by: str) -> list[Result]:
        before, self.stopped, self.going = self.stopped, True, False
        if by or not before:
            self.stopped_by = by
        self.supervision.stopped_by_staff()
        self.robot.stop()
        if by or not before:
            self.note("stopped", by=by)
        self._stands(did=False)
        return [StaffNote("stopped")]

    def _go_on(self) -> list[Result]:
        if self.stopped:
            self.robot.release()  # a fault that halts it has a stop of its own
            self.stopped = False
            self.note("let go on")
        elif not self._continues:
            self.note("went on")
        self._watch.go_on()
        if self.supervision.over and self.robot.frozen:
            self.robot.release(everybody=True)
        self._lets_go_on()
        self.paused_itself = False
        self.goes_on = self.goes_on or self.joined
        if (fault := self.supervision.halted) is not None:
            return [StaffNote("still halted", fault.name)]
        return [StaffNote("goes on")]

    def _one_step(self) -> list[Result]:
        if refused := self.refusal():
            return [refused]
        self._stands(did=True)
        self._lets_go_on(single=True)
        return [StaffNote("one step")]
