"""The numbers of a live game: which were called, and in which order the rest come."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.cards import Deck
from tangy_profiles.past_game import PastGame

LAST_CALLS = 5  # that the chest screen shows


class CallOrder:
    """The order of a game's numbers, which is drawn at its beginning."""

    def __init__(self, numbers: Sequence[int]) -> None:
        self.called: list[int] = []
        """The numbers that count as called, the last one last."""
        self._numbers = list(numbers)

    def resume(self, past: PastGame, activity: Activity) -> None:
        """Be where a game was interrupted."""
        self.called = past.called(activity)
        self._numbers = past.order(self._numbers, self.called)

    @property
    def next(self) -> tuple[int, ...]:
        """The number that comes next, if one is left."""
        return tuple(self._numbers[len(self.called) : len(self.called) + 1])

    def labels(self, deck: Deck, most: int = LAST_CALLS) -> tuple[str, ...]:
        """Return the last numbers as they are shown, `most` at most, the newest first."""
        return tuple(map(deck.label, self.called[: -most - 1 : -1]))

    def take_back(self, number: int) -> None:
        """Take a call back: its number counts as not called, and comes again last."""
        if number in self.called:
            self.called.remove(number)
            self._numbers.remove(number)
            self._numbers.append(number)
