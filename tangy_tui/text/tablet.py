"""How a tablet is connected, in words."""

from __future__ import annotations

TABLET_TITLE = "The tablet on Tangy's chest"


def tablet_lines(address: str, code: str) -> list[str]:
    """Say how a tablet is connected: its address and the pairing code."""
    return [f"Open on the tablet: {address}", f"The code there is: {code}", "Or scan this:"]
