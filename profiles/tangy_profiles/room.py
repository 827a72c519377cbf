"""The activity room in metres: its size, the front, the table, the seats.

x runs along the front wall from the left, y from the front wall towards the seats.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise
from math import hypot
from pathlib import Path

from tangy_profiles.errors import ProfileError
from tangy_profiles.person import Person
from tangy_profiles.reading import Table, nearest, read_toml
from tangy_profiles.shipped import SHIPPED
from tangy_profiles.state import FRONT

AT_ONE_TABLE = 8
"""People who sit at the one table of a common room; more need a hall."""

SEAT = "seat"
"""What a seat is called in a room whose file has no word for it."""


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
    """A room; `table` is left, near, right, far; `reach` is how far off it cards are read.

    `seat_word` is what a seat is called here, before its number ("seat 2") and after its name
    ("window seat"); `seat_names` has the name of each seat, "" for one without.
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
    """Each of several tables in a row; `table` is what they take together."""

    def seated(self, count: int) -> tuple[Point, ...]:
        """Return a seat for each of `count` people: the room's own, or as many spread evenly.

        At several tables so many sit at each, from the left, as `at_tables` has it.
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
        """Return which of `count` people (from 0 on) sit at each table: about as many at each."""
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

    @property
    def _seats_at_tables(self) -> tuple[tuple[Point, ...], ...]:
        """The room's own seats at each of its tables, from the left."""
        return tuple(
            tuple(seat for seat in self.seats if left <= seat.x <= right)
            for left, _, right, _ in self.tables
        )

    def placed(self, people: Sequence[Person]) -> tuple[Person, ...]:
        """Return the people with the ways to call their seats, which they take in this order.

        A seat has its name only while each person sits in one of the room's own seats.
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
        return Point(seat.x, self.table[1] - self.reach)


def load_room(name: str = "common-room") -> Room:
    """Load a room by name, or by the path of its TOML file.

    Raises:
        ProfileError: one line that says file, key, value and the nearest valid word.
    """
    folder = SHIPPED / "rooms"
    shipped = {path.stem: path for path in folder.glob("*.toml")}
    if name not in shipped and not name.endswith(".toml"):
        raise ProfileError(f"There is no room {name!r}: {nearest(name, shipped)}")
    top = read_toml(shipped.get(name) or Path(name))
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
    seats, names = [], []
    for entry in top.tables("seats"):
        seats.append(Point(entry.number("x", 0, width), entry.number("y", 0, depth)))
        names.append(_words(entry, "name"))
        entry.close()
    alone = [s for s in seats if not any(t[0] <= s.x <= t[2] for t in tables)]
    if len(tables) > 1 and alone:
        raise top.wrong("seats", "must each be at one of the tables.")
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
        (left, near, right, far),
        reach,
        tuple(seats),
        _words(top, "seat_word"),
        tuple(names),
        tables if len(tables) > 1 else (),
    )
    top.close()
    return room


def _tables(top: Table, most: float) -> tuple[tuple[float, float, float, float], ...]:
    """Take the table of a room, or its tables in a row."""
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
    """Return the first of the rooms that come with Tangy in which so many people fit."""
    room = load_room()
    return room if people <= AT_ONE_TABLE else load_room("hall")


def _words(table: Table, key: str) -> str:
    """Take lower-case words, as they are spoken; "" if there are none."""
    words = table.text(key, "")
    if words and not re.fullmatch(r"[a-z']+( [a-z']+)*", words):
        raise table.wrong(key, "must be lower-case words, as they are spoken.")
    return words
