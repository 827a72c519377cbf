"""The cards of a live game: what was seen of the one beside the robot, and what that asks for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tangy_hw.commands import Commands
from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.scene import CardView


class CardViews:
    """Looks at cards, and keeps the newest view of the one beside the robot in `view`."""

    def __init__(self, activity: Activity, commands: Commands) -> None:
        self.view: CardView | None = None
        """None where no card was looked at, or it could not be read."""
        self.looked: Callable[[str, str, Any], None] = lambda *_: None
        """Is told of each card ("card") and face ("face") that was looked at, with whose place it
        is at, and what was seen."""
        self._activity = activity
        self._commands = commands

    def look(self, place: str, called: list[int], after: float = 0.0) -> dict[str, Any]:
        """Look at the card at a place, after so many s; return what is seen.

        Raises:
            DeviceError: the robot cannot look.
        """
        card = self._commands.do("card", called=called, after=after)
        self.view = None
        if card["card"] is not None and card["state"] != self._activity.unread:
            numbers = self._numbers(card["card"])
            cells = called_cells(self._activity.deck, numbers, set(called))
            self.view = CardView(place, numbers, card["marked"], cells)
        return card

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
        """Say whether a card that was looked at shows that what was asked for has been done."""
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
