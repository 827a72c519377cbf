"""Waiting for events that others cause."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

PATIENCE = 10.0
"""Seconds after which an expected event counts as missing."""


async def until(so: Callable[[], bool], patience: float = PATIENCE) -> None:
    """Wait until a condition is true.

    Raises:
        AssertionError: the condition is not true in time.
    """
    for _ in range(round(patience * 100)):
        if so():
            return
        await asyncio.sleep(0.01)
    raise AssertionError("it did not come about in time")
