"""A client of a rosbridge server: its subscriptions, and its queue of messages."""

from __future__ import annotations

import asyncio
import json
import math
from collections import deque
from contextlib import suppress
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

BACKLOG = 4 << 20  # queued characters of a slow client before its oldest messages are dropped
HELD = 1_000  # messages of a client stored during a pause
EARLY_SECONDS = 1e-6  # by which a throttled message may come early, because clocks round


def full_name(name: str) -> str:
    """Return a topic's or service's name with its leading slash."""
    return "/" + name.strip("/")


def encoded(message: object) -> str:
    """Return a message as JSON; arrays become lists, NaN and infinity null."""
    try:
        return _ENCODER.encode(message)
    except ValueError:  # JSON has neither NaN nor infinity
        return _ENCODER.encode(_finite(message))


class Client:
    """A connection with its subscriptions and its outgoing queue."""

    def __init__(self, connection: ServerConnection) -> None:
        """Set its connection."""
        self.connection = connection
        self.topics: dict[str, dict[str, tuple[float, int]]] = {}
        """Throttle in s and maximum message size of each subscription, by topic."""
        self.held: list[dict[str, Any]] = []
        """Messages that it sent during a pause."""
        self.unsaid: list[str] = []
        """Replies to send after a pause."""
        self._queue: deque[tuple[bool, str]] = deque()
        self._size = 0
        self._last: dict[str, float] = {}
        self._wake = asyncio.Event()
        self._fragmented = 0

    def subscribe(self, topic: str, key: str, throttle: float, largest: int) -> None:
        """Store a subscription with a throttle in s; it replaces one with the same key."""
        self.topics.setdefault(topic, {})[key] = throttle, largest

    def unsubscribe(self, topic: str, key: object = None) -> None:
        """Remove one subscription to a topic, or all of them."""
        kept = self.topics.get(topic, {})
        kept.pop(str(key), None)
        if key is None or not kept:
            self.topics.pop(topic, None)

    def is_due(self, topic: str, now: float) -> bool:
        """Return whether a message of a topic should be sent now (s), and record it as sent."""
        if topic not in self.topics:
            return False
        throttle = min(seconds for seconds, _ in self.topics[topic].values())
        if throttle and now - self._last.get(topic, -math.inf) < throttle - EARLY_SECONDS:
            return False
        self._last[topic] = now
        return True

    def largest(self, topic: str) -> int:
        """Return the maximum characters of an unfragmented message of a topic; 0: unlimited."""
        return min((size for _, size in self.topics[topic].values() if size), default=0)

    def say(self, text: str, *, loses: bool = False, largest: int = 0) -> None:
        """Queue a text, in fragments if it is too long.

        Args:
            text: the message.
            loses: whether it may be dropped if the client reads too slowly.
            largest: maximum bytes of a fragment; 0: unlimited.
        """
        if largest and len(text) > largest:
            self._fragmented += 1
            parts = [text[place : place + largest] for place in range(0, len(text), largest)]
            for number, part in enumerate(parts):
                whole = {"id": str(self._fragmented), "num": number, "total": len(parts)}
                self._put(loses, encoded({"op": "fragment", "data": part, **whole}))
        else:
            self._put(loses, text)

    async def write(self) -> None:
        """Send the queue while the connection is open."""
        with suppress(ConnectionClosed):
            while True:
                while self._queue:
                    _, text = self._queue.popleft()
                    self._size -= len(text)
                    await self.connection.send(text)
                    await asyncio.sleep(0)  # let other tasks run while many messages wait
                self._wake.clear()
                await self._wake.wait()

    def hold(self, message: dict[str, Any]) -> None:
        """Store a message for after a pause; if there are too many, drop published ones."""
        if len(self.held) >= HELD:
            oldest = (at for at, held in enumerate(self.held) if held["op"] == "publish")
            del self.held[next(oldest, 0)]
        self.held.append(message)

    def _put(self, loses: bool, text: str) -> None:
        self._queue.append((loses, text))
        self._size += len(text)
        if self._size > BACKLOG:
            kept: deque[tuple[bool, str]] = deque()
            while self._queue and self._size > BACKLOG // 2:
                lost, oldest = self._queue.popleft()
                if lost:
                    self._size -= len(oldest)
                else:
                    kept.append((lost, oldest))
            self._queue.extendleft(reversed(kept))
        self._wake.set()


def _plain(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is nothing that JSON has")


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(part) for key, part in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(part) for part in value]
    return _finite(value.tolist()) if hasattr(value, "tolist") else value


_ENCODER = json.JSONEncoder(separators=(",", ":"), allow_nan=False, default=_plain)
