"""What is said about the program in a browser."""

from __future__ import annotations

NOT_INSTALLED = "Pages in a browser need one more package: pip install 'tangy[serve]'"
GIVE_ADDRESS = (
    "Give the address by which browsers reach this machine, such as --host 192.168.1.20; "
    "no browser can open 0.0.0.0."
)
WHO_MAY = (
    "Whoever knows this address sees the game and can stop the robot, and nothing else. "
    "Close with ctrl+c."
)
NOT_ENCRYPTED = (
    "What is shown goes through the network without encryption: use a network that you trust."
)


def open_words(address: str) -> str:
    """Say what is opened in a browser."""
    return f"Open this in a browser: {address}"
