"""How clearly simulated people answer: some answers cannot be understood, as in a noisy room."""

from __future__ import annotations

from math import floor
from random import Random

from tangy_profiles.declared.judging import CERTAIN

UNCLEAR = 0.05
"""The chance that an answer in a simulated game or on the bench cannot be understood."""


class Clarity:
    """Draws the certainty of one answer after another."""

    def __init__(self, seed: int, chance: float) -> None:
        """Make it.

        Args:
            seed: of its random generator.
            chance: of an answer that is not sure enough to be judged, from 0 to 1.
        """
        self._draw = Random(f"{seed}/clarity").random
        self._chance = chance

    def certainty(self) -> float:
        """Return how sure an answer is that was just given, as a probability."""
        if self._draw() >= self._chance:
            return 1.0
        return floor(100 * CERTAIN * self._draw()) / 100
