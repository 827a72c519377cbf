"""Staff are told of cards that Tangy does not judge, and of cards that it takes for somebody's."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from tangy_hw.dealt_cards import CardDoubt, CardLearnt
from tangy_hw.robot_client.card_observations import CardObservations
from tangy_tui.interaction.game_events import GameBegun
from tangy_tui.monitoring.supervision import Event

BY = "tangy"
"""Who notes this in the log."""

MANY = {2: "two", 3: "three", 4: "four"}


@dataclass(frozen=True, slots=True)
class CardNote:
    """What there is to tell of cards: to staff, and to the log, where people are their ids.

    `words` are "" where staff know it themselves; `doubt` is the doubt, if it is about one.
    """

    words: str
    note: str
    doubt: CardDoubt | None = None


class CardNews:
    """Tells what is new of whose card is whose."""

    def __init__(self, name: Callable[[str], str]) -> None:
        """Prepare to tell; `name` says what somebody is called."""
        self._name = name

    def take(self, events: Iterable[Event], cards: CardObservations) -> list[CardNote]:
        """Return what is new after what happened; it is told once."""
        notes: list[CardNote] = []
        if any(isinstance(event, GameBegun) for event in events) and cards.dealt.given:
            notes.append(CardNote("", dealt_note(cards.dealt.given)))
        while cards.news:
            new = cards.news.popleft()
            if isinstance(new, CardLearnt):
                notes.append(CardNote(learnt_words(new, self._name), learnt_note(new)))
            else:
                notes.append(CardNote(doubt_words(new, self._name), doubt_note(new), new))
        return notes


def dealt_note(given: Mapping[str, int]) -> str:
    """Write for the log which cards were dealt."""
    return f"cards: {', '.join(f'{person} has {card}' for person, card in given.items())}"


def learnt_words(learnt: CardLearnt, name: Callable[[str], str]) -> str:
    """Say to staff that a card is taken for somebody's."""
    return f"Card {learnt.card} lies in front of {name(learnt.person)}: Tangy takes it for theirs."


def learnt_note(learnt: CardLearnt) -> str:
    """Write for the log that a card is taken for somebody's."""
    return f"card {learnt.card} is taken for that of {learnt.person}"


def doubt_words(doubt: CardDoubt, name: Callable[[str], str]) -> str:
    """Say to staff why a card is not judged, and what they can do."""
    whom, count = name(doubt.person), len(doubt.cards)
    many = MANY.get(count, str(count))
    *first, last = map(str, doubt.cards)
    cards = f"{', '.join(first)} and {last}" if first else last
    none = "neither" if count == 2 else "none"
    match doubt.why:
        case "copies":
            return (
                f"There are {many} copies of card {doubt.cards[0]} in front of {whom}. Tangy "
                f"cannot tell which is theirs, and judges {none}: leave one there."
            )
        case "several cards":
            return (
                f"There are {many} cards in front of {whom}: {cards}. Tangy cannot tell which "
                f"is theirs, and judges {none}: leave one there."
            )
        case "another's card":
            return (
                f"The card in front of {whom}, {cards}, is {name(doubt.owner)}'s, as far as Tangy "
                "knows. Tangy does not judge it."
            )
        case "other card":
            return (
                f"The card in front of {whom} is {cards}; theirs is {doubt.own}, as far as Tangy "
                "knows. Tangy does not judge it."
            )


def doubt_note(doubt: CardDoubt) -> str:
    """Write for the log why a card was not judged."""
    cards = ", ".join(map(str, doubt.cards))
    why = {
        "copies": "copies of a card",
        "several cards": "several cards",
        "another's card": f"a card of {doubt.owner}",
        "other card": f"a card that is not theirs ({doubt.own})",
    }[doubt.why]
    return f"{why} before {doubt.person}: {cards}; not judged"


def doubt_document(doubt: CardDoubt, game: int) -> dict[str, object]:
    """Return as JSON has it why a card was not judged, in which game."""
    return {
        "game": game,
        "person": doubt.person,
        "why": doubt.why,
        "cards": list(doubt.cards),
        "own": doubt.own,
        "owner": doubt.owner or None,
    }
