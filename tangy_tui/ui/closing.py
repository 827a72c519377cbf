"""Closing a screen with what was said on it."""

from __future__ import annotations

from typing import TypeVar

from tangy_tui.ui.base import TangyScreen

ResultT = TypeVar("ResultT")


def close(screen: TangyScreen[ResultT], result: ResultT) -> None:
    """Close a screen that is on top, and take away what was said on it."""
    if screen.is_active:
        screen.app.clear_notifications()
        screen.close(result)
