"""The speed of the bench's wheels, as another client of its rosbridge receives it."""

from __future__ import annotations

import json
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

LISTENING = 0x0A  # the state of such a socket in /proc/net/tcp


class Wheels:
    """Receives the odometry of the bench."""

    def __init__(self, link: Connection) -> None:
        self.told: list[tuple[float, float]] = []
        """Times (on the monotonic clock) and speeds, in m/s."""
        self._link = link
        self._link.send(json.dumps({"op": "subscribe", "topic": "/odom"}))
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        with suppress(WebSocketException, OSError):
            for text in self._link:
                twist = json.loads(text)["msg"]["twist"]["twist"]
                speed = float(np.hypot(twist["linear"]["x"], twist["angular"]["z"]))
                self.told.append((time.monotonic(), speed))

    @property
    def speed(self) -> float:
        """Its speed in m/s; a turn of a rad/s counts as one."""
        return self.told[-1][1] if self.told else 0.0

    def still_since(self) -> float:
        """Return the time since which it stands, on the monotonic clock."""
        return max((at for at, speed in self.told if speed > 1e-3), default=0.0)


def rosbridge(pid: int) -> str:
    """Return the address of a process's port that speaks rosbridge."""
    for port in _listens(pid):
        url = f"ws://127.0.0.1:{port}"
        with suppress(WebSocketException, OSError), connect(url, open_timeout=2):
            return url
    raise AssertionError("the bench has no rosbridge")


def _listens(pid: int) -> list[int]:
    names = [str(entry.readlink()) for entry in Path(f"/proc/{pid}/fd").iterdir()]
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    own = {name[8:-1] for name in names if name.startswith("socket:[")}
    listening = (row for row in rows if row[9] in own and int(row[3], 16) == LISTENING)
    return [int(row[1].rpartition(":")[2], 16) for row in listening]
