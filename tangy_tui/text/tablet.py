"""Words about connecting a tablet."""

from __future__ import annotations

TABLET_TITLE = "The tablet on Tangy's chest"


def screen_words(address: str, code: str) -> str:
    """Tell in a line how to connect a tablet as the chest screen."""
    return f"Chest screen: open {address} on the tablet; the code there is {code}."


def tablet_lines(address: str, code: str) -> list[str]:
    """Tell how to connect a tablet: the address to open, and the pairing code."""
    return [f"Open on the tablet: {address}", f"Enter this code there: {code}", "Or scan this:"]
