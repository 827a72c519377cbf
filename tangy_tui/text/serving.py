"""Words about the program in a browser."""

from __future__ import annotations

NOT_INSTALLED = "To show games in a browser, install one more package: pip install 'tangy[serve]'"
GIVE_ADDRESS = (
    "Give the address by which browsers reach this machine, such as --host 192.168.1.20; "
    "no browser can open 0.0.0.0."
)
WHO_MAY = (
    "Anybody with this address can see the game and stop the robot, and nothing else. "
    "Press ctrl+c to close it."
)
NOT_ENCRYPTED = "The page is not encrypted: use a network that you trust."


def open_words(address: str) -> str:
    """Tell which address to open in a browser."""
    return f"Open this in a browser: {address}"
