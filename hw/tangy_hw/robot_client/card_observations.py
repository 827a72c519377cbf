"""The cards of a live game: readings of the card beside the robot, and the cells to correct.

A card that is not known to belong to the person there is treated as unreadable.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from tangy_hw.dealt_cards import CardDoubt, CardLearnt, DealtCards
from tangy_hw.robot_client.commands import Commands
from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.card_face import LAST_CARD, called_cells, numbers_of
from tangy_profiles.scene import CardView

MOST_NEWS = 50  # maximum of queued news


class CardObservations:
    """Reads cards, and keeps the latest view of the one beside the robot in `view`."""

    def __init__(self, activity: Activity, commands: Commands) -> None:
        self.view: CardView | None = None
        """None if no card was looked at, or it could not be read."""
        self.looked: Callable[[str, str, Any], None] = lambda *_: None
        """Called with each card ("card") or face ("face") that was looked at: its place, and the
        result."""
        self.dealt = DealtCards()
        """Owners of the cards."""
        self.doubt: CardDoubt | None = None
        """Why the card before the robot is not judged; None if it is, or is not seen."""
        self.in_sight: tuple[int, ...] = ()
        """Numbers of all cards in sight at the last reading."""
        self.news: deque[CardDoubt | CardLearnt] = deque(maxlen=MOST_NEWS)
        """News for staff, once for each visit; the consumer removes them."""
        self.wins: dict[str, Any] | None = None
        """Winning patterns, and how many are required together, if not the activity's."""
        self._told: set[CardDoubt] = set()
        self._activity = activity
        self._commands = commands

    def begin(self) -> None:
        """Start a game."""
        self.dealt.begin()
        self.news.clear()
        self.leave()

    def leave(self) -> None:
        """Forget the card beside the robot, which has left."""
        self.view, self.doubt = None, None
        self._told.clear()

    def look(
        self, place: str, called: list[int], after: float = 0.0, *, person: str = ""
    ) -> dict[str, Any]:
        """Read the card at a place, `after` s from now; return the reading.

        `person` is who sits there, if not the place's owner. Several cards, or a card that is not
        known to be theirs, count as unread.

        Raises:
            DeviceError: the robot cannot look.
        """
        person = person or place
        identify = self.dealt.card_of(person) is None
        card = self._commands.do(
            "card",
            called=called,
            after=after,
            identify=identify,
            **({} if self.wins is None else self.wins),
        )
        self.view = None
        if self._is_doubted(person, card):
            return {**card, "card": None, "state": self._activity.unread}
        if card["card"] is not None and card["state"] != self._activity.unread:
            numbers = self._numbers(card["card"])
            cells = called_cells(self._activity.deck, numbers, set(called))
            self.view = CardView(place, numbers, card["marked"], cells)
        return card

    def _is_doubted(self, person: str, card: dict[str, Any]) -> bool:
        """Return whether a card is not known to be a person's; assign it if it is new."""
        number = card["card"]
        cards = card.get("cards") or ([] if number is None else [number])
        self.in_sight = tuple(cards) or self.in_sight
        doubt = self.dealt.doubt(person, cards)
        if doubt is not None and doubt not in self._told:
            self._told.add(doubt)
            self.news.append(doubt)
        self.doubt = doubt
        if doubt is not None or number is None:
            return doubt is not None
        if card.get("sure", True) and self.dealt.learn(person, number):
            self.news.append(CardLearnt(person, number))
        return self.dealt.card_of(person) is None

    def numbers_on(self, card: int) -> tuple[int, ...] | None:
        """Return the numbers of a printed card, None if there is no such card."""
        return self._numbers(card) if 1 <= card <= LAST_CARD else None

    def asked_about(self, behaviour: Behaviour) -> tuple[int, ...] | None:
        """Return the numbers that a behaviour asks about; None if none are visible."""
        view = self.view
        if view is None:
            return None
        wrong = behaviour.clears_marks
        cells = view.marked & ~view.called if wrong else view.called & ~view.marked
        return tuple(n for cell, n in enumerate(view.numbers) if cells >> cell & 1) or None

    def shows_done(
        self, card: dict[str, Any], behaviour: Behaviour, numbers: tuple[int, ...]
    ) -> bool:
        """Return whether a reading shows that the request was carried out."""
        if behaviour.shows_card:
            return bool(card["state"] != self._activity.unread)
        if card["card"] is None:
            return False
        face = self._numbers(card["card"])
        asked = sum(1 << cell for cell, number in enumerate(face) if number in numbers)
        wanted = asked if behaviour.sets_marks else 0
        told = asked.bit_count() == len(numbers) and not card["hidden"] & asked
        return bool(told and card["marked"] & asked == wanted)

    def _numbers(self, card: int) -> tuple[int, ...]:
        return numbers_of(self._activity.deck, card, self._commands.link.setup.deck_seed)
