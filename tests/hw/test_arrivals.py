"""The rate of arriving data, in 1/s."""

from __future__ import annotations

import pytest

from tangy_hw.rate_estimator import FIRST, WINDOW, RateEstimator


@pytest.mark.parametrize("hertz", [1, 2.5, 10, 40])
@pytest.mark.parametrize("seconds", [1.5, 2.0, 7.3])
def test_the_rate_is_estimated_from_recent_arrivals(hertz: float, seconds: float) -> None:
    arrivals = RateEstimator()
    for number in range(round(seconds * hertz) + 1):
        arrivals.count(50 + number / hertz)
    now = 50 + round(seconds * hertz) / hertz
    assert arrivals.rate(now) == pytest.approx(hertz, rel=0.35 if hertz < 2 else 0.1)


def test_no_rate_is_given_before_the_first_full_interval() -> None:
    arrivals = RateEstimator()
    assert arrivals.rate(100) is None
    arrivals.count(100)
    arrivals.count(100.1)
    assert arrivals.rate(100 + FIRST - 0.1) is None
    assert arrivals.rate(100 + FIRST) is not None


def test_the_rate_falls_to_zero_in_silence_and_starts_fresh_when_data_returns() -> None:
    arrivals = RateEstimator()
    for number in range(31):
        arrivals.count(number / 10)
    assert arrivals.rate(3 + WINDOW / 2) == pytest.approx(5)
    assert arrivals.rate(3 + WINDOW) == 0
    for number in range(40):
        arrivals.count(10 + number / 20)
    assert arrivals.rate(10 + 39 / 20) == pytest.approx(20)
    arrivals.restart()
    assert arrivals.rate(12) is None


def test_arrivals_in_one_batch_are_all_counted() -> None:
    arrivals = RateEstimator()
    for number in range(21):
        arrivals.count(number / 5, 4)
    assert arrivals.rate(4) == pytest.approx(20)
