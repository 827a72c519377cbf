"""Link to a robot through rosbridge v2: JSON over WebSocket, for ROS 1 and ROS 2.

It connects and reconnects by itself. A connection alone proves little: that of a frozen bridge
stays open. What counts is the age of the newest data, which `reading` and each device report.
"""

from __future__ import annotations

import asyncio
import json
import random
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any
from urllib.parse import urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.rosbridge_parts import Fragments
from tangy_hw.drivers.rosbridge_waiting import Goal, PendingRequests
from tangy_hw.rate_estimator import RateEstimator
from tangy_profiles.health import OK, STALE, DeviceState, Reading
from tangy_profiles.reading import plain

Message = Mapping[str, Any]
Hears = Callable[[Message], None]
Tells = Callable[[str], None]

LARGEST = 16 << 20  # bytes of a received message
FIRST_WAIT, LONGEST_WAIT = 0.25, 2.0  # s between two attempts to connect, with backoff
OPENING_SECONDS = 3.0  # timeout of the handshake
PING_SECONDS, PONG_SECONDS = 5.0, 10.0  # after which an unplugged cable is noticed
CLOSING_SECONDS = 0.2  # timeout for the last messages and the closing handshake
QUEUED = 2_000  # maximum of queued messages
SAYINGS = 50  # maximum of different sentences reported for one link


