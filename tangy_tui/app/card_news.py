"""News for staff about cards: which ones Tangy does not judge, and who it believes owns a card."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tangy_hw.dealt_cards import CardDoubt, CardLearnt
from tangy_hw.robot_client.card_observations import CardObservations
from tangy_tui.interaction.game_events import GameBegun, ResumedGame
from tangy_tui.monitoring.supervision import Event

BY = "tangy"
"""The author of these notes in the event log."""


@dataclass(frozen=True, slots=True)
class CardNote:
    """A note about cards for staff and for the event log, which names people by id.

    `news` is what Tangy learnt or doubts; None if staff know it already.
    """

    note: str
    news: CardLearnt | CardDoubt | None = None

    @property
    def doubt(self) -> CardDoubt | None:
        """Return the doubt, if the note is about one."""
        return self.news if isinstance(self.news, CardDoubt) else None


class CardNews:
    """Collects news about who owns which card."""

    def take(self, events: Iterable[Event], cards: CardObservations) -> list[CardNote]:
        """Return the news after some events; each is reported once."""
        notes: list[CardNote] = []
        if (
            any(isinstance(event, GameBegun | ResumedGame) for event in events)
            and cards.dealt.given
        ):
            notes.append(CardNote(dealt_note(cards.dealt.given)))
        while cards.news:
            new = cards.news.popleft()
            note = learnt_note(new) if isinstance(new, CardLearnt) else doubt_note(new)
            notes.append(CardNote(note, new))
        return notes


def dealt_note(given: Mapping[str, int]) -> str:
    """Write for the log which cards were dealt."""
    return f"cards: {', '.join(f'{person} has {card}' for person, card in given.items())}"


def learnt_note(learnt: CardLearnt) -> str:
    """Return the log note that a card is assigned to a person."""
    return f"card {learnt.card} is taken for that of {learnt.person}"


def doubt_note(doubt: CardDoubt) -> str:
    """Write for the log why Tangy did not judge a card."""
    cards = ", ".join(map(str, doubt.cards))
    why = {
        "copies": "copies of a card",
        "several cards": "several cards",
        "another's card": f"a card of {doubt.owner}",
        "other card": f"a card that is not theirs ({doubt.own})",
    }[doubt.why]
    return f"{why} before {doubt.person}: {cards}; not judged"


def doubt_document(doubt: CardDoubt, game: int) -> dict[str, object]:
    """Return as JSON data why Tangy did not judge a card, and in which game."""
    return {
        "game": game,
        "person": doubt.person,
        "why": doubt.why,
        "cards": list(doubt.cards),
        "own": doubt.own,
        "owner": doubt.owner or None,
    }
