"""Questions to staff before a command that cannot be undone."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, assert_never

from tangy_tui.app.game_commands import ClaimCard
from tangy_tui.text import freezes, teaching

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.app.confirmations import Confirmation
    from tangy_tui.app.game_commands import GameCommand
    from tangy_tui.learning.teaching_events import Ruled


class ConfirmationWords(NamedTuple):
    """A question, its consequences, and the words for yes and no."""

    question: str
    detail: str
    yes: str
    no: str

    def line(self, key: str) -> str:
        """Ask in one line; `key` is the key for yes."""
        return f"{self.question} {self.detail} Type {key}: {self.yes}. N: {self.no}."


def confirmation_words(asked: Confirmation, name: Callable[[str], str]) -> ConfirmationWords:
    """Return the words of a question before a command; `name` returns a person's name."""
    people = [*map(name, asked.people)]
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
                f"{calling_words(asked.calling, asked.about)} {NOT_CALLED}".strip(),
                "take it back",
                "leave it",
            )
        case "move again":
            return ConfirmationWords(
                "Let the robot move again?", "It goes on with the game at once.", "go on", "wait"
            )
        case "go on":
            return ConfirmationWords("Go on?", freezes.DETAIL, freezes.GO_ON, freezes.STAY)
        case "card of another":
            return ConfirmationWords(
                f"Card {asked.about} is {people[1]}'s. Does {people[0]} have it now?",
                f"Tangy then knows no card of {people[1]}.",
                f"it is {people[0]}'s",
                "leave it",
            )
        case "claim of another":
            return ConfirmationWords(
                f"Card {asked.about} is {people[1]}'s. Check it for {people[0]}?",
                f"If the card wins, {people[0]} wins. Tangy tells everybody.",
                f"check it for {people[0]}",
                "leave it",
            )
        case "claim with another":
            return ConfirmationWords(
                f"{people[0]} has card {asked.known}. Is card {asked.about} theirs, too?",
                f"If not: {people[0]}'s card is {asked.known}, and you may have mistyped it.",
                f"check card {asked.about}",
                "leave it",
            )
        case "claim away":
            return ConfirmationWords(
                f"Card {asked.about} is {people[0]}'s, who is not here. Check it?",
                f"If the card wins, {people[0]} wins. Tangy tells everybody.",
                "check it",
                "leave it",
            )
        case forgotten:
            assert_never(forgotten)


def discard_confirmation(steps: int) -> ConfirmationWords:
    """Ask before a demonstration of some steps is discarded."""
    return ConfirmationWords(*teaching.discard_words(steps), teaching.DISCARD, teaching.KEEP)


def again_confirmation(first: int, last: int) -> ConfirmationWords:
    """Ask before steps are taken back; the word for redo is typed."""
    question, detail = teaching.again_words(first, last)
    return ConfirmationWords(question, detail.format(redo="redo"), teaching.GO_BACK, teaching.GO_ON)


def rule_confirmation(rule: Ruled, activity: Activity) -> ConfirmationWords:
    """Ask before a step becomes a rule."""
    asked = teaching.rule_words_asked(rule, activity)
    return ConfirmationWords(*asked, teaching.RULE, teaching.NO_RULE)


NOT_DONE = "Not done."
BEHIND = "Tangy takes that claim after this question."
NOT_CALLED = "It will count as not called, and come again later."


def undone_words(command: GameCommand) -> str:
    """Tell that staff did not confirm a command; of a claim, which card is not checked."""
    match command:
        case ClaimCard(card=card) if card:
            return f"{NOT_DONE[:-1]}: card {card} is not checked."
        case _:
            return NOT_DONE


def calling_words(label: str, taken: str) -> str:
    """Tell that a number is being called, and stays; "" without a label.

    Args:
        label: the number.
        taken: the number that staff take back.
    """
    if not label:
        return ""
    return f"Tangy is calling {label}: {label} stays. After that it takes {taken} back."


def called_meanwhile(label: str) -> str:
    """Tell that a number was called while staff were asked about an earlier one."""
    return f"Tangy has called {label} since then. {label} stays."
