"""News for staff about cards: which ones Tangy does not judge, and who it believes owns a card."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tangy_hw.dealt_cards import CardDoubt, CardLearnt
from tangy_hw.robot_client.card_observations import CardObservations
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.interaction.game_events import GameBegun, ResumedGame
from tangy_tui.monitoring.supervision import Event

BY = "tangy"
"""The author of these notes in the event log."""


@dataclass(frozen=True, slots=True)
class CardNote:
    """News about cards for staff and for the log (see `StaffAction`).

    `news` is what Tangy learnt or doubts; None: staff already know it.
    """

    did: StaffActionKind
    person: str = ""
    detail: str = ""
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
            given = cards.dealt.given.items()
            dealt = ", ".join(f"{person} {card}" for person, card in given)
            notes.append(CardNote("cards dealt", detail=dealt))
        while cards.news:
            new = cards.news.popleft()
            notes.append(_learnt(new) if isinstance(new, CardLearnt) else _doubted(new))
        return notes


def _learnt(learnt: CardLearnt) -> CardNote:
    return CardNote("card learnt", learnt.person, str(learnt.card), learnt)


def _doubted(doubt: CardDoubt) -> CardNote:
    """Keep for the log why a card was not judged, and which cards there were."""
    cards = ", ".join(map(str, doubt.cards))
    return CardNote("card doubted", doubt.person, f"{doubt.why}: {cards}", doubt)


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
