"""The numbers of a live game: the called ones, and the order of the rest."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.cards import Deck
from tangy_profiles.past_game import PastGame

LAST_CALLS = 5  # on the chest screen


class CallOrder:
    """The order of a game's numbers, drawn at its beginning."""

    def __init__(self, numbers: Sequence[int]) -> None:
        self.called: list[int] = []
        """Numbers that count as called, the latest last."""
        self._numbers = list(numbers)

    def resume(self, past: PastGame, activity: Activity) -> None:
        """Restore the state of an interrupted game."""
        self.called = past.called(activity)
        self._numbers = past.order(self._numbers, self.called)

    @property
    def next(self) -> tuple[int, ...]:
        """The next number, if one is left."""
        return tuple(self._numbers[len(self.called) : len(self.called) + 1])

    def labels(self, deck: Deck, most: int = LAST_CALLS) -> tuple[str, ...]:
        """Return the labels of the latest numbers, at most `most`, the newest first."""
        return tuple(map(deck.label, self.called[: -most - 1 : -1]))

    def take_back(self, number: int) -> None:
        """Revert a call: the number counts as not called, and will be called last."""
        if number in self.called:
            self.called.remove(number)
            self._numbers.remove(number)
            self._numbers.append(number)
