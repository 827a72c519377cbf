"""Words for the rooms to play in."""

from __future__ import annotations

from tangy_profiles.room import Room
from tangy_tui.text.numbers import counted

CHOOSE_ROOM = "In which room do you play?"
OTHER_ROOM = "Tangy is on: the room stays. Leave with esc to change it."


def places_words(room: Room) -> str:
    """Tell how many people can sit in a room, at how many tables."""
    tables = counted(max(1, len(room.tables)), "table")
    return f"{counted(room.places, 'seat')} at {tables}, {room.width:g} x {room.depth:g} m"


def room_words(room: Room, chosen: Room | None) -> str:
    """Name the room, and tell why it is not the chosen one."""
    if chosen is None or chosen is room:
        return room.title
    return f"{room.title}; {chosen.title} has only {counted(chosen.places, 'seat')}"


def no_chosen_room(why: str) -> str:
    """Tell that the chosen room cannot be used; `why` is a sentence."""
    return f"{why} Tangy uses another room. Choose one on the set-up page, or --room."


def fallback_words(room: Room, chosen: Room) -> str:
    """Tell which room Tangy uses because the chosen one is too small."""
    return f"Room: {room_words(room, chosen)}. Choose another one on the set-up page, or --room."
