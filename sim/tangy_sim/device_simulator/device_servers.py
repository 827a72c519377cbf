"""Servers of the bench's devices: rosbridge, a network laser scanner, and two video streams.

On a stepped bench, the service `/bench/advance` {"seconds": dt} advances the time: `/clock` is
published, then all due messages are sent on all connections, then the answer {"time": t, "sent":
{...}}, with the numbers of scans and frames sent so far. The service and the clock also work while
the robot's link is lost. Otherwise the bench runs in real time, and the link can be a bad one
(`LinkQuality`).
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

from tangy_sim.device_simulator import messages
from tangy_sim.device_simulator.camera_streams import CameraStreams
from tangy_sim.device_simulator.house_rules import tell
from tangy_sim.device_simulator.lidar import Lidar
from tangy_sim.device_simulator.world import BenchWorld
from tangy_sim.servers.link_relay import LinkQuality, LinkRelays
from tangy_sim.servers.rosbridge_server import RosbridgeServer
from tangy_sim.servers.scip_server import ScipServer
from tangy_sim.servers.scip_session import Scanner
from tangy_sim.worlds.injection import KINDS

SCANNER = Scanner("UTM-30LX", 0.02, 30.0, 480, 360, 180, 10.0, 1)
"""360 beams over 270 degrees at 10 Hz; its short minimum range lets it see a cloth."""

TICK = 0.05  # s of bench time between two odometry messages
LONGEST = 60.0  # s that one step may request
BEHIND = 0.5  # s of delay on a busy machine that are caught up; more is dropped
EVERY = {"laser": 0.1, "joints": 0.1, "stop": 0.1, "diagnostics": 0.25, "infrared": 0.2}  # s
ALWAYS = ("/bench/advance", "/clock")


class DeviceServers:
    """Serves a world. After `start`, call `run` (real time), or advance it (stepped)."""

    def __init__(
        self,
        world: BenchWorld,
        *,
        stepped: bool,
        faces: Mapping[str, int],
        seed: int = 1,
        link: LinkQuality | None = None,
    ) -> None:
        self.world, self.stepped = world, stepped
        self.faces = dict(faces)
        world.lidar = Lidar(SCANNER.beams, SCANNER.first, SCANNER.step)
        self.ros = RosbridgeServer(clock=lambda: world.now)
        self.scip = ScipServer(SCANNER)
        self.film = CameraStreams(world, faces, seed=seed)
        self._relays = LinkRelays(link or LinkQuality(), seed)
        self._due = dict.fromkeys(EVERY, 0.0)
        self._turn = asyncio.Lock()
        self._lost = False  # whether the link is lost
        self._odometries = 0  # messages that could arrive
        self._commands: dict[str, Callable[[Mapping[str, Any]], dict[str, Any]]] = {
            "begin": lambda _: {"cards": world.begin()},
            "inject": lambda told: self._injected(str(told["kind"])),
            "lift": lambda told: {"lifted": world.lift(str(told["kind"]))},
            "mend": lambda told: {"lifted": world.mend(str(told["fault"]))},
            "restart": lambda told: {"works": world.restart(str(told["device"]))},
            "rules": lambda told: tell(world.people, told),
            "read": lambda told: self._read(str(told["text"])),
            "ask": lambda told: self._asked(str(told["person"])),
            "truth": lambda _: {"truth": world.truth()},
        }

    async def start(self) -> dict[str, Any]:
        """Start all servers; return their addresses, as in the "ready" line."""
        ros = self.ros
        ros.on_message("/cmd_vel", self._driven)
        ros.on_message("/joint_trajectory", self._posed)
        ros.on_message("/voice/say", lambda told: self.world.say(str(told["data"])))
        ros.on_message("/voice/play", lambda told: self.world.play(str(told["data"])))
        ros.on_message("/voice/hush", lambda _: self.world.hush())
        if self.stepped:
            ros.provide("/bench/advance", self._advance)
        await ros.start()
        await self.scip.start()
        await self.film.start()
        relayed = self._relays.relayed
        return {
            "rosbridge": await relayed(ros.url),
            "scip": await relayed(self.scip.url),
            "head": await relayed(self.film.url("/head")),
            "infrared": await relayed(self.film.url("/infrared")),
            "corners": [list(corner) for corner in self.film.corners],
            "faces": self.faces,
        }

    async def close(self) -> None:
        """Stop all servers."""
        await self._relays.close()
        await self.film.close()
        await self.scip.close()
        await self.ros.close()

    async def run(self) -> None:
        """Advance the bench in real time, until cancelled."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while True:
            due = max(due + TICK, loop.time() - BEHIND)
            await asyncio.sleep(max(0.0, due - loop.time()))
            self._pass(TICK)

    def do(self, told: Mapping[str, Any]) -> dict[str, Any]:
        """Execute a command of the bench's owner, and return the answer.

        Raises:
            KeyError: an unknown command or kind, or a missing argument.
        """
        done = self._commands[str(told["do"])](told)
        self._heed_faults()
        return {"done": told["do"], **done}

    # ------------------------------------------------------------------------------ time

    async def _advance(self, arguments: Mapping[str, Any]) -> Mapping[str, Any]:
        seconds = float(arguments["seconds"])
        if not 0 < seconds <= LONGEST:
            raise ValueError(f"seconds must be above 0 and at most {LONGEST:g}")
        async with self._turn:
            while seconds > 1e-9:
                part = min(TICK, seconds)
                seconds -= part
                self._pass(part)
        sent = {"laser": self.scip.sent, "base": self._odometries, **self.film.sent}
        return {"time": round(self.world.now, 6), "sent": sent}

    def _pass(self, seconds: float) -> None:
        world, ros = self.world, self.ros
        if self.stepped:
            ros.publish("/clock", "rosgraph_msgs/Clock",
                        {"clock": messages.time(world.now + seconds)})  # fmt: skip
        world.step(seconds)
        now, wheels = world.now, world.wheels
        self._heed_faults()
        if "base-failed" not in world.faults:
            odometry = messages.odometry(now, wheels.odometry, wheels.forward, wheels.turn)
            ros.publish("/odom", "nav_msgs/Odometry", odometry)
            self._odometries += not self._lost
        if self._is_due("laser") and self.scip.measuring:
            self.scip.send(world.ranges(), round(now * 1000))
        if self._is_due("joints"):
            states = messages.joint_states(now, world.joints.positions, world.joints.speeds)
            ros.publish("/joint_states", "sensor_msgs/JointState", states)
        if self._is_due("stop") and "stop-button-silent" not in world.faults:
            pressed = "emergency-stop" in world.faults
            ros.publish("/stop_button", "std_msgs/Bool", {"data": pressed})
        if self._is_due("diagnostics"):
            said = messages.diagnostics(now, self._diagnosed())
            ros.publish("/diagnostics", "diagnostic_msgs/DiagnosticArray", said)
        if self.stepped and self._is_due("infrared"):
            self.film.show_signs()
        said_now, world.said = world.said, []
        for text in said_now:
            ros.publish("/voice/said", "std_msgs/String", {"data": text})

    def _is_due(self, what: str) -> bool:
        if self.world.now < self._due[what] - 1e-9:
            return False
        self._due[what] = self.world.now + EVERY[what]
        return True

    # --------------------------------------------------------------------------- commands

    def _driven(self, told: Mapping[str, Any]) -> None:
        twist = told.get("twist", told)
        self.world.drive(float(twist["linear"]["x"]), float(twist["angular"]["z"]))

    def _posed(self, told: Mapping[str, Any]) -> None:
        """Execute a trajectory; an empty one means hold, as in joint_trajectory_controller."""
        if told["points"]:
            self.world.joints.move(*messages.trajectory(told))
        else:
            self.world.joints.hold([str(name) for name in told["joint_names"]])

    def _asked(self, person: str) -> dict[str, Any]:
        self.world.people.ask(person)
        return {"asking": list(self.world.asking)}

    def _read(self, text: str) -> dict[str, Any]:
        self.world.read(text)
        return {"text": text}

    def _injected(self, kind: str) -> dict[str, Any]:
        self.world.inject(kind)
        return {"kind": kind, "code": KINDS[kind].code}

    # ------------------------------------------------------------------------------ faults

    def _diagnosed(self) -> dict[str, tuple[int, str]]:
        faults = self.world.faults
        broken = {
            "arms": ("arm-failed", "overload in the left elbow"),
            "voice": ("voice-dead", "the voice has ended"),
        }
        return {
            device: (messages.ERROR, says) if kind in faults else (messages.OK, "")
            for device, (kind, says) in broken.items()
        } | {"base": (messages.OK, ""), "stop_button": (messages.OK, "")}

    def _heed_faults(self) -> None:
        """Silence the servers affected by faults, and resume the others."""
        faults = self.world.faults
        lost = "link-lost" in faults
        self.scip.silent = lost or "laser-disconnected" in faults
        self.film.silence(
            head_pulled="camera-disconnected" in faults,
            head=lost,
            infrared=lost or "requests-silent" in faults,
        )
        if lost and not self._lost:
            self.ros.pause(ALWAYS if self.stepped else ())
        elif self._lost and not lost:
            self.ros.resume()
        self._lost = lost
