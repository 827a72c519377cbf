"""The cards of a live game: readings of the card beside the robot, and the cells to correct.

A card that is not known to be that of the person who sits there is as good as out of sight.
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

MOST_NEWS = 50  # that wait to be told


class CardObservations:
    """Looks at cards, and keeps the newest view of the one beside the robot in `view`."""

    def __init__(self, activity: Activity, commands: Commands) -> None:
        self.view: CardView | None = None
        """None where no card was looked at, or it could not be read."""
        self.looked: Callable[[str, str, Any], None] = lambda *_: None
        """Is told of each card ("card") and face ("face") that was looked at, with whose place it
        is at, and what was seen."""
        self.dealt = DealtCards()
        """Which card is whose."""
        self.doubt: CardDoubt | None = None
        """Why the card before the robot is not judged, None where it is, or is not seen."""
        self.in_sight: tuple[int, ...] = ()
        """The numbers of all cards that were in sight last, wherever that was."""
        self.news: deque[CardDoubt | CardLearnt] = deque(maxlen=MOST_NEWS)
        """What staff are to be told, once for each visit; whoever tells it takes it out."""
        self.wins: dict[str, Any] | None = None
        """The shapes that win, and how many of them together, where not as the activity has it."""
        self._told: set[CardDoubt] = set()
        self._activity = activity
        self._commands = commands

    def begin(self) -> None:
        """Begin a game."""
        self.dealt.begin()
        self.news.clear()
        self.leave()

    def leave(self) -> None:
        """Forget the card that was beside the robot, which stands elsewhere now."""
        self.view, self.doubt = None, None
        self._told.clear()

    def look(
        self, place: str, called: list[int], after: float = 0.0, *, person: str = ""
    ) -> dict[str, Any]:
        """Read the card at a place, after so many s; return the reading.

        `person` is who sits there, if it is not whose place it is. Of a card that is not known to
        be theirs nothing is told, and neither is of several.

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
        """Say whether a card is not known to be a person's; it may be learnt that it is."""
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
        """Return the numbers of a printed card, None where there is none of that number."""
        return self._numbers(card) if 1 <= card <= LAST_CARD else None

    def asked_about(self, behaviour: Behaviour) -> tuple[int, ...] | None:
        """Return the numbers that a behaviour is to ask about; None: there are none to be seen."""
        view = self.view
        if view is None:
            return None
        wrong = behaviour.effect == "clear wrong marks"
        cells = view.marked & ~view.called if wrong else view.called & ~view.marked
        return tuple(n for cell, n in enumerate(view.numbers) if cells >> cell & 1) or None

    def shows_done(
        self, card: dict[str, Any], behaviour: Behaviour, numbers: tuple[int, ...]
    ) -> bool:
        """Return whether a reading shows that the request was carried out."""
        if behaviour.effect == "bring card closer":
            return bool(card["state"] != self._activity.unread)
        if card["card"] is None:
            return False
        face = self._numbers(card["card"])
        asked = sum(1 << cell for cell, number in enumerate(face) if number in numbers)
        wanted = asked if behaviour.effect == "set missing marks" else 0
        told = asked.bit_count() == len(numbers) and not card["hidden"] & asked
        return bool(told and card["marked"] & asked == wanted)

    def _numbers(self, card: int) -> tuple[int, ...]:
        return numbers_of(self._activity.deck, card, self._commands.link.setup.deck_seed)
