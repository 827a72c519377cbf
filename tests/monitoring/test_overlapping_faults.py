"""A fault that comes while Tangy recovers from another: neither hides what became of the other."""

from __future__ import annotations

import pytest

from tests.monitoring.conftest import Supervise
from tests.support.games import codes, ended, play


@pytest.mark.parametrize(
    ("first", "second", "seed"),
    [
        # The place is not known again because the link that would tell of it is lost.
        ("carried-off@4", "link-lost@recovery", 17),
        # Who puts a card right while the camera is covered has not refused.
        ("card-out-of-sight@8", "camera-occluded@recovery", 0),
        # An expert mends a lost link first, or nothing that was mended could be seen to be.
        ("laser-disconnected@8", "link-lost@recovery", 0),
    ],
)
def test_both_are_told_once_and_nothing_else_is(
    supervise: Supervise, first: str, second: str, seed: int
) -> None:
    events = play(supervise(first, second, seed=seed))
    assert codes(events) == [first.partition("@")[0], second.partition("@")[0]]
    assert ended(events).stopped is None
