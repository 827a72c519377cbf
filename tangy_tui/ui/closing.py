"""Closing a screen with what was said on it, and closing one by itself after a while."""

from __future__ import annotations

import asyncio
from typing import TypeVar

from tangy_tui.ui.base import TangyScreen, on_top

ResultT = TypeVar("ResultT")


def close(screen: TangyScreen[ResultT], result: ResultT) -> None:
    """Close a screen that is on top, and take away what was said on it."""
    if screen.is_active:
        screen.app.clear_notifications()
        screen.close(result)


async def close_after(screen: TangyScreen[ResultT], result: ResultT, seconds: float) -> None:
    """Close a screen after so many seconds, or when nothing lies over it any more."""
    await asyncio.sleep(seconds)
    await on_top(screen)
    close(screen, result)
