"""Strict parsing of lines to the robot process: the request, or its error.

Only values of the required type pass: a number is finite, a pose has three of them, and an id can
be used in an answer.
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
"""Frequent requests, which are only logged at the debug level."""

MOST_CALLS = 4  # maximum of open calls


def level_of(do: object) -> int:
    """Return the log level for a request and its outcome."""
    return logging.DEBUG if do in OFTEN else logging.INFO


def id_of(asked: Asked) -> int | str | None:
    """Return the id of a line; None if it has no valid one."""
    number = asked.get("id")
    return number if isinstance(number, int | str) and not isinstance(number, bool) else None


def number_of(asked: Mapping[str, Any], key: str) -> float:
    """Return a finite number.

    Raises:
        LineError: the key has no such number.
    """
    number = _finite(asked.get(key))
    if number is None:
        raise LineError(f"{key} must be a number.")
    return number


def pose_of(asked: Mapping[str, Any], key: str) -> Pose:
    """Return a pose: x and y in m, heading in rad.

    Raises:
        LineError: the key does not have three finite numbers.
    """
    value = asked.get(key)
    numbers = [_finite(one) for one in value] if isinstance(value, list) else []
    x, y, heading = numbers if len(numbers) == 3 else (None, None, None)
    if x is None or y is None or heading is None:
        raise LineError(f"{key} must be x, y and heading.")
    return Pose(x, y, heading)


def text_of(asked: Mapping[str, Any], key: str, otherwise: str) -> str:
    """Return a text, or a default if the key is missing.

    Raises:
        LineError: the value is not a text.
    """
    value = asked.get(key, otherwise)
    if not isinstance(value, str):
        raise LineError(f"{key} must be a text.")
    return value


def wins_of(asked: Mapping[str, Any]) -> tuple[tuple[str, ...], int] | None:
    """Return the winning patterns, and how many are required together; None: the activity's.

    Raises:
        LineError: the patterns are unknown.
    """
    if "patterns" not in asked:
        return None
    shapes = asked["patterns"]
    if not isinstance(shapes, list) or not shapes or not set(shapes) <= set(PATTERNS):
        raise LineError("patterns must be shapes of a card.")
    return tuple(shapes), max(1, int(number_of(asked, "together")))


def picture_of(told: Mapping[str, Any]) -> Picture:
    """Return the picture for the chest screen."""
    return Picture(
        str(told.get("text", "")),
        str(told.get("number", "")),
        tuple(map(str, told.get("before", ()))),
        str(told.get("asks", "")),
        str(told.get("file", "")),
    )


def calls_of(told: Mapping[str, Any]) -> dict[str, str]:
    """Return the open calls for the chest screen: the called person's name by key.

    Raises:
        LineError: the calls are invalid.
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
    except OverflowError:  # an integer beyond any float
        return None
    return number if math.isfinite(number) else None
