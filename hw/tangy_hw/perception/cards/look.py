"""Fuses the readings of a card at several moments, and requires two moments for claims.

A single frame may be misread: a finger as a chip, a stripe of shadow as a mark. A win or a mistake
is only reported if frames of two moments show it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.cards import CardState, is_borne_out

if TYPE_CHECKING:
    from tangy_hw.perception.cards.reader import CardReader, CardReading

MOMENT = 0.1
"""Seconds between two moments: by then a hand or the light has moved."""


class CardLook:
    """The fused readings of one look at a card. Call `add` until `is_over`."""

    def __init__(
        self,
        reader: CardReader,
        states: Sequence[CardState],
        called: set[int],
        *,
        identify: bool = False,
    ) -> None:
        """Start without readings.

        Args:
            reader: the reader of the card.
            states: the activity's user states in order of precedence.
            called: the called numbers.
            identify: require that two moments identify the card.
        """
        self._reader = reader
        self._states = states
        self._called = called
        self._identify = identify
        self._readings: list[CardReading] = []
        self._seen: set[bytes] = set()
        self._last = float("-inf")
        self._unread = next(state.name for state in states if state.checker == "unread")
        self.reading = reader.nothing("")
        """Fused reading; no card if several are in sight."""
        self.state = self._unread
        """User activity state; the unread one if undecided."""

    def is_another(self, picture: bytes, stamp: float) -> bool:
        """Return whether a frame, taken at a time in s, shows another moment than those before."""
        if stamp < self._last + MOMENT or picture in self._seen:
            return False
        self._seen.add(picture)
        self._last = stamp
        return True

    def add(self, reading: CardReading) -> None:
        """Add the reading of another frame."""
        self._readings.append(reading)
        self.reading = self._reader.fuse(self._readings)
        self.state = self._reader.state(self.reading, self._states, self._called)
        if not self._is_borne_out():
            self.state = self._unread

    @property
    def pictures(self) -> int:
        """Number of frames read."""
        return len(self._readings)

    @property
    def sure(self) -> bool:
        """Whether two moments show this card, and none shows another."""
        told = [reading for reading in self._readings if reading.card is not None]
        return self.reading.card is not None and len(told) > 1

    @property
    def is_over(self) -> bool:
        """Whether more frames would add nothing."""
        if len(self.reading.cards) > 1:
            return True
        return self.state != self._unread and (self.sure or not self._identify)

    def _is_borne_out(self) -> bool:
        """Return whether two moments show what the state depends on, and none disagrees."""
        checker = next(state.checker for state in self._states if state.name == self.state)
        deck, card = self._reader.deck, self.reading.card
        if card is None:
            return True
        numbers = numbers_of(deck, card, self._reader.deck_seed)
        marked, unmarked = self._agreed()
        cells = called_cells(deck, numbers, self._called)
        return is_borne_out(checker, deck, marked, unmarked, cells)

    def _agreed(self) -> tuple[int, int]:
        """Return masks of the cells that two moments show as marked, and as unmarked."""
        told = [reading for reading in self._readings if reading.card is not None]
        marked = [reading.marked & ~reading.hidden for reading in told]
        unmarked = [~reading.marked & ~reading.hidden for reading in told]
        return _twice(marked) & ~_any(unmarked), _twice(unmarked) & ~_any(marked)


def _any(masks: Sequence[int]) -> int:
    found = 0
    for mask in masks:
        found |= mask
    return found


def _twice(masks: Sequence[int]) -> int:
    """Return the bits that are set in two or more masks."""
    once = twice = 0
    for mask in masks:
        twice |= once & mask
        once |= mask
    return twice
