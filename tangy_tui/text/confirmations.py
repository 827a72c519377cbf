"""Questions to staff before a command that cannot be undone."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, assert_never

from tangy_tui.text import freezes, teaching

if TYPE_CHECKING:
    from tangy_tui.app.confirmations import Confirmation


class ConfirmationWords(NamedTuple):
    """A question, its consequences, and the words for yes and no."""

    question: str
    detail: str
    yes: str
    no: str

    def line(self, key: str) -> str:
        """Ask in one line; `key` is the key for yes."""
        return f"{self.question} {self.detail} Type {key}: {self.yes}. N: {self.no}."


def confirmation_words(asked: Confirmation) -> ConfirmationWords:
    """Return the words of a question before a command."""
    match asked.kind:
        case "end":
            return ConfirmationWords(
                "End the game?",
                "The game ends here, and the log says so. Tangy keeps what it has learnt.",
                "end it",
                "go on",
            )
        case "take back":
            return ConfirmationWords(
                f"Take {asked.about} back?",
                "It will count as not called, and come again later.",
                "take it back",
                "leave it",
            )
        case "move again":
            return ConfirmationWords(
                "Let the robot move again?", "It goes on with the game at once.", "go on", "wait"
            )
        case "go on":
            return ConfirmationWords("Go on?", freezes.DETAIL, freezes.GO_ON, freezes.STAY)
        case forgotten:
            assert_never(forgotten)


def discard_confirmation(steps: int) -> ConfirmationWords:
    """Ask before a demonstration of some steps is discarded."""
    return ConfirmationWords(*teaching.discard_words(steps), teaching.DISCARD, teaching.KEEP)


def again_confirmation(first: int, last: int) -> ConfirmationWords:
    """Ask before steps are taken back; the word for redo is typed."""
    question, detail = teaching.again_words(first, last)
    return ConfirmationWords(question, detail.format(redo="redo"), teaching.GO_BACK, teaching.GO_ON)


NOT_DONE = "Not done."
