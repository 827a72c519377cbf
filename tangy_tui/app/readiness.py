"""Whether the robot is ready for a game, and what staff let it try before.

The robot may be off until the game begins; until then most checks are unknown. It reads a card,
looks for a face and speaks only if staff ask, and never drives.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, Literal

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.game_world import BENCH
from tangy_profiles.health import OK
from tangy_profiles.known_devices import reads_cards

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.world import World

CheckName = Literal["robot", "battery", "tablet", "cards", "faces", "sound"]
CHECKS: tuple[CheckName, ...] = ("robot", "battery", "tablet", "cards", "faces", "sound")
CheckState = Literal["off", "ready", "not ready", "not checked", "not told"]
"""Of a check: the robot is off, passed, failed, not checked yet, or no device reports it."""

APART = ("localisation", "screen")
"""Devices left out of the robot check: it localises later, and the tablet has its own check."""
LEAST_BATTERY = 0.2
"""The fraction of its charge below which a robot should be charged first."""


SETTLES_SECONDS = 4.0
"""Time for newly started devices to become ready, in s."""
LOOK_SECONDS = 0.5
"""The interval between two checks."""


@dataclass(frozen=True, slots=True)
class Check:
    """A readiness check; `about` names the problem, or the result."""

    name: CheckName
    state: CheckState
    about: str = ""


@dataclass
class Readiness:
    """The checks before a game, and their results so far."""

    workspace: Workspace
    world: LiveWorld | None = None
    """The robot, once it is on."""
    card: str = ""
    """The number of the last card that the robot read."""
    face: str = ""
    """The id of the last person that the robot recognised."""
    said: bool = False
    heard: bool = False

    @property
    def calls(self) -> bool:
        """Whether numbers are called, at a pace."""
        return bool(self.workspace.activity.deck.columns)

    @property
    def on_bench(self) -> bool:
        """Whether the robot and the people are simulated."""
        return self.world is not None and self.world.played_in == BENCH

    def checks(self) -> list[Check]:
        """Return the checks in the order of `CHECKS`; that of cards only if there are any."""
        names = [name for name in CHECKS if name != "cards" or self.calls]
        if self.world is None:
            return [Check(name, "off") for name in names]
        return [self._check(name) for name in names]

    def check(self, name: CheckName) -> Check:
        """Return one check."""
        return Check(name, "off") if self.world is None else self._check(name)

    @property
    def not_ready(self) -> list[Check]:
        """The failed checks."""
        return [check for check in self.checks() if check.state == "not ready"]

    def _check(self, name: CheckName) -> Check:
        match name:
            case "robot":
                return self._robot()
            case "battery":
                return self._battery()
            case "tablet":
                return self._tablet()
            case "cards":
                return self._cards()
            case "faces":
                return self._faces()
            case "sound":
                return self._sound()

    def _robot(self) -> Check:
        assert self.world is not None  # noqa: S101 - `checks` asks only with a world
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
        """Read a card held before the robot; return its number, "" if none was read."""
        assert self.world is not None  # noqa: S101 - offered only with a robot
        try:
            seen = self.world.commands.do("card", called=[], after=0.0, identify=True)
        except DeviceError:
            return ""
        self.card = "" if seen["card"] is None else str(seen["card"])
        return self.card

    def holder(self, card: int) -> str:
        """Return the id of the known owner of a card, "" if there is none."""
        return "" if self.world is None else self.world.cards.dealt.owner(card)

    def speak(self, words: str) -> bool:
        """Say something for staff to hear; return whether that worked."""
        assert self.world is not None  # noqa: S101 - as above
        from tangy_hw.device_protocols import Picture

        try:
            self.world.say(words, Picture(words))
        except DeviceError:
            return False
        self.said = True
        return True

    def settling(self) -> Iterator[float]:
        """Yield how long to wait before each further check of newly started devices, in s.

        It ends as soon as they are ready, and after some seconds.
        """
        until = monotonic() + SETTLES_SECONDS
        while self.not_ready and monotonic() < until:
            yield LOOK_SECONDS


def battery_of(world: World | None) -> float | None:
    """Return the fraction of a robot's charge, 0 to 1; None if no device reports it."""
    if world is None:
        return None
    for reading in world.health():
        for name in ("battery", "charge"):
            if isinstance(value := reading.facts.get(name), int | float):
                return float(value) / (100.0 if value > 1 else 1.0)
    return None
