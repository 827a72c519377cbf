"""Words about a new person who joins a running game, or cannot."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_tui.text.numbers import listed

REFUSED = {
    "no name": "Type the name as well, as in: add Berta.",
    "nobody joins": "Nobody new can join a simulated game. Add them before the next one.",
    "teams play": "Teams play this game: seat the new person with one of them.",
    "joining": "Not now: somebody is just joining. Say it again when the game goes on.",
    "not at front": (
        "Tangy could not drive to the front, so nobody has joined. Add them again when it can move."
    ),
}
"""Why nobody can join, or nothing else be done meanwhile, by the kind of note."""


def known_words(name: str) -> str:
    """Tell that a person of this name takes part."""
    return f"{name} takes part already. If {name} was away, type: here {name}."


def which_words(wanted: str, names: Sequence[str]) -> str:
    """Ask whether a known person is meant whose first name was typed."""
    take = "takes" if len(names) == 1 else "take"
    who = " or ".join(f"here {name}" for name in names)
    return (
        f"{listed(names)} {take} part already. If you mean {listed(names, 'or')}, type: {who}. "
        f"For another {wanted}, type the whole name."
    )


def full_words(people: str) -> str:
    """Tell that the most people take part."""
    return f"{people} people take part already, and that is the most. Nobody else can join."


def no_seat_words(room: str, seats: str) -> str:
    """Tell that each seat of the room is taken."""
    return (
        f"All {seats} seats of {room} are taken. End the game, and choose a room with more "
        "seats before the next one."
    )


GOES_ON = "the game goes on"
"""The header while Tangy sets itself up for a new person."""


def setting_up_words(names: Sequence[str]) -> str:
    """Tell in the header that Tangy sets itself up for new people."""
    return f"sets itself up for {listed(names)}"


def sets_up_words(names: Sequence[str]) -> str:
    """Tell that Tangy sets itself up for new people, and what follows."""
    return f"Tangy sets itself up for {listed(names)}. Then the game goes on."


def joined_words(names: Sequence[str]) -> str:
    """Tell that people have joined."""
    return f"{listed(names)} {'has' if len(names) == 1 else 'have'} joined."


WHERE = "Where does {} sit?"


def no_seat_there_words(seats: str, table: str) -> str:
    """Tell which seats a new person can take, at which table if there are several."""
    if table:
        return f"There is room at table {table}, on {seats}: then nobody changes tables."
    return f"There is room on {seats}."


def beside_words(neighbours: Sequence[str]) -> str:
    """Tell between whom a seat is, or beside whom at the end of a table."""
    match neighbours:
        case (before, after):
            return f"between {before} and {after}"
        case (one,):
            return f"beside {one}"
        case _:
            return ""
