"""How clearly simulated people answer: some answers are unclear, as in a noisy room."""

from __future__ import annotations

from math import floor
from random import Random

from tangy_profiles.declared.judging import CERTAIN

UNCLEAR = 0.05
"""Probability that an answer in a simulated game or on the bench is unclear."""


class Clarity:
    """Draws the certainty of each answer."""

    def __init__(self, seed: int, chance: float) -> None:
        """Prepare the generator.

        Args:
            seed: seed of its random generator.
            chance: probability of an unclear answer, from 0 to 1.
        """
        self._draw = Random(f"{seed}/clarity").random
        self._chance = chance

    def certainty(self) -> float:
        """Return the certainty of a new answer, as a probability."""
        if self._draw() >= self._chance:
            return 1.0
        return floor(100 * CERTAIN * self._draw()) / 100
