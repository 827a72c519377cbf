"""Words for cameras and their pictures."""

from __future__ import annotations

TOGETHER = "To read several pictures as one card, add --together."
NO_SOURCE = "No camera has a source. Name one: `tangy sensors --camera camera=0`."


def rate_words(width: int, height: int, rate: float) -> str:
    """Tell the size of a camera's pictures (pixels), and their rate (pictures a second)."""
    return f"{width} x {height}, {rate:.1f} pictures a second."


def pictures_in(folder: object) -> str:
    """Tell where pictures of cards were saved."""
    return f"The pictures are in {folder}. Label each one in the JSON file beside it."


def no_picture(source: str) -> str:
    """Tell that no picture came from a camera."""
    return f"tangy: {source}: no picture came."
