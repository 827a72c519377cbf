"""Waiting for conditions: a wait that is too long fails, and holds up no other test."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from typing import Any

from textual.pilot import Pilot

PATIENCE = 60.0  # s: more than anything takes on a busy machine
LOOK_SECONDS = 0.01


async def until(holds: Callable[[], object], seconds: float = PATIENCE) -> None:
    """Wait until a condition is true, for this many s at most."""
    async with asyncio.timeout(seconds):
        while not holds():  # noqa: ASYNC110 - whatever holds, there is no event of it
            await asyncio.sleep(LOOK_SECONDS)


async def until_shown(pilot: Pilot[Any], holds: Callable[[], object]) -> None:
    """Wait until a condition is true in a program with screens, and drawn."""
    async with asyncio.timeout(PATIENCE):
        while not holds():
            await pilot.pause(LOOK_SECONDS)
    await pilot.pause()


def wait_until(holds: Callable[[], object], what: str = "it holds") -> None:
    """Wait until a condition is true in a test without asyncio."""
    deadline = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < deadline, f"it did not come about that {what}"
        time.sleep(LOOK_SECONDS)
