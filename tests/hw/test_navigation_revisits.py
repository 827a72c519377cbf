"""Torn loops are distinguished from closed ones, even if no beam contradicts the map."""

from __future__ import annotations

import pytest

from tangy_hw.navigation.agreement import contradicted, verdict
from tangy_hw.navigation.alignment import aligned
from tangy_hw.navigation.mapping import PlacedScan, map_of_scans
from tangy_hw.navigation.revisits import Revisits, revisits
from tests.hw.corridors import Slip, logged, ring, two_rings

SLIP = Slip(0.3, 0.06)


def judged(scans: list[PlacedScan]) -> tuple[float, Revisits]:
    found = aligned(scans)
    return contradicted(found, map_of_scans(found, 0.1)), revisits(found)


@pytest.mark.parametrize(
    ("side", "seed"), [(12.0, 31), pytest.param(18.0, 32, marks=pytest.mark.slow)]
)
def test_a_ring_corridor_closes_unless_its_wheels_slipped(side: float, seed: int) -> None:
    walls, way = ring(side, 2.0, 4.0)
    share, found = judged(logged(walls, way, seed))
    assert verdict(share, found) == "closed" and found.closed >= 3
    _, found = judged(logged(walls, way, seed, SLIP))
    assert verdict(0.0, found) == "torn" and found.off > 1.0  # whatever the beams say


@pytest.mark.slow
def test_one_torn_ring_of_two_makes_a_map_torn() -> None:
    walls, way = two_rings(11.0, 2.0)
    assert verdict(*judged(logged(walls, way, 33))) == "closed"
    assert verdict(*judged(logged(walls, way, 33, Slip(0.6, 0.06)))) == "torn"


@pytest.mark.slow
def test_a_drive_without_revisits_is_open() -> None:
    walls, way = ring(14.0, 2.0, 0.0)
    share, found = judged(logged(walls, way[:3], 34))
    assert (found.closed, found.torn, found.crossed) == (0, 0, 0)
    assert verdict(share, found) == "open"


@pytest.mark.parametrize(
    ("share", "found", "says"),
    [
        (0.01, Revisits(), "open"),
        (0.2, Revisits(closed=9), "torn"),
        (0.13, Revisits(closed=10), "torn"),
        (0.01, Revisits(closed=3, torn=3), "closed"),
        (0.01, Revisits(closed=3, torn=4), "torn"),
        (0.01, Revisits(closed=9, torn=3, last=2), "torn"),
        (0.05, Revisits(crossed=5), "unknown"),
        (0.01, Revisits(crossed=5), "open"),
    ],
)
def test_the_verdict_weighs_closed_and_torn_revisits(
    share: float, found: Revisits, says: str
) -> None:
    assert verdict(share, found) == says


def test_an_empty_log_has_no_revisits() -> None:
    assert revisits([]) == Revisits()
