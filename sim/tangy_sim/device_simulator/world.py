"""The bench's room: time passes, and the robot and the people interact.

`step` advances the time; commands come in between. Devices read its parts: `wheels`, `joints`,
`ranges`, `head_scene` and `asking`; this module knows no protocols.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import hypot, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.person import Person
from tangy_profiles.robot import Robot
from tangy_profiles.room import SEAT, Room
from tangy_profiles.state import FRONT
from tangy_profiles.wav_length import wav_seconds
from tangy_sim.device_simulator.declared_people import DeclaredPeople
from tangy_sim.device_simulator.declared_reception import DeclaredReception
from tangy_sim.device_simulator.drive import RADIUS, Odometer, SimulatedWheels, moved
from tangy_sim.device_simulator.faults import COMES_BACK, Faults
from tangy_sim.device_simulator.floor import Floor, FloorPose
from tangy_sim.device_simulator.joints import Joints
from tangy_sim.device_simulator.lidar import Lidar
from tangy_sim.device_simulator.people import People
from tangy_sim.device_simulator.speech_reception import SpeechReception, speaking_seconds
from tangy_sim.worlds.injection import KINDS, silencing
from tangy_sim.worlds.users import UserModel

if TYPE_CHECKING:
    from numpy.typing import NDArray

PHYSICS = 0.05  # s, step of everything but the wheels, which use smaller ones
ARRIVES, LEAVES = 0.4, 0.7  # m from the standing point of a place: arrival, departure
STANDS = 0.1  # m/s below which a passing robot may have arrived
AHEAD = 1.3  # m before a driving robot at which a chair is put
STRAIGHT = 0.1  # rad/s up to which it drives straight
NOD = "head/neck nod"
LOOKS_DOWN = -10.0  # degrees of the neck for looking at cards
FACES_IT = 25.0  # degrees off the direction of the table
GRIP = 0.08  # ratio of the robot's movement to the wheels' on a sliding rug
TURNED = 1.3  # rad by which a person who pushes the robot turns it at most
HELD = {"emergency-stop", "base-failed"}  # faults that cut the power of the wheels


class HeadScene(NamedTuple):
    """Scene before the head camera, with everything that its image depends on.

    `kind` is "card" or "face" (of a `person`), "room" (`heading` in degrees), "dark" or "frozen".
    For a card: the game, how often it was moved, its number, its marks, and how it is hidden.
    """

    kind: str
    person: str = ""
    game: int = 0
    moved: int = 0
    card: int = 0
    marked: int = 0
    hides: str = ""
    heading: int = 0


class BenchWorld:
    """A room with a robot and people, with its own clock; deterministic for a seed."""

    def __init__(
        self,
        room: Room,
        robot: Robot,
        activity: Activity,
        people: Sequence[Person],
        *,
        seed: int,
        users: UserModel | None = None,
        odometer: Odometer | None = None,
    ) -> None:
        self.room, self.robot, self.activity = room, robot, activity
        self.now = 0.0
        self.games = 0
        self._physics = np.random.default_rng([seed, 1])
        self.floor = Floor(room, len(people), np.random.default_rng([seed, 2]))
        start = FloorPose(room.front.x, room.front.y, pi / 2)
        self.wheels = SimulatedWheels(self.floor, start, self._physics, odometer or Odometer())
        self.lidar = Lidar()
        self.joints = Joints(robot)
        self.faults = Faults()
        self.people: People
        self._hearing: SpeechReception | DeclaredReception
        if isinstance(activity, DeclaredActivity):
            self.people = DeclaredPeople(activity, people, self.faults, seed=seed)
            self._hearing = DeclaredReception(activity, people, room.seat_word or SEAT)
        else:
            self.people = People(activity, people, self.faults, seed=seed, users=users)
            self._hearing = SpeechReception(activity, robot, people, room.seat_word or SEAT)
        self._speech: deque[tuple[str, float]] = deque()
        self._silent_from = 0.0  # end of the current speech
        self.said: list[str] = []
        """Texts spoken to their end since the last look; the reader empties the list."""
        self._stands = {
            place: room.stand(place, self.people.ids) for place in (FRONT, *self.people.ids)
        }

    # --------------------------------------------------------------------- time, and commands

    def begin(self) -> dict[str, int]:
        """Begin a game with new cards and no faults; return the card of each person."""
        self.faults.clear()
        self._see_to_lifted()
        self.games += 1
        self._speech.clear()
        self.people.begin(self.now)
        self.people.place = self.nearest() or ""
        cards = {person: sitter.card for person, sitter in self.people.sitters.items()}
        return {person: card for person, card in cards.items() if card}

    def step(self, seconds: float) -> None:
        """Advance the time by `seconds` s."""
        left = seconds
        while left > 1e-9:
            part = min(left, PHYSICS)
            left -= part
            self._step(part)

    def _step(self, seconds: float) -> None:
        faults, wheels = self.faults, self.wheels
        self.now += seconds
        self.floor.step(seconds)
        if not faults.present.keys().isdisjoint(HELD):
            wheels.halt()
        stuck = "base-stuck" in faults
        wheels.step(self.now, seconds, stuck=stuck, grip=GRIP if "wheels-slip" in faults else 1.0)
        self.joints.step(seconds, ("left_arm",) if "arm-failed" in faults else ())
        self._place_chair()
        self._follow()
        self._speak()
        self.people.step(self.now)
        self._see_to_lifted()

    def drive(self, forward: float, turn: float) -> None:
        """Set the command of the wheels: m/s and rad/s."""
        self.wheels.drive(forward, turn, self.now)

    def say(self, text: str) -> None:
        """Queue a text to speak."""
        self._utter(text, speaking_seconds(text))

    def play(self, sound: str) -> None:
        """Queue a WAV file to play."""
        self._utter(sound, wav_seconds(Path(sound)))

    def _utter(self, text: str, seconds: float) -> None:
        if "voice-dead" in self.faults:
            return
        if not self._speech:
            self._silent_from = self.now + seconds
        self._speech.append((text, seconds))

    def read(self, text: str) -> None:
        """Let people read the screen, which replaces a dead voice."""
        if "voice-dead" in self.faults:
            self._understood(text)

    def hush(self) -> None:
        """Cut the current speech; people do not understand half a sentence."""
        self._speech.clear()

    def _speak(self) -> None:
        while self._speech and self.now >= self._silent_from:
            text, _ = self._speech.popleft()
            if "voice-dead" in self.faults:
                continue
            self.said.append(text)
            self._understood(text)
            if self._speech:
                self._silent_from = self.now + self._speech[0][1]

    def _understood(self, text: str) -> None:
        heard = self._hearing.hear(text)
        if heard is not None:
            self.people.hear(heard)

    # ------------------------------------------------------------------------ where it is

    def nearest(self) -> str:
        """Return the place at which the robot stands; "" if it is at none."""
        pose = self.wheels.pose
        for place, point in self._stands.items():
            if hypot(point.x - pose.x, point.y - pose.y) <= ARRIVES:
                return place
        return ""

    def _follow(self) -> None:
        """Let people notice where the robot is."""
        people, pose = self.people, self.wheels.pose
        if people.place:
            point = self._stands[people.place]
            if hypot(point.x - pose.x, point.y - pose.y) > LEAVES:
                people.leave()
        if abs(self.wheels.forward) < STANDS and not people.place:
            place = self.nearest()
            if place:
                people.meet(place)
                self._is_over()

    def _is_over(self) -> None:
        """End faults that end when the robot has reached a place."""
        for kind in ("path-detour", "carried-off"):
            fault = self.faults.present.get(kind)
            if fault is not None and fault.shown:
                self.faults.lift(kind)

    # --------------------------------------------------------------------------- sensor views

    def ranges(self) -> NDArray[np.float64]:
        """Return the current ranges of the laser, (beams,) in m."""
        measure = self.lidar.covered if "laser-occluded" in self.faults else self.lidar.scan
        return measure(self.wheels.pose, self.floor, self._physics)

    def head_scene(self) -> HeadScene:
        """Return the current scene before the head camera."""
        if "camera-occluded" in self.faults:
            return HeadScene("dark")
        if "camera-frozen" in self.faults:
            return HeadScene("frozen")
        pose, place = self.wheels.pose, self.nearest()
        sitter = self.people.sitters.get(place)
        off = abs((pose.heading - pi / 2 + pi) % (2 * pi) - pi)
        if sitter is None or off > FACES_IT * pi / 180:
            return HeadScene("room", heading=5 * round(pose.heading * 36 / pi))
        if self.joints.angle(NOD) > LOOKS_DOWN:
            return HeadScene("face", sitter.id)
        if not sitter.card:
            return HeadScene("room", heading=5 * round(pose.heading * 36 / pi))
        return HeadScene(
            "card",
            sitter.id,
            self.games,
            sitter.moved,
            sitter.card,
            sitter.player.marked,
            sitter.hides,
        )

    @property
    def asking(self) -> tuple[str, ...]:
        """People whose signs are up, the longest waiting first."""
        return self.people.asking

    # --------------------------------------------------------------------- what goes wrong

    def inject(self, kind: str) -> None:
        """Start a fault: at once if possible, otherwise at the next opportunity.

        Raises:
            KeyError: there is no such kind.
        """
        if kind in self.faults:
            return
        fault = self.faults.inject(kind, self.now)
        place = self.people.place
        match kind:
            case "path-blocked":
                self.floor.block(self.wheels.pose)
            case "carried-off":
                self._carry_off()
                fault.shown = True
            case "card-out-of-sight" if place in self.asking:
                fault.person = place
                self.people.hide(place)

    def lift(self, kind: str) -> bool:
        """End a fault; return whether it was active."""
        found = self.faults.lift(kind)
        self._see_to_lifted()
        return found

    def mend(self, code: str) -> list[str]:
        """Let an expert repair the diagnosed faults, and what silences their device.

        Returns:
            The repaired kinds.
        """
        found = list(dict.fromkeys([*self.faults.of(code), *silencing(code, self.faults.present)]))
        for kind in found:
            self.lift(kind)
        return found

    def restart(self, device: str) -> bool:
        """Restart a device, which may help; return whether it works now."""
        kind = f"{device}-dead"
        if kind in self.faults and self._physics.random() < COMES_BACK:
            self.lift(kind)
        return kind not in self.faults

    def _see_to_lifted(self) -> None:
        lifted, self.faults.lifted = self.faults.lifted, []
        for fault in lifted:
            self.people.lifted(fault.kind.name, fault.person)
            if fault.kind.name in ("path-blocked", "path-detour"):
                self.floor.tidy()

    def _place_chair(self) -> None:
        """Put a chair before the robot as soon as it drives straight and there is room."""
        fault = self.faults.present.get("path-detour")
        if fault is None or fault.shown or self.wheels.forward < 0.2:
            return
        if abs(self.wheels.turn) > STRAIGHT:  # in a bend, the path is not straight ahead
            return
        fault.shown = self.floor.drop_ahead(self.wheels.pose, AHEAD)

    def _carry_off(self) -> None:
        """Move the robot somewhere else and turn it, without turning its wheels."""
        pose, room, random = self.wheels.pose, self.room, self._physics
        for _ in range(200):
            x, y = random.uniform(0, room.width), random.uniform(0, room.depth)
            far = hypot(x - pose.x, y - pose.y) > 2.0 and y < room.table[1]
            at_none = all(hypot(p.x - x, p.y - y) > LEAVES for p in self._stands.values())
            if far and at_none and self.floor.clear(x, y, RADIUS + 0.2):
                heading = pose.heading + float(random.uniform(-TURNED, TURNED))
                self.wheels.pose = moved(FloorPose(float(x), float(y), heading), 0.0, 0.0)
                break

    # ------------------------------------------------------------------------------ truth

    def truth(self) -> dict[str, Any]:
        """Return the ground truth as JSON."""
        people, pose = self.people, self.wheels.pose
        return {
            "time": round(self.now, 3),
            "game": self.games,
            "pose": [round(value, 4) for value in pose],
            "place": self.nearest(),
            "commanded": list(self.wheels.commanded),
            "moving": bool(self.wheels.forward or self.wheels.turn),
            "bumped": self.wheels.bumped,
            "asking": list(self.asking),
            "called": list(people.game.called),
            "opened": people.game.opened,
            "over": people.game.over,
            "spoken": list(people.game.spoken),
            "faults": [
                {"kind": name, "code": KINDS[name].code, "since": fault.since,
                 "person": fault.person, "shown": fault.shown}
                for name, fault in self.faults.present.items()
            ],
            "responses": [list(response) for response in people.game.responses],
            "acts": [list(act) for act in people.game.acts],
            "people": {
                person: {
                    "card": sitter.card,
                    "marked": sitter.player.marked,
                    "called": sitter.player.called,
                    "hides": sitter.hides,
                    "asks": sitter.asks_since is not None,
                    "state": people.judged(person),
                }
                for person, sitter in people.sitters.items()
            },
        }  # fmt: skip
