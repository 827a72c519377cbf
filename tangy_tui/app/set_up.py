"""What staff choose before a live game: who is here, seats, activity and plan.

The screen and the console drive the same object.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeVar

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import USUAL_PACE, GamePlan, next_pace
from tangy_profiles.reading import nearest, plain
from tangy_profiles.room import SEAT
from tangy_tui.app.chosen_activity import choosable
from tangy_tui.app.game_commands import Joins
from tangy_tui.app.joining import known_refusal, let_join
from tangy_tui.app.last_plan import last_plan, seated_as_before
from tangy_tui.app.on_duty import on_duty, take_duty
from tangy_tui.app.readiness import Readiness
from tangy_tui.app.rooms import KnownRoom, choose_room, find_room, known_rooms
from tangy_tui.app.staff_notes import StaffNote

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_tui.app.workspace import Workspace

T = TypeVar("T")

Choice = Literal["seats", "patterns", "strength"]
"""A choice that another activity may not have."""

MINUTES = (0, 15, 20, 30, 40, 60, 90)
"""The planned lengths of a session in minutes; 0: no limit."""


@dataclass
class SetUp(Readiness):
    """The choices for the games of a session. Its methods change them; `plan` is the result."""

    seats: list[str] = field(default_factory=list)
    """The ids of the participants, in the order of their seats."""
    away: set[str] = field(default_factory=set)
    patterns: list[str] = field(default_factory=list)
    several: bool = False
    visits: bool = False
    strength: str = ""
    pace: float = USUAL_PACE
    minutes: int = 0
    on_duty: str = ""
    dropped: list[Choice] = field(default_factory=list)
    """The choices that the last change of activity could not keep."""
    _order: list[str] = field(default_factory=list)  # of seats, also of people who do not play now
    _before: list[str] | None = None  # the seats before a person was picked up
    _moved: bool = False  # whether people changed seats
    _pace_given: bool = False
    _away: set[str] = field(default_factory=set)  # people who do not play now

    @classmethod
    def of(cls, workspace: Workspace, pace: float | None = None) -> SetUp:
        """Start with everybody present, in their last seats.

        `pace` is in s from call to call; None: the usual one, or that of the last game.
        """
        set_up = cls(workspace, on_duty=on_duty(workspace.store.folder))
        if pace is not None:
            set_up.pace, set_up._pace_given = pace, True
        set_up._seat_as_before()
        return set_up

    def offer_last_plan(self) -> bool:
        """Offer what staff chose last for this activity; who was away only on the same day.

        Return whether there was a game.
        """
        last = last_plan(self.workspace.store, self.workspace.activity.name)
        if last is None:
            return False
        rules = self.workspace.activity.rules
        self.patterns = [one.name for one in rules.patterns if one.name in last.patterns]
        self.patterns.sort(key=last.patterns.index)
        self.several, self.visits, self.minutes = last.several, last.visits, last.minutes
        if last.strength in (one.name for one in rules.strengths):
            self.strength = last.strength
        if last.pace and not self._pace_given:
            self.pace = last.pace
        self.away = {person for person in last.absent if person in self.seats}
        return True

    # ----------------------------------------------------------------------------- the choices

    def toggle(self, person: str) -> None:
        """Mark a present person as absent, or an absent one as present."""
        self.away ^= {person}

    @property
    def tables(self) -> tuple[tuple[str, ...], ...]:
        """Who sits at each table, in the order of the tables in the room."""
        at_tables = self.workspace.room.at_tables(len(self.seats))
        return tuple(tuple(self.seats[place] for place in sitting) for sitting in at_tables)

    def move(self, person: str, by: int) -> None:
        """Swap a person's seat with the one `by` places further, as long as the robot is off."""
        at = self.seats.index(person)
        self.change_seats(person, self.seats[min(len(self.seats) - 1, max(0, at + by))])

    def change_seats(self, person: str, other: str) -> None:
        """Swap the seats of two people, as long as the robot is off."""
        at, to = self.seats.index(person), self.seats.index(other)
        if self.world is None and to != at:
            self._moved = True
            self.seats[at], self.seats[to] = self.seats[to], self.seats[at]
            self.workspace.seat(self.seats)

    def pick_up(self) -> None:
        """Take hold of a person: `carry` changes no other seat but that of one more person."""
        self._before = [*self.seats]

    def carry(self, person: str, other: str) -> None:
        """Carry a person to another's present seat; who sat there gets the person's own one."""
        place, before = self.seats.index(other), self._before or self.seats
        self.put_back()
        self.change_seats(person, before[place])

    def changes_with(self, person: str) -> str:
        """Return who gets the seat of a person who is picked up, "" for nobody."""
        other = (self._before or self.seats)[self.seats.index(person)]
        return other if other != person else ""

    def put_back(self) -> None:
        """Seat everybody as before a person was picked up."""
        if self.world is None and self._before is not None:
            self.seats = [*self._before]
            self.workspace.seat(self.seats)

    @property
    def teams_play(self) -> bool:
        """Whether teams take part instead of individuals."""
        return bool(self.workspace.activity.teams)

    def add(self, name: str, *, guest: bool) -> None:
        """Add a person from now on, or a guest for today, as long as the robot is off.

        Everybody else stays at their table. Does nothing if `teams_play`.

        Raises:
            TangyError: there is no free seat, or the name cannot be given.
        """
        if self.world is None and not self.teams_play:
            self._before = None
            person = let_join(self.workspace, name, guest=guest)
            self._sit(person, self.workspace.room.next_place(len(self.seats)))

    def join(self, joins: Joins) -> StaffNote | None:
        """Add a person, perhaps on a seat or at a table; return why they cannot join.

        Raises:
            TangyError: there is no such seat, or the name cannot be given.
        """
        workspace, count = self.workspace, len(self.seats) + 1
        if (refused := known_refusal(workspace, joins)) is not None:
            return refused
        tables = max(1, len(workspace.room.tables))
        if joins.seat > count or joins.table > tables:
            last = (SEAT, count) if joins.seat else ("table", tables)
            wanted = joins.seat or joins.table
            raise TangyError(f"There is no {last[0]} {wanted}: the last one is {last[1]}.")
        self.add(joins.name.strip(), guest=joins.guest)
        place = joins.seat - 1
        if joins.table:
            place = workspace.room.at_tables(count)[joins.table - 1][-1]
        if place >= 0 and len(self.seats) == count:
            self._sit(self.seats.pop(workspace.room.next_place(count - 1)), place)
            self._moved = True
        return None

    def _sit(self, person: str, place: int) -> None:
        """Seat a person who has no seat at a place, from 0; those behind move up."""
        self.seats.insert(place, person)
        self.workspace.seat(self.seats)

    def take_duty(self, name: str) -> None:
        """Set who is on duty, and keep it for the next session.

        Raises:
            TangyError: it is no valid name.
        """
        self.on_duty = take_duty(self.workspace.store.folder, name)

    def rename(self, person: str, name: str) -> None:
        """Change a person's name.

        Raises:
            TangyError: it cannot be given.
        """
        self.workspace.rename(self.workspace.find_person(person), name)

    def activities(self) -> dict[str, str]:
        """Return the titles of the activities to choose from, the present one first."""
        there = choosable(self.workspace.profile, self.workspace.activity)
        return {name: activity.title for name, activity in there}

    def play(self, activity: str) -> None:
        """Change to another activity, as long as the robot is off; `dropped` tells what it drops.

        Raises:
            TangyError: it cannot be played, as nobody has taught it.
        """
        from tangy_tui.learning.policies import need_policy

        workspace = self.workspace
        if self.world is not None or activity == workspace.profile:
            return
        need_policy(workspace.store, load_activity(activity))
        before = self.seats
        workspace.change_activity(activity)
        self._order = [*before, *(one for one in self._order if one not in before)]
        self._seat_as_before()
        away, there = self.away | self._away, set(self.seats)
        self.away, self._away = away & there, away - there
        self.dropped = ["seats"] if self._moved and not there & set(self._order) else []
        self._keep_rules()

    def _keep_rules(self) -> None:
        """Keep the chosen patterns and strength if the activity has them."""
        rules, patterns = self.workspace.activity.rules, self.patterns
        there = [one.name for one in rules.patterns]
        self.patterns = [name for name in patterns if name in there]
        if self.patterns != patterns:
            self.dropped.append("patterns")
        if self.strength not in ("", *(one.name for one in rules.strengths)):
            self.strength = ""
            self.dropped.append("strength")

    def _seat_as_before(self) -> None:
        """Seat people as chosen here, or as in the last game with people or on the bench."""
        place = {person: number for number, person in enumerate(self._order)}
        there = [person.id for person in self.workspace.people]
        usual = seated_as_before(self.workspace.store, there)
        self.seats = sorted(usual, key=lambda person: place.get(person, len(place)))
        if self.seats != there:
            self.workspace.seat(self.seats)

    def rooms(self) -> list[KnownRoom]:
        """Return the rooms to choose from, the present one first."""
        return list(known_rooms(self.workspace.store.folder, self.workspace.room))

    def choose_room(self, wanted: str) -> None:
        """Change to another room, as long as the robot is off.

        Raises:
            TangyError: the room does not exist, its file has a mistake, or not everybody fits in.
        """
        if self.world is None:
            room = find_room(self.workspace.store.folder, wanted)
            self.workspace.choose_room(room)
            self.workspace.seat(self.seats)
            choose_room(self.workspace.store.folder, room)

    def choose_strength(self, name: str) -> None:
        """Choose how strongly Tangy may speak to people, by name.

        Raises:
            TangyError: there is no such strength.
        """
        names = [one.name for one in self.workspace.activity.rules.strengths]
        if not names:
            raise TangyError("In this activity you cannot choose how strongly Tangy speaks.")
        if name.casefold() not in names:
            raise TangyError(plain(f"There is no {name!r}: {nearest(name.casefold(), names)}"))
        self.strength = name.casefold()

    def toggle_pattern(self, name: str) -> None:
        """Append a pattern to those to play for, or remove it."""
        if name in self.patterns:
            self.patterns.remove(name)
        else:
            self.patterns.append(name)

    def turn_pace(self, by: int) -> None:
        """Choose a shorter (-1) or a longer (1) pace."""
        self.pace = next_pace(self.pace, by)

    def turn_minutes(self, by: int) -> None:
        """Plan a shorter (-1) or a longer (1) session."""
        self.minutes = _turned(MINUTES, self.minutes, by)

    def turn_strength(self, by: int) -> None:
        """Choose a weaker (-1) or a stronger (1) way of speaking."""
        names = ("", *(one.name for one in self.workspace.activity.rules.strengths))
        self.strength = _turned(names, self.strength, by)

    @property
    def plan(self) -> GamePlan:
        """The plan of the games."""
        return GamePlan(
            tuple(self.patterns),
            self.several,
            self.visits,
            self.strength,
            tuple(sorted(self.away)),
            self.pace,
            self.minutes,
        )

    def carry_out(self, world: LiveWorld) -> None:
        """Apply the plan to the next games of a world.

        Raises:
            TangyError: a pattern does not exist.
        """
        world.choose(self.plan)

    def comes_with(self, card: int, person: str) -> None:
        """Mark a person as present, with a card."""
        self.away.discard(person)
        if self.world is not None:
            self.world.cards.dealt.give(person, card)

    def look_at_face(self) -> str:
        """Recognise the person before the robot as present; return the id, "" for nobody."""
        assert self.world is not None  # noqa: S101 - offered only with a robot
        try:
            seen = self.world.commands.do("face").get("person")
        except DeviceError:
            return ""
        self.face = str(seen) if seen in self.seats else ""
        self.away.discard(self.face)
        return self.face


def _turned(values: tuple[T, ...], now: T, by: int) -> T:
    """Return the value `by` places further, clipped to the ends; an unknown value is the first."""
    at = values.index(now) if now in values else 0
    return values[min(len(values) - 1, max(0, at + by))]
