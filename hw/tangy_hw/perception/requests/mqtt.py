"""Requests by MQTT: buttons of a smart home, or anything else that can publish.

    mqtt://HOST/tangy/requests     and the topic tangy/requests/2, or .../seat-2, or .../user2

A message asks ("1", "on", "true", "help", "press", "single", or JSON with one of these as its
action, state or value) or takes that back ("0", "off", "false", "done", "cancel", "double",
"long"). What the broker has retained is old, and is not heeded.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from tangy_hw.perception.requests.help_request_source import DEVICE, RequestError, RequestSource
from tangy_profiles.health import OK, STALE, Reading
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from paho.mqtt.client import Client

ASKS = frozenset(("1", "on", "true", "yes", "ar", "help", "press", "pressed", "single", "open"))
TAKES_BACK = frozenset(
    ("0", "off", "false", "no", "anr", "done", "cancel", "double", "long", "hold", "closed")
)
KEYS = ("action", "state", "value", "asks", "event")
LONGEST = 1_000  # bytes of a message
ALIVE_SECONDS = 5  # between keepalive packets; a silent broker counts as lost
AGAIN_SECONDS = 1  # until it reconnects


class Topic(RequestSource):
    """Requests from a topic of a broker, with automatic reconnection."""

    def __init__(self, url: str, seats: int, people: Sequence[str] = ()) -> None:
        """Set the broker and the topic.

        Raises:
            RequestError: the address is invalid, or the package for it is not installed.
        """
        try:
            parts = urlsplit(url)
            port = parts.port or (8883 if parts.scheme == "mqtts" else 1883)
        except ValueError:
            parts, port = urlsplit(""), 0
        self._topic = unquote(parts.path).strip("/")
        self._host = parts.hostname or ""
        super().__init__(plain(f"mqtt://{self._host}:{port}/{self._topic}"), seats, people)
        if parts.scheme not in ("mqtt", "mqtts") or not self._host or not self._topic:
            raise RequestError(f"{self.name}: give mqtt://HOST/TOPIC or mqtts://HOST/TOPIC.")
        if set("#+\0") & set(self._topic) or "#" in url:
            raise RequestError(f"{self.name}: the topic must be one, without # and +.")
        self._port = port
        self._secure = parts.scheme == "mqtts"
        self._user = unquote(parts.username or ""), unquote(parts.password or "")
        self._client: Client | None = None
        self._lost: float | None = time.monotonic()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._unknown: set[str] = set()
        _package()

    def reading(self) -> Reading:
        """Return the reading for the diagnosis; no requests are not a fault."""
        if self._lost is None:
            return Reading(DEVICE, 0.0, OK)
        return Reading(DEVICE, time.monotonic() - self._lost, STALE)

    async def start(self) -> None:
        """Connect and subscribe."""
        mqtt = _package()
        self._loop = asyncio.get_running_loop()
        self._client = client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        if self._user[0]:
            client.username_pw_set(*self._user)
        if self._secure:
            client.tls_set()
        client.reconnect_delay_set(AGAIN_SECONDS, AGAIN_SECONDS)
        client.on_connect = self._connected
        client.on_connect_fail = lambda *_: self._later(self._gone, "nobody answers there")
        client.on_disconnect = lambda *_: self._later(self._gone, "the connection was lost")
        client.on_message = self._message
        client.connect_async(self._host, self._port, keepalive=ALIVE_SECONDS)
        client.loop_start()

    async def close(self) -> None:
        """Disconnect."""
        await super().close()
        client, self._client = self._client, None
        if client is not None:
            client.disconnect()
            await asyncio.to_thread(client.loop_stop)

    def hear(self, topic: str, payload: bytes) -> None:
        """Handle one message."""
        seat = self._seat_of(topic.removeprefix(self._topic).strip("/"))
        said = _meaning(payload)
        if not 1 <= seat <= self.seats or said is None:
            if topic not in self._unknown and len(self._unknown) < 20:
                self._unknown.add(topic)
                what = "names no seat" if said is not None else "says neither yes nor no"
                self.tell(plain(f"A message of {topic[:80]} {what}; it is not heeded."))
        elif said:
            self._ask(seat)
        else:
            self._withdraw(seat)

    def _connected(self, client: Client, _data: Any, _flags: Any, reason: Any, _: Any) -> None:
        if reason.is_failure:
            self._later(self._gone, f"it refuses us: {reason}".lower())
            return
        client.subscribe(f"{self._topic}/#", qos=1)
        self._later(self._here)

    def _message(self, _client: Client, _data: Any, message: Any) -> None:
        if not message.retain:
            self._later(self.hear, message.topic, bytes(message.payload[: LONGEST + 1]))

    def _later(self, what: Any, *arguments: Any) -> None:
        """Call something on the program's thread; the MQTT client has its own."""
        if self._loop is not None and not self._closed and not self._loop.is_closed():
            self._loop.call_soon_threadsafe(what, *arguments)

    def _here(self) -> None:
        if self._lost is not None:
            self._lost = None
            self.tell(f"Listening at {self.name}.")

    def _gone(self, why: str) -> None:
        if self._closed:
            return
        if self._lost is None or not self._unknown & {"\0gone"}:
            self.tell(plain(f"{self.name}: {why[:120]}. It is tried again."))
            self._unknown.add("\0gone")
        if self._lost is None:
            self._lost = time.monotonic()


def _meaning(payload: bytes) -> bool | None:
    """Return whether a message asks (True) or withdraws (False); None if neither."""
    if len(payload) > LONGEST:
        return None
    text = payload.decode("utf-8", "replace").strip()
    try:
        value = json.loads(text)
    except (ValueError, RecursionError):
        value = text
    if isinstance(value, dict):
        value = next((value[key] for key in KEYS if key in value), None)
    word = str(value).strip().lower()
    return True if word in ASKS else False if word in TAKES_BACK else None


def _package() -> Any:
    try:
        from paho.mqtt import client
    except ImportError:
        raise RequestError(
            "Requests by MQTT need the package paho-mqtt: pip install 'tangy[mqtt]'."
        ) from None
    return client
