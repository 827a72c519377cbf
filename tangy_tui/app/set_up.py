"""What staff choose and check before a live game: who is here, who sits where, how it is played.

The page and the lines drive the same object. The robot may be off until `begin`: then only what
needs none is known. Looking at a card and speaking are done when staff ask for it; nothing drives.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypeVar

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.game_rules import USUAL_PACE, GamePlan, next_pace
from tangy_profiles.game_world import BENCH, LIVE
from tangy_profiles.health import OK
from tangy_profiles.known_devices import reads_cards
from tangy_profiles.reading import nearest, plain
from tangy_tui.app.chosen_activity import choosable
from tangy_tui.app.joining import let_join
from tangy_tui.app.rooms import KnownRoom, choose_room, find_room, known_rooms

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.world import World

T = TypeVar("T")

CheckName = Literal["robot", "battery", "tablet", "cards", "faces", "sound"]
CHECKS: tuple[CheckName, ...] = ("robot", "battery", "tablet", "cards", "faces", "sound")
CheckState = Literal["off", "ready", "not ready", "not checked", "not told"]
"""Of a check: the robot is off, all is well or not, nobody has looked yet, or no device tells."""

MINUTES = (0, 15, 20, 30, 40, 60, 90)
"""How long a session may be planned to take; 0: it is left open."""
APART = ("localisation", "screen")
"""Devices that do not count as the robot's: it finds its place later, the tablet is told apart."""
LEAST_BATTERY = 0.2
"""The share of its charge below which a robot should be charged first."""


@dataclass(frozen=True, slots=True)
class Check:
    """One readiness check; `about` names the problem, or the result."""

    name: CheckName
    state: CheckState
    about: str = ""


