"""The way in which people join a running game: it is interrupted, and resumed with them.

The robot is set up again for one person more, so another controller goes on (`follow`).
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from time import monotonic
from typing import TYPE_CHECKING

from tangy_hw.device_protocols import DeviceError
from tangy_tui.app.ending_games import EndingGames
from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import ClaimCard, ComesIn, GameCommand, Joins
from tangy_tui.app.staff_notes import StaffNote

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.joining import Admission
    from tangy_tui.app.plan_controls import GamePlanControls


class JoiningGames(EndingGames):
    """The part of the controller that lets people join."""

    stopped_by: str
    past: PastGame | None
    plan: GamePlanControls

    admission: Admission | None = None
    """Adds people to the participants; None: nobody can join."""
    welcomes: tuple[str, ...] = ()
    """The names of the people for whom the robot drives to the front, and is set up there."""
    joined = False
    """Whether the game was interrupted because a person joined, and is to be resumed with them."""
    goes_on = False
    """Whether a resumed game continues at once, rather than when staff say so.

    When a person has joined: whether the game was going.
    """
    _interrupted_at: tuple[float, float] | None = None
    """When the game was interrupted for a person: the time played, and this machine's clock (s)."""
    _admitted = False
    """Whether the robot is being set up for those who have joined."""

    @property
    def after_joining(self) -> bool:
        """Whether the game to resume was interrupted only because a person joined."""
        return self._interrupted_at is not None

    def _let_in(self, command: Joins) -> list[Result]:
        """Let a new person join; if the name is that of somebody who was away, they are back."""
        told = self._let_join(command)
        match told:
            case [StaffNote(kind="known already", about=person)]:
                pass
            case [StaffNote(kind="which person", people=(person,))]:  # a first name
                pass
            case _:
                return told
        if self.joined or command.seat or command.table:
            return told
        back = self.plan.do(ComesIn(person))
        return back if back == [StaffNote("comes", person)] else told

    def _without_game(self, command: GameCommand) -> StaffNote:
        """Return why a command is not carried out while no game runs, or what becomes of it."""
        if self.joined and isinstance(command, ClaimCard) and self.plan.kept(command):
            return StaffNote("claim kept", str(self.plan.with_card(command).card))
        return StaffNote("joining" if self.joined else "no game")

    def _let_join(self, command: Joins) -> list[Result]:
        """Send the robot to the front, let a person in, and interrupt the game."""
        if self.admission is None:
            return [StaffNote("nobody joins")]
        if self.joined and self._admitted:
            return [StaffNote("joining")]
        if refused := self.refusal() or self.admission.refusal(command):
            return [refused]
        if not self.joined and not self._goes_to_front(command.name):
            return [StaffNote("not at front")]
        joins = self.admission.admit(command)
        self.note("came", person=joins.about, seat=self.admission.seat_of(joins.about))
        if self.joined:  # the robot is set up once, for all who have come
            self.welcomes = (*self.welcomes, command.name)
            return [joins]
        self.supervision.interrupt()
        self.joined, self.goes_on, self.going = True, self.going, True
        self._interrupted_at = self.supervision.game.log.seconds, monotonic()
        return [joins]

    def _goes_to_front(self, name: str) -> bool:
        """Drive to the front for a new person; return whether the robot got there unstopped."""
        self.welcomes, arrived = (name,), False
        try:
            with suppress(DeviceError):
                arrived = self.robot.go_to_front()
        finally:
            if not arrived:
                self.welcomes = ()
        return arrived

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

    def follow(self, before: JoiningGames) -> None:
        """Go on as the controller of a game that a person has joined, perhaps before a step.

        A STOP that fell while the robot was switched on again holds: the game begins when staff let
        it go on. Attach this controller to the door first, so that none falls between the two.
        """
        self.goes_on, self._interrupted_at = before.goes_on, before._interrupted_at
        if before.stopped:
            self.stopped, self.going, self.goes_on = True, False, True
            self.stopped_by = before.stopped_by
            self.robot.stop()
        self.autonomy.turn(before.autonomy.level)
        gathering = self.supervision.game.changes.gathering
        if gathering is not None:
            gathering.choose(before.supervision.game.changes.plan)

    def _take_past(self) -> PastGame | None:
        """Return the game to resume, once. Setting up the robot for a person counts as its time."""
        past, self.past = self.past, None
        at, self._interrupted_at = self._interrupted_at, None
        if past is None or at is None:
            return past
        played, clock = at
        return replace(past, acted=max(past.acted, played + monotonic() - clock))
