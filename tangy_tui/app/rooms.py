"""The rooms to play in: those shipped with Tangy, and the house's own in its data folder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.reading import plain
from tangy_profiles.room import Room, load_room, shipped_rooms
from tangy_tui.app.choice_file import keep_choice, read_choice

FOLDER = "rooms"
"""The folder with the house's own room files, in the data folder."""
FILE = "room.toml"
"""The file with the chosen room, in the data folder; without it, the number of people determines
it."""


@dataclass(frozen=True, slots=True)
class KnownRoom:
    """A room to choose: the source that loads it, and the room, or the mistake in its file."""

    source: str
    room: Room | None
    problem: str = ""


def own_rooms(folder: Path) -> dict[str, Path]:
    """Return the files of the house's own rooms, by name."""
    return {path.stem: path for path in sorted((folder / FOLDER).glob("*.toml"))}


def find_room(folder: Path, wanted: str) -> Room:
    """Load a room by its name or the path of its file.

    Raises:
        ProfileError: there is no such room, or its file has a mistake.
    """
    return load_room(wanted, own_rooms(folder))


def known_rooms(folder: Path, present: Room) -> Iterator[KnownRoom]:
    """Yield the rooms that can be chosen, the present one first."""
    yield KnownRoom(present.source, present)
    for file in (*own_rooms(folder).values(), *shipped_rooms().values()):
        if file.resolve() == present.file:
            continue
        try:
            room = load_room(str(file))
        except ProfileError as error:
            yield KnownRoom(str(file), None, str(error))
        else:
            yield KnownRoom(room.source, room)


def check_places(room: Room, people: int) -> None:
    """Check that a number of people can sit in a room.

    Raises:
        TangyError: there are too few seats.
    """
    if people > room.places:
        raise TangyError(
            plain(f"{room.title} has {room.places} seats, and {people} people take part.")
        )


def chosen_room(folder: Path) -> Room | None:
    """Return the room chosen for this data folder, None if the number of people determines it.

    Raises:
        ProfileError: the file that names it, or the room's own file, has a mistake.
    """
    name = read_choice(folder / FILE, "room")
    return find_room(folder, name) if name else None


def choose_room(folder: Path, room: Room) -> None:
    """Store the room to play in from now on.

    Raises:
        TangyError: it cannot be written.
    """
    keep_choice(folder / FILE, "room", source_in(folder, room))


def source_in(folder: Path, room: Room) -> str:
    """Return the source of a room; of one in the data folder, which may be moved, its name."""
    own = own_rooms(folder).get(room.file.stem)
    return room.file.stem if own is not None and own.resolve() == room.file else room.source
