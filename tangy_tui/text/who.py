"""How a new teacher is asked for a name, and what is said of it."""

from __future__ import annotations

WHO = "Who are you?"
WHO_DETAIL = "Tangy keeps with each game who has shown it, and tells teachers apart by their names."
NAME_KEYS = "enter keeps the name   esc not now"
TYPE_NAME = "Type your name and press Enter, or just Enter to be called {}."


def renamed_teacher(name: str) -> str:
    """Say who teaches from now on."""
    return f"You teach as {name} from now on."
