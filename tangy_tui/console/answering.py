"""What Tangy asks staff in the console of a game, and their yes or no."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from queue import SimpleQueue

from tangy_tui.app.game_commands import Confirm
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.verification import Asked, Offered, Reply, Verification
from tangy_tui.text.situations import verification_lines

Typed = SimpleQueue[str | None] | None
"""The lines read ahead; None: each line is read when it is due."""


class AnsweredQuestions:
    """Writes Tangy's questions, and parses a yes or no; only a question that was shown counts."""

    def __init__(
        self,
        controller: GameController,
        yes: TypedYes,
        inquiries: Inquiries,
        write: Callable[[str], None],
    ) -> None:
        """Ask for a controller, parse answers with `yes`, and write each line with `write`."""
        self._controller, self._yes, self._inquiries = controller, yes, inquiries
        self._write = write
        self._prompted = ""

    @property
    def open(self) -> bool:
        """Whether a question is open that a yes answers."""
        controller = self._controller
        return controller.answers.verifying is not None or controller.proposal is not None

    def prompt(self, typed: Typed) -> None:
        """Write what Tangy waits for, once."""
        asked = self._inquiries.waits_for()
        if asked == self._prompted:
            return
        self._prompted = asked
        if asked and self._controller.proposal is not None:
            self._write(self._inquiries.waits_for(self._yes.ask(typed)))
            self._yes.asked()
        elif asked:
            self._write(asked)

    def verify(self, said: Verification, typed: Typed) -> None:
        """Write the result of a verification, which may be a question."""
        self._write_all(verification_lines(said, self._yes.ask_of(said, typed)))
        if isinstance(said, Asked | Offered):
            self._yes.asked()

    def answer(self, line: str) -> ControllerOutput | Confirm | str | None:
        """Return what a line answers, or the problem with it; None if it is no answer."""
        reply = self._yes.answer(line) if self.open else None
        if reply is None or isinstance(reply, str):
            return reply
        if self._controller.answers.verifying is not None:
            return self._controller.answers.reply(reply)
        return self._confirms(reply)

    def _confirms(self, reply: Reply) -> Confirm | str:
        if reply.alternative is None:
            return Confirm(reply.yes)
        return self._inquiries.waits_for(self._yes.key)

    def _write_all(self, lines: Iterable[str]) -> None:
        for line in lines:
            self._write(line)
