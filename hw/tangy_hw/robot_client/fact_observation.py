"""Observations of facts in a live game, with their certainty and source."""

from __future__ import annotations

from typing import NamedTuple

from tangy_profiles.declared.typed_observations import TypedObservation


class FactObservation(NamedTuple):
    """An observation of a person: the fact, its certainty, and its source."""

    told: TypedObservation
    certainty: float
    source: str
