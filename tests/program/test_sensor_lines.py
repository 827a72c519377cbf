"""Devices on one line each, and as JSON."""

from __future__ import annotations

import pytest

from tangy_profiles.health import OK, Health, Reading
from tangy_profiles.robot import load_robot
from tangy_tui.text.sensors import (
    DeviceSummaries,
    DeviceSummary,
    rate_words,
    sensor_document,
    sensor_line,
)

ROBOT = load_robot()


def told(*readings: Reading) -> dict[str, DeviceSummary]:
    def health() -> Health:
        return readings

    return {
        one.device.name: one for one in DeviceSummaries(ROBOT, health=health, live=True).current()
    }


@pytest.mark.parametrize(
    ("rate", "words"),
    [(None, ""), (0.0, "0.0 Hz"), (2.46, "2.5 Hz"), (9.8, "10 Hz"), (40.2, "40 Hz")],
)
def test_a_rate_is_shown_in_hertz(rate: float | None, words: str) -> None:
    assert rate_words(told(Reading("laser", rate=rate))["laser"]) == words


def test_the_rate_is_shown_between_the_age_and_the_problem() -> None:
    found = told(Reading("laser", 0.1, OK, {}, 10.0), Reading("base", 3.0, OK, {}, 1.0))
    assert sensor_line(found["laser"], 14).endswith("0.1 s  10 Hz")
    assert "3.0 s  1.0 Hz  Its data is too old" in sensor_line(found["base"], 14)
    assert sensor_document(found["laser"])["rate"] == 10.0
    assert sensor_document(found["voice"])["rate"] is None
