"""The ways in which staff take over what Tangy does next, and hand control back."""

from __future__ import annotations

from tangy_tui.app.fault_commands import Result
from tangy_tui.app.game_commands import TAKEN_OVER, asked_for
from tangy_tui.app.pausing_games import PausingGames
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.monitoring.supervision import Event

TOOK_OVER = "You say what Tangy does next."


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
        self.taking_over = True
        self._lets_go_on()
        self._watch.go_on()
        self.autonomy.reset()
        self.note("took over")
        return [StaffNote("takes over")]

    def _give_back(self) -> list[Result]:
        given, self.taking_over = self.taking_over, False  # first: `next` asks while it is set
        question = self.supervision.question
        asked = asked_for(question)
        if not given and not asked:
            return [StaffNote("nothing asked") if question is None else self.asks_first()]
        self.note("gave back")
        if asked:
            self.supervision.game.withdraw()
        return [StaffNote("given back")]

    def _ask_next(self) -> list[Event]:
        """Ask what Tangy does next, unless staff hand control back meanwhile."""
        asked: list[Event] = list(
            self.supervision.game.ask(TOOK_OVER, "Say what it does.", TAKEN_OVER)
        )
        if not self.taking_over:
            self.supervision.game.withdraw()
            return []
        self.taking_over = False  # only now: an answer typed earlier finds the question
        return asked

    def asks_first(self) -> StaffNote:
        """Return the refusal of what has to wait for an answer: about control, or about Tangy."""
        wanted = asked_for(self.supervision.question)
        return StaffNote("asks first", TAKEN_OVER if wanted else "")

    def _confirm(self, *, yes: bool) -> list[Result]:
        if not self.autonomy.confirm(yes=yes):
            return [StaffNote("nothing asked")]
        return [StaffNote("goes on")] if yes else self._take_over()
