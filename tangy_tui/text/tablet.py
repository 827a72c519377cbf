"""Words about connecting a tablet."""

from __future__ import annotations

TABLET_TITLE = "The tablet on Tangy's chest"


def tablet_lines(address: str, code: str) -> list[str]:
    """Say how to connect a tablet: the address to open, and the pairing code."""
    return [f"Open on the tablet: {address}", f"Enter this code there: {code}", "Or scan this:"]
