"""Closing a screen together with its toasts."""

from __future__ import annotations

from typing import TypeVar

from tangy_tui.ui.base import TangyScreen

ResultT = TypeVar("ResultT")


def close(screen: TangyScreen[ResultT], result: ResultT) -> None:
    """Close the screen on top, and clear its toasts."""
    if screen.is_active:
        screen.app.clear_notifications()
        screen.close(result)
