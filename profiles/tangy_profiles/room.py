"""The activity room in metres: its size, the front, the table, the seats.

x runs along the front wall from the left, y from the front wall towards the seats.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from math import hypot
from pathlib import Path

from tangy_profiles.defaults import SHIPPED
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import Person
from tangy_profiles.reading import Table, nearest, plain, read_toml
from tangy_profiles.state import FRONT

ELBOW_ROOM = 0.9
"""The width in m that a person needs at a table; closer cards would share a picture."""

USUAL, HALL = "common-room", "hall"
"""The default rooms."""

SEAT = "seat"
"""The word for a seat in a room whose file has none."""


@dataclass(frozen=True)
class Point:
    """A place on the floor, in metres."""

    x: float
    y: float

    def distance(self, other: Point) -> float:
        """Return the straight distance in metres."""
        return hypot(self.x - other.x, self.y - other.y)

    def towards(self, other: Point, share: float) -> Point:
        """Return the point at this share (0 to 1) of the way to another."""
        return Point(self.x + (other.x - self.x) * share, self.y + (other.y - self.y) * share)


@dataclass(frozen=True)
class Room:
    """A room; `table` is left, near, right, far; `reach` is the reading distance of cards.

    `seat_word` is the word for a seat, before its number ("seat 2") and after its name ("window
    seat"); `seat_names` has the name of each seat, "" for none.
    """

    name: str
    title: str
    width: float
    depth: float
    front: Point
    table: tuple[float, float, float, float]
    reach: float
    seats: tuple[Point, ...]
    seat_word: str = ""
    seat_names: tuple[str, ...] = ()
    tables: tuple[tuple[float, float, float, float], ...] = ()
    """Each of several tables in a row; `table` is their bounding box."""
    file: Path = Path()

    @property
    def source(self) -> str:
        """The argument of `load_room`: the name of a built-in room, else the path."""
        return self.file.stem if self.file.parent == _SHIPPED_ROOMS else str(self.file)

    @property
    def places(self) -> int:
        """The number of people who can sit here."""
        left, _, right, _ = self.table
        at_one = 0 if self.tables else int((right - left) / ELBOW_ROOM + 1e-9)
        return max(len(self.seats), at_one)

    def seated(self, count: int) -> tuple[Point, ...]:
        """Return a seat for each of `count` people: the room's own, or evenly spaced ones.

        With several tables, people are distributed from the left as in `at_tables`.
        """
        if count == len(self.seats):
            return self.seats
        if self.tables and count < len(self.seats):
            return tuple(
                own[int((place + 0.5) * len(own) / len(sitting))]
                for own, sitting in zip(self._seats_at_tables, self.at_tables(count), strict=True)
                for place in range(len(sitting))
            )
        left, _, right, _ = self.table
        y = self.seats[0].y
        return tuple(Point(left + (right - left) * (i + 0.5) / count, y) for i in range(count))

    def at_tables(self, count: int) -> tuple[range, ...]:
        """Return which of `count` people (from 0) sit at each table, distributed evenly."""
        if not self.tables:
            return (range(count),)
        free = [len(own) for own in self._seats_at_tables]
        taken = [0] * len(free)
        for _ in range(min(count, sum(free))):
            table = min(
                (t for t in range(len(free)) if taken[t] < free[t]), key=lambda t: (taken[t], t)
            )
            taken[table] += 1
        ends = list(accumulate(taken))
        return tuple(range(end - of, end) for end, of in zip(ends, taken, strict=True))

    def next_place(self, count: int) -> int:
        """Return the place (from 0) of one more person than `count`, who leave nobody's table.

        It is the last place at the table that gets a person more.
        """
        return self.next_places(count)[1][-1]

    def next_places(self, count: int) -> tuple[int, range]:
        """Return the table that gets a person more than `count`, and its places then, from 0.

        At any of these places the person makes nobody else change tables.
        """
        now, then = self.at_tables(count), self.at_tables(count + 1)
        grows = (
            (table, after)
            for table, (before, after) in enumerate(zip(now, then, strict=True))
            if len(after) > len(before)
        )
        return next(grows, (0, range(count, count + 1)))

    @property
    def _seats_at_tables(self) -> tuple[tuple[Point, ...], ...]:
        """The room's own seats at each of its tables, from the left."""
        return tuple(
            tuple(seat for seat in self.seats if left <= seat.x <= right)
            for left, _, right, _ in self.tables
        )

    def placed(self, people: Sequence[Person]) -> tuple[Person, ...]:
        """Return the people with the names of their seats, assigned in this order.

        A seat has its name only if each person sits in one of the room's own seats.
        """
        own = len(people) == len(self.seat_names)
        return tuple(
            replace(person, seats=self._ways(place, self.seat_names[place] if own else ""))
            for place, person in enumerate(people)
        )

    def _ways(self, place: int, name: str) -> tuple[str, ...]:
        ways = [f"{self.seat_word} {place + 1}"] if self.seat_word else []
        if name:
            ways.append(f"{name} {self.seat_word}".strip())
        return tuple(ways)

    def stand(self, place: str, people: Sequence[str]) -> Point:
        """Return where the robot stands: at the front, or across the table from a person."""
        if place == FRONT:
            return self.front
        seat = self.seated(len(people))[list(people).index(place)]
        near = next((t[1] for t in self.tables if t[0] <= seat.x <= t[2]), self.table[1])
        return Point(seat.x, near - self.reach)


_SHIPPED_ROOMS = (SHIPPED / "rooms").resolve()


def shipped_rooms() -> dict[str, Path]:
    """Return the files of the rooms that come with Tangy, by name."""
    return {path.stem: path for path in sorted(_SHIPPED_ROOMS.glob("*.toml"))}


def load_room(name: str = USUAL, own: Mapping[str, Path] | None = None) -> Room:
    """Load a room by name, or by the path of its TOML file.

    Args:
        name: the name or path.
        own: the files of the facility's own rooms, by name.

    Raises:
        ProfileError: one line with file, line, key, value and the nearest valid word.
    """
    known = {**(own or {}), **shipped_rooms()}
    if name not in known and not name.endswith(".toml"):
        raise ProfileError(plain(f"There is no room {name!r}: {nearest(name, known)}"))
    file = known.get(name) or Path(name)
    top = read_toml(file)
    width = top.number("width", 2, 100)
    depth = top.number("depth", 2, 100)
    front_x, front_y = top.numbers("front", 2, 0, max(width, depth))
    tables = _tables(top, max(width, depth))
    left, near, right, far = (
        min(table[0] for table in tables),
        min(table[1] for table in tables),
        max(table[2] for table in tables),
        max(table[3] for table in tables),
    )
    reach = top.number("reach", 0.2, 3)
    whole = (left, near, right, far)
    seats, names = list[Point](), list[str]()
    for entry in top.tables("seats"):
        seat = Point(entry.number("x", 0, width), entry.number("y", 0, depth))
        if seats and seat.x <= seats[-1].x:
            raise entry.wrong("x", "seats must go from the left to the right.")
        at = next((one for one in tables if one[0] <= seat.x <= one[2]), None)
        if at is None and len(tables) > 1:
            raise entry.wrong("x", "must be at one of the tables.")
        if seat.y <= (at or whole)[3]:
            raise entry.wrong("y", "must be behind the table, as Tangy sees it.")
        seats.append(seat)
        names.append(_words(entry, "name"))
        entry.close()
    if not seats:
        raise top.wrong("seats", "must hold at least one seat.")
    if len(set(filter(None, names))) < len(list(filter(None, names))):
        raise top.wrong("seats", "two of them have the same name.")
    if not (left < right <= width and near < far <= depth):
        raise top.wrong("table", "must be [left, near, right, far] within the room.")
    if front_x > width or front_y + reach > near or near - reach < 0:
        raise top.wrong("front", "must lie in the room, between the front wall and the table.")
    room = Room(
        top.text("name"),
        top.text("title"),
        width,
        depth,
        Point(front_x, front_y),
        whole,
        reach,
        tuple(seats),
        _words(top, "seat_word"),
        tuple(names),
        tables if len(tables) > 1 else (),
        file.resolve(),
    )
    top.close()
    return room


def _tables(top: Table, most: float) -> tuple[tuple[float, float, float, float], ...]:
    """Read the table of a room, or its tables in a row."""
    if "tables" not in top:
        left, near, right, far = top.numbers("table", 4, 0, most)
        return ((left, near, right, far),)
    found = []
    for entry in top.tables("tables"):
        left, near, right, far = entry.numbers("at", 4, 0, most)
        found.append((left, near, right, far))
        entry.close()
    if not found or any(a[2] > b[0] for a, b in pairwise(found)):
        raise top.wrong("tables", "must be at least one, from the left to the right.")
    return tuple(found)


def room_for(people: int) -> Room:
    """Return the first built-in room that has room for this many people."""
    room = load_room()
    return room if people <= room.places else load_room(HALL)


def _words(table: Table, key: str) -> str:
    """Read lower-case words, as they are spoken; "" if there are none."""
    words = table.text(key, "")
    if words and not re.fullmatch(r"[a-z']+( [a-z']+)*", words):
        raise table.wrong(key, "must be lower-case words, as they are spoken.")
    return words