@dataclass
class SetUp:
    """The choices for the games of a session. Change them by its methods; `plan` is what comes."""

    workspace: Workspace
    seats: list[str] = field(default_factory=list)
    """The ids of those who take part, in the order of their seats."""
    away: set[str] = field(default_factory=set)
    patterns: list[str] = field(default_factory=list)
    several: bool = False
    visits: bool = False
    strength: str = ""
    pace: float = USUAL_PACE
    minutes: int = 0
    world: LiveWorld | None = None
    """The robot, once it is on."""
    card: str = ""
    """What was seen of a card that was held before the robot."""
    face: str = ""
    """Who was seen last that stood before the robot, by id."""
    said: bool = False
    heard: bool = False

    @classmethod
    def of(cls, workspace: Workspace, pace: float = USUAL_PACE) -> SetUp:
        """Begin with everybody here, as they sat last; `pace` is in s from call to call."""
        return cls(workspace, seats_as_before(workspace), pace=pace)

    # ----------------------------------------------------------------------------- the choices

    def toggle(self, person: str) -> None:
        """Take a person for being here, or for not being here."""
        self.away ^= {person}

    @property
    def tables(self) -> tuple[tuple[str, ...], ...]:
        """Who sits at each table, as the tables stand in the room."""
        at_tables = self.workspace.room.at_tables(len(self.seats))
        return tuple(tuple(self.seats[place] for place in sitting) for sitting in at_tables)

    def move(self, person: str, by: int) -> None:
        """Let a person change seats with another so many on, as long as the robot is off."""
        at = self.seats.index(person)
        self.change_seats(person, self.seats[min(len(self.seats) - 1, max(0, at + by))])

    def change_seats(self, person: str, other: str) -> None:
        """Let two people change seats, as long as the robot is off."""
        at, to = self.seats.index(person), self.seats.index(other)
        if self.world is None and to != at:
            self.seats[at], self.seats[to] = self.seats[to], self.seats[at]
            self.workspace.seat(self.seats)

    @property
    def calls(self) -> bool:
        """Whether numbers are called, at a pace."""
        return bool(self.workspace.activity.deck.columns)

    @property
    def on_bench(self) -> bool:
        """Whether the robot and the people are simulated."""
        return self.world is not None and self.world.played_in == BENCH

    @property
    def teams_play(self) -> bool:
        """Whether teams take part, and not people one by one."""
        return bool(self.workspace.activity.teams)

    def add(self, name: str, *, guest: bool) -> None:
        """Let a person take part from now on, or as a guest today, as long as the robot is off.

        Not while `teams_play`.

        Raises:
            TangyError: there is no room for more, or the name cannot be given.
        """
        if self.world is None and not self.teams_play:
            self.seats.append(let_join(self.workspace, name, guest=guest))

    def rename(self, person: str, name: str) -> None:
        """Give a person another name.

        Raises:
            TangyError: it cannot be given.
        """
        self.workspace.rename(self.workspace.find_person(person), name)

    def activities(self) -> dict[str, str]:
        """Return the titles of the activities that can be chosen, the present one first."""
        there = choosable(self.workspace.profile, self.workspace.activity)
        return {name: activity.title for name, activity in there}

    def play(self, activity: str) -> None:
        """Play another activity, as long as the robot is off.

        Raises:
            TangyError: it cannot be played, as nobody has taught it.
        """
        from tangy_tui.learning.policies import need_policy

        workspace, before = self.workspace, self.workspace.profile
        if self.world is not None or activity == before:
            return
        workspace.change_activity(activity)
        try:
            need_policy(workspace.store, workspace.activity)
        except TangyError:
            workspace.change_activity(before)
            raise
        self.patterns, self.strength = [], ""
        self.seats = seats_as_before(workspace)
        self.away &= set(self.seats)

    def rooms(self) -> list[KnownRoom]:
        """Return the rooms that can be chosen, the present one first."""
        return list(known_rooms(self.workspace.store.folder, self.workspace.room))

    def choose_room(self, wanted: str) -> None:
        """Play in another room from now on, as long as the robot is off.

        Raises:
            TangyError: there is no such room, its file has a mistake, or not everybody fits in.
        """
        if self.world is None:
            room = find_room(self.workspace.store.folder, wanted)
            self.workspace.choose_room(room)
            self.workspace.seat(self.seats)
            choose_room(self.workspace.store.folder, room)

    def choose_strength(self, name: str) -> None:
        """Choose how strongly people may be spoken to, by name.

        Raises:
            TangyError: there is no such strength.
        """
        names = [one.name for one in self.workspace.activity.rules.strengths]
        if name.casefold() not in names:
            raise TangyError(plain(f"There is no {name!r}: {nearest(name.casefold(), names)}"))
        self.strength = name.casefold()

    def toggle_pattern(self, name: str) -> None:
        """Play for a pattern after those that were chosen, or not any more."""
        if name in self.patterns:
            self.patterns.remove(name)
        else:
            self.patterns.append(name)

    def turn_pace(self, by: int) -> None:
        """Choose a shorter (-1) or a longer (1) pace."""
        self.pace = next_pace(self.pace, by)

    def turn_minutes(self, by: int) -> None:
        """Plan less or more time."""
        self.minutes = _turned(MINUTES, self.minutes, by)

    def turn_strength(self, by: int) -> None:
        """Choose how strongly people may be spoken to."""
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
        """Play the next games of a world as was chosen.

        Raises:
            TangyError: a pattern is not known.
        """
        world.choose(self.plan)

    # ------------------------------------------------------------------------------ the checks

    def checks(self) -> list[Check]:
        """Return how everything is that has to be ready, in the order in which it is looked at."""
        if self.world is None:
            return [Check(name, "off") for name in CHECKS]
        return [
            self._robot(),
            self._battery(),
            self._tablet(),
            self._cards(),
            self._faces(),
            self._sound(),
        ]

    @property
    def not_ready(self) -> list[Check]:
        """The failed checks."""
        return [check for check in self.checks() if check.state == "not ready"]

    def _robot(self) -> Check:
        assert self.world is not None  # noqa: S101 - `checks` asks with a world alone
        if self.world.link.silent:
            return Check("robot", "not ready", self.world.link.silent)
        ill = [r.device for r in self.world.health() if r.state != OK and r.device not in APART]
        return Check("robot", "not ready" if ill else "ready", ", ".join(ill))

    def _battery(self) -> Check:
        share = battery_of(self.world)
        if share is None:
            return Check("battery", "not told")
        return Check("battery", "ready" if share >= LEAST_BATTERY else "not ready", f"{share:.0%}")

    def _tablet(self) -> Check:
        assert self.world is not None  # noqa: S101 - as above
        link = self.world.link
        if not link.tablet_page:
            return Check("tablet", "not told")
        page = f"{link.screen} code {link.code}"
        shown = any(r.device == "screen" and r.state == OK for r in self.world.health())
        return Check("tablet", "ready" if shown else "not ready", page)

    def _cards(self) -> Check:
        if not reads_cards(self.workspace.robot):
            return Check("cards", "not told")
        return Check("cards", "ready" if self.card else "not checked", self.card)

    def _faces(self) -> Check:
        if self.world is None or not self.world.knows_faces:
            return Check("faces", "not told")
        seen = self.workspace.name(self.face) if self.face else ""
        return Check("faces", "ready" if seen else "not checked", seen)

    def _sound(self) -> Check:
        if "voice" not in self.workspace.robot.devices:
            return Check("sound", "not told")
        state: CheckState = "ready" if self.heard else "not ready" if self.said else "not checked"
        return Check("sound", state)

    def look_at_card(self) -> str:
        """Look at a card that is held before the robot; return its number, "" if none is read."""
        assert self.world is not None  # noqa: S101 - offered with a robot alone
        try:
            seen = self.world.commands.do("card", called=[], after=0.0, identify=True)
        except DeviceError:
            return ""
        self.card = "" if seen["card"] is None else str(seen["card"])
        return self.card

    def holder(self, card: int) -> str:
        """Return who is known to have a card, "" for nobody."""
        return "" if self.world is None else self.world.cards.dealt.owner(card)

    def comes_with(self, card: int, person: str) -> None:
        """Take a person for being here, with a card."""
        self.away.discard(person)
        if self.world is not None:
            self.world.cards.dealt.give(person, card)

    def look_at_face(self) -> str:
        """Look who stands before the robot, who is here then; return the id, "" for nobody."""
        assert self.world is not None  # noqa: S101 - as above
        try:
            seen = self.world.commands.do("face").get("person")
        except DeviceError:
            return ""
        self.face = str(seen) if seen in self.seats else ""
        self.away.discard(self.face)
        return self.face

    def speak(self, words: str) -> bool:
        """Say something that staff are to hear; return whether it could be said."""
        assert self.world is not None  # noqa: S101 - as above
        from tangy_hw.device_protocols import Picture

        try:
            self.world.say(words, Picture(words))
        except DeviceError:
            return False
        self.said = True
        return True


def seats_as_before(workspace: Workspace) -> list[str]:
    """Let people sit as in the last game among people, or on the bench; return their ids.

    People who were not in it sit behind the others.
    """
    there = [person.id for person in workspace.people]
    games = [event.record for event in workspace.store.events(GameBeginning)]
    last = next((game.people for game in reversed(games) if game.world in (BENCH, LIVE)), ())
    before = {person: place for place, person in enumerate(last)}
    seats = sorted(there, key=lambda person: before.get(person, len(before)))
    if seats != there:
        workspace.seat(seats)
    return seats


def battery_of(world: World | None) -> float | None:
    """Return the share of its charge that a robot has, None where no device tells."""
    if world is None:
        return None
    for reading in world.health():
        for name in ("battery", "charge"):
            if isinstance(value := reading.facts.get(name), int | float):
                return float(value) / (100.0 if value > 1 else 1.0)
    return None


def _turned(values: tuple[T, ...], now: T, by: int) -> T:
    """Return the value so many places on, within the ends; an odd one goes to the first."""
    at = values.index(now) if now in values else 0
    return values[min(len(values) - 1, max(0, at + by))]