class Rosbridge:
    """Topics, services and actions of a rosbridge server, over one connection shared by devices."""

    name = "link"

    def __init__(
        self,
        url: str,
        *,
        clock: Callable[[], float] = time.monotonic,
        tell: Tells = lambda _: None,
        ros: int = 1,
    ) -> None:
        """Describe the server.

        Args:
            url: address of the server, ws://HOST:PORT.
            clock: clock for the ages of data, in s.
            tell: called with a sentence for each event that people should know.
            ros: 1 or 2: how types and times are spelled.

        Raises:
            DeviceError: the address is invalid.
        """
        try:
            parts = urlsplit(url)
            good = parts.scheme in ("ws", "wss") and bool(parts.hostname) and parts.port != 0
        except ValueError:
            good = False
        if not good:
            raise DeviceError(plain(f"{url}: give ws://HOST:PORT, as in ws://192.168.1.20:9090."))
        if ros not in (1, 2):
            raise DeviceError(f"{plain(url)}: ros must be 1 or 2.")
        self.url, self.ros = url, ros
        self.drives = True
        """Whether driving needs this link: without it the robot must stop."""
        self.clock = clock
        self._tell = tell
        self._told: set[str] = set()
        self._task: asyncio.Task[None] | None = None
        self._connected = asyncio.Event()
        self._heard: float | None = None
        self._arrivals = RateEstimator()
        self._began = clock()
        self._hears: dict[str, list[Hears]] = {}
        self._hello: dict[str, str] = {}
        self._on_connect: list[Callable[[], None]] = []
        self._urgent: dict[str, str] = {}
        self.waiting: deque[str] = deque()
        self._wake = asyncio.Event()
        self._idle = asyncio.Event()
        self._waiting = PendingRequests()
        self._fragments = Fragments()

    @property
    def connected(self) -> bool:
        """Whether the connection is open, as that of a frozen robot is too."""
        return self._connected.is_set()

    @property
    def heard(self) -> float | None:
        """Arrival of the newest message of any kind, in s of the clock; None: never."""
        return self._heard

    async def start(self) -> None:
        """Keep connecting until `close`."""
        if self._task is None:
            self._began = self.clock()
            self._task = asyncio.create_task(self._live())

    async def close(self) -> None:
        """Send the queued messages, and close for good."""
        task, self._task = self._task, None
        if task is not None:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._flushed(), CLOSING_SECONDS)
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

    async def wait_connected(self, seconds: float) -> bool:
        """Wait for a connection, with a timeout in s; return whether there is one."""
        with suppress(TimeoutError):
            await asyncio.wait_for(self._connected.wait(), seconds)
        return self.connected

    def reading(self) -> Reading:
        """Return the age of the newest message of any kind, the last sign of life."""
        since = self._began if self._heard is None else self._heard
        state: DeviceState = OK if self.connected and self._heard is not None else STALE
        now = self.clock()
        return Reading(self.name, max(now - since, 0.0), state, rate=self._arrivals.rate(now))

    def on_connect(self, does: Callable[[], None]) -> None:
        """Add a callback for each new connection, called before anything is sent."""
        self._on_connect.append(does)
        if self.connected:
            does()

    def subscribe(self, topic: str, kind: str, hears: Hears, *, throttle: float = 0) -> None:
        """Subscribe to a topic with a callback, also after reconnecting.

        Args:
            topic: name of the topic.
            kind: message type, as ROS 1 spells it.
            hears: called with each message.
            throttle: minimum time between two messages in s; only the newest is sent.
        """
        topic = _full(topic)
        self._hears.setdefault(topic, []).append(hears)
        wire = {"op": "subscribe", "id": topic, "topic": topic, "type": self.spelled(kind)}
        wish = {"throttle_rate": round(throttle * 1000), "queue_length": 1} if throttle else {}
        self._greet(f"subscribe {topic}", {**wire, **wish})

    def unsubscribe(self, topic: str, hears: Hears) -> None:
        """Remove a callback from a topic."""
        topic = _full(topic)
        with suppress(KeyError, ValueError):
            self._hears[topic].remove(hears)
            if not self._hears[topic]:
                del self._hears[topic], self._hello[f"subscribe {topic}"]
                self._send({"op": "unsubscribe", "id": topic, "topic": topic})

    def advertise(self, topic: str, kind: str) -> None:
        """Advertise a topic, now and at every new connection."""
        topic = _full(topic)
        wire = {"op": "advertise", "id": f"publish {topic}", "topic": topic}
        self._greet(f"advertise {topic}", {**wire, "type": self.spelled(kind)})

    def publish(self, topic: str, message: Message, *, urgent: bool = False) -> None:
        """Queue a message without waiting.

        Args:
            topic: name of the topic.
            message: the message as JSON.
            urgent: send it before all queued messages, and replace those of this topic.

        Raises:
            DeviceError: there is no connection.
        """
        topic = _full(topic)
        wire = {"op": "publish", "topic": topic, "msg": message}
        if not self.connected:
            raise DeviceError(f"{topic} cannot be published: {self._unreachable()}")
        if urgent:
            self._urgent[topic] = _encoded(wire)
            self._stir()
        else:
            self._send(wire)

    async def call(self, service: str, arguments: Message, seconds: float = 5.0) -> Message:
        """Call a service and return its values.

        Raises:
            DeviceError: it refused, did not answer within `seconds` s, or the connection was lost.
        """
        name = _full(service)
        if not self.connected:
            raise DeviceError(f"{name} cannot be called: {self._unreachable()}")
        key, answer = self._waiting.call(name)
        self._send({"op": "call_service", "id": key, "service": name, "args": arguments})
        try:
            return await asyncio.wait_for(answer, seconds)
        except TimeoutError:
            raise DeviceError(f"{name} did not answer within {seconds:g} s.") from None
        finally:
            self._waiting.forget(key)

    def send_goal(self, action: str, kind: str, goal: Message, feeds: Hears | None = None) -> Goal:
        """Send a goal to a ROS 2 action; the returned goal reports its progress.

        Raises:
            DeviceError: there is no connection.
        """
        name = _full(action)
        if not self.connected:
            raise DeviceError(f"{name} cannot be begun: {self._unreachable()}")
        sought = self._waiting.goal(name, feeds)
        kind = kind if kind.count("/") == 2 else kind.replace("/", "/action/")
        wire = {"op": "send_action_goal", "id": sought.key, "action": name, "action_type": kind}
        self._send({**wire, "args": goal, "feedback": feeds is not None})
        return sought

    def cancel_goal(self, goal: Goal) -> None:
        """Ask the robot to cancel a goal, sent over any link; `over` reports when it has.

        Some bridges process no other message of a link while it has an active goal.
        """
        goal.given_up = True
        self._send({"op": "cancel_action_goal", "id": goal.key, "action": goal.action})

    def spelled(self, kind: str) -> str:
        """Return a message type in the form of this ROS version: pkg/Kind or pkg/msg/Kind."""
        package, _, name = kind.partition("/")
        name = name.removeprefix("msg/")
        return f"{package}/{name}" if self.ros == 1 else f"{package}/msg/{name}"

    def tell_once(self, sentence: str) -> None:
        """Report a sentence unless it was reported before."""
        if sentence not in self._told and len(self._told) < SAYINGS:
            self._told.add(sentence)
            self._tell(plain(sentence))

    async def _live(self) -> None:
        wait = FIRST_WAIT
        while True:
            reason = "it ended the connection"
            before = self._heard
            try:
                async with connect(
                    self.url,
                    compression=None,
                    proxy=None,  # a robot is on this network: ignore proxy settings
                    max_size=LARGEST,
                    open_timeout=OPENING_SECONDS,
                    ping_interval=PING_SECONDS,
                    ping_timeout=PONG_SECONDS,
                    close_timeout=CLOSING_SECONDS,
                ) as socket:
                    await self._talk(socket)
            except Exception as error:  # any error: the link must go on reconnecting
                reason = str(error) or type(error).__name__
            finally:
                self._lose(reason)
            wait = FIRST_WAIT if self._heard != before else min(2 * wait, LONGEST_WAIT)
            await asyncio.sleep(wait * random.uniform(0.8, 1.2))

    async def _talk(self, socket: ClientConnection) -> None:
        self._urgent.clear()  # messages from before the loss are outdated
        self.waiting.clear()
        self._fragments = Fragments()
        self._connected.set()
        for does in self._on_connect:
            does()
        writing = asyncio.create_task(self._write(socket, tuple(self._hello.values())))
        try:
            async for text in socket:
                self.hear(text)
        finally:
            writing.cancel()
            await asyncio.gather(writing, return_exceptions=True)

    async def _write(self, socket: ClientConnection, greetings: Sequence[str]) -> None:
        with suppress(WebSocketException):
            for text in greetings:
                await socket.send(text)
            while True:
                while self._urgent or self.waiting:
                    if self._urgent:
                        text = self._urgent.pop(next(iter(self._urgent)))
                    else:
                        text = self.waiting.popleft()
                    await socket.send(text)
                    await asyncio.sleep(0)  # let other tasks run while many messages wait
                self._idle.set()
                self._wake.clear()
                await self._wake.wait()

    def _stir(self) -> None:
        self._idle.clear()
        self._wake.set()

    async def _flushed(self) -> None:
        if self.connected:
            await self._idle.wait()

    def _lose(self, reason: str) -> None:
        if self._task is None:
            pass  # closed by `close`
        elif self._connected.is_set():
            self._tell(plain(f"The link to {self.url} was lost: {reason}"))
        else:
            self.tell_once(f"There is no link to {self.url}: {reason}")
        self._connected.clear()
        self._waiting.lose(f"the link was lost: {reason}")

    def _unreachable(self) -> str:
        return plain(f"there is no link to {self.url}.")

    def _greet(self, key: str, wire: Message) -> None:
        fresh = _encoded(wire)
        if self._hello.get(key) != fresh:
            self._hello[key] = fresh
            self._send(wire)

    def _send(self, wire: Message) -> None:
        """Queue a message; drop it without a connection."""
        if self.connected:
            if len(self.waiting) >= QUEUED:
                self.waiting.popleft()
            self.waiting.append(_encoded(wire))
            self._stir()

    def hear(self, text: str | bytes) -> None:
        """Handle one message of the server; skip invalid ones."""
        try:
            message = json.loads(text)
            if not isinstance(message, dict):
                raise ValueError("it is not an object")
            whole = self._fragments.take(message) if message.get("op") == "fragment" else None
        except (ValueError, RecursionError, KeyError, TypeError) as error:
            self.tell_once(f"{self.url} sends something that is not a rosbridge message: {error}")
            return
        self._heard = self.clock()
        self._arrivals.count(self._heard)
        if whole is not None:
            self.hear(whole)
            return
        op = message.get("op")
        if op == "publish":
            self._published(message)
        elif op in ("service_response", "action_result", "action_feedback"):
            self._waiting.take(message)
        elif op == "status":
            if message.get("level") in ("error", "warning"):
                self.tell_once(f"{self.url} says: {message.get('msg')}")
        elif op != "fragment":
            self.tell_once(f"{self.url} sends operation {op!r}, which is not heeded.")

    def _published(self, message: Message) -> None:
        topic = _full(str(message.get("topic", "")))
        for hears in tuple(self._hears.get(topic, ())):
            try:
                hears(message["msg"])
            except Exception as error:  # an invalid message must not break the link for others
                wrong = f"{type(error).__name__}: {error}"
                self.tell_once(f"A message of {topic} cannot be read: {wrong}")


def _full(name: str) -> str:
    return "/" + name.strip("/")


def _encoded(wire: Message) -> str:
    return json.dumps(wire, separators=(",", ":"), allow_nan=False)
