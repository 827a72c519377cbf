"""The ways in which staff take over what Tangy does next, and hand control back."""

from __future__ import annotations

from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import TAKEN_OVER
from tangy_tui.app.pausing_games import PausingGames
from tangy_tui.app.staff_notes import StaffNote


class HandingOver(PausingGames):
    """The part of the controller that hands control to staff, and back to Tangy."""

    taking_over: bool
    """Whether staff say what Tangy does next."""

    @property
    def asks_next(self) -> bool:
        """Whether staff say in words what Tangy does next, or soon will."""
        asks = self.taking_over or self.supervision.question is not None
        return asks and not self.supervision.over

    def _keep_no_longer(self) -> None:
        """Hand control back if the game is over: no question of it comes any more."""
        if self.supervision.over:
            self.taking_over = False

    def _take_over(self) -> list[Result]:
        if refused := self.refusal():
            return [refused]
        self.taking_over = self.going = True
        self._watch.go_on()
        self.autonomy.reset()
        self.note("took over")
        return [StaffNote("takes over")]

    def _give_back(self) -> list[Result]:
        question = self.supervision.question
        if not self.taking_over and question is None:
            return [StaffNote("nothing asked")]
        asked = question is not None and question.fault == TAKEN_OVER
        if self.taking_over or asked:
            self.note("gave back")
        self.taking_over = False
        if asked:
            self.supervision.game.withdraw()
        return [StaffNote("given back")]

    def _confirm(self, *, yes: bool) -> list[Result]:
        if not self.autonomy.confirm(yes=yes):
            return [StaffNote("nothing asked")]
        return [StaffNote("goes on")] if yes else self._take_over()
