"""Strict parsing of lines to the robot process: the request, or its error.

Nothing that a line can hold gets further than here unless it is of the kind that is wanted: a
number is finite, a pose has three of them, and an id can be answered to.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from typing import Any

from tangy_hw.device_protocols import Picture, Pose
from tangy_profiles.cards import PATTERNS
from tangy_profiles.worker_lines import Asked, LineError

OFTEN = frozenset(("drive", "picture", "settle", "sights", "wait"))
"""What is asked for so often that it is only logged where everything is wanted."""

MOST_CALLS = 4  # of people that are open at a time


def level_of(do: object) -> int:
    """Return the level at which it is logged that something is asked for, or was done."""
    return logging.DEBUG if do in OFTEN else logging.INFO


def id_of(asked: Asked) -> int | str | None:
    """Return the id by which a line is answered; None where it has none that can be one."""
    number = asked.get("id")
    return number if isinstance(number, int | str) and not isinstance(number, bool) else None


def number_of(asked: Mapping[str, Any], key: str) -> float:
    """Return a finite number.

    Raises:
        LineError: there is none under that key.
    """
    number = _finite(asked.get(key))
    if number is None:
        raise LineError(f"{key} must be a number.")
    return number


def pose_of(asked: Mapping[str, Any], key: str) -> Pose:
    """Return a pose: x and y in m, heading in radians.

    Raises:
        LineError: there are not three finite numbers under that key.
    """
    value = asked.get(key)
    numbers = [_finite(one) for one in value] if isinstance(value, list) else []
    x, y, heading = numbers if len(numbers) == 3 else (None, None, None)
    if x is None or y is None or heading is None:
        raise LineError(f"{key} must be x, y and heading.")
    return Pose(x, y, heading)


def text_of(asked: Mapping[str, Any], key: str, otherwise: str) -> str:
    """Return a text, or another where nothing stands under that key.

    Raises:
        LineError: something stands there that is no text.
    """
    value = asked.get(key, otherwise)
    if not isinstance(value, str):
        raise LineError(f"{key} must be a text.")
    return value


def wins_of(asked: Mapping[str, Any]) -> tuple[tuple[str, ...], int] | None:
    """Return the shapes that win, and how many of them together; None: as the activity has it.

    Raises:
        LineError: they are none that there are.
    """
    if "patterns" not in asked:
        return None
    shapes = asked["patterns"]
    if not isinstance(shapes, list) or not shapes or not set(shapes) <= set(PATTERNS):
        raise LineError("patterns must be shapes of a card.")
    return tuple(shapes), max(1, int(number_of(asked, "together")))


def picture_of(told: Mapping[str, Any]) -> Picture:
    """Return what the chest screen is to show."""
    return Picture(
        str(told.get("text", "")),
        str(told.get("number", "")),
        tuple(map(str, told.get("before", ()))),
        str(told.get("asks", "")),
        str(told.get("file", "")),
    )


def calls_of(told: Mapping[str, Any]) -> dict[str, str]:
    """Return the open calls that the chest screen may answer: who is called, by a key.

    Raises:
        LineError: they are none.
    """
    calls = told.get("calls")
    if not isinstance(calls, dict) or len(calls) > MOST_CALLS:
        raise LineError(f"Calls are up to {MOST_CALLS} people by their keys.")
    return {str(key): str(words) for key, words in calls.items()}


def _finite(value: object) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        number = float(value)
    except OverflowError:  # a whole number beyond any float
        return None
    return number if math.isfinite(number) else None
