"""An MJPEG camera on the loopback that also shows every fault of a camera."""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable
from contextlib import suppress
from threading import Event, Thread
from types import TracebackType

import cv2
import numpy as np

from tests.hw.pictures import encoded, room, seen

SIZE = (320, 240)
RATE = 15.0
HEAD = b"HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=frame\r\n\r\n"


PART = b"--frame\r\nContent-Type: image/jpeg\r\nContent-Length: %d\r\n\r\n"


def _pictures(seed: int, light: float = 1.0, blur: float = 0.0, lamp: bool = False) -> list[bytes]:
    """Return a second of pictures that differ only by noise."""
    rng = np.random.default_rng(seed)
    still = room(seed, *SIZE)
    if lamp:
        still = (still * light).astype(np.uint8)
        cv2.circle(still, (60, 50), 12, (200, 220, 240), -1)
        light = 1.0
    taken = (seen(still, rng, light=light, blur=blur, noise=2) for _ in range(int(RATE)))
    return [encoded(one).tobytes() for one in taken]


class CameraServer:
    """Sends pictures to every client; `mode` says which, and may change at any time.

    live, frozen, covered, dark, blurred; hang (sends nothing more), half (stops in mid-picture),
    rubbish, close (ends each connection), refuse (nobody answers).
    """

    def __init__(self, seed: int = 1) -> None:
        self.kinds = {
            "live": _pictures(seed),
            "covered": _pictures(seed, light=0.03, blur=20),
            "dark": _pictures(seed, light=0.08, lamp=True),
            "blurred": _pictures(seed, blur=3),
        }
        self.kinds["frozen"] = self.kinds["live"][:1]
        self.still = room(seed, *SIZE)
        """Its scene, without noise."""
        self.mode = "live"
        self._ended = Event()
        self._threads: list[Thread] = []
        self._socket: socket.socket | None = None
        self.port = 0
        self.listen()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/camera.mjpg"

    def listen(self) -> None:
        """Listen at the same port as before."""
        self._socket = socket.create_server(("127.0.0.1", self.port), reuse_port=False)
        self.port = self._socket.getsockname()[1]
        self._start(self._accept, self._socket)

    def unplug(self) -> None:
        """Break off all connections, and refuse new ones until `listen`."""
        self.mode = "close"
        if self._socket is not None:
            with suppress(OSError):
                self._socket.shutdown(socket.SHUT_RDWR)
            self._socket.close()
            self._socket = None

    def __enter__(self) -> CameraServer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:  # fmt: skip
        self._ended.set()
        self.unplug()
        for thread in self._threads:
            thread.join(5)

    def _start(self, what: Callable[[socket.socket], None], with_what: socket.socket) -> None:
        thread = Thread(target=what, args=(with_what,), daemon=True)
        self._threads.append(thread)
        thread.start()

    def _accept(self, listening: socket.socket) -> None:
        with suppress(OSError):
            while True:
                connection, _ = listening.accept()
                self._start(self._send, connection)

    def _send(self, connection: socket.socket) -> None:
        number = 0
        with connection, suppress(OSError):
            connection.settimeout(2)
            connection.recv(4096)
            if self.mode != "hang":
                connection.sendall(HEAD)
            while not self._ended.wait(1 / RATE):
                mode = self.mode
                if mode == "hang":
                    continue
                if mode == "close":
                    # As from a pulled cable: the stream has no proper end.
                    connection.setsockopt(
                        socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0)
                    )
                    return
                if mode == "rubbish":
                    connection.sendall(np.random.default_rng(number).bytes(3_000))
                    continue
                kind = self.kinds["live" if mode == "half" else mode]
                number += 1
                jpeg = kind[number % len(kind)]
                part = PART % len(jpeg)
                if mode == "half":
                    connection.sendall(part + jpeg[: len(jpeg) // 2])
                    while self.mode == "half" and not self._ended.wait(0.05):
                        pass
                    return
                connection.sendall(part + jpeg + b"\r\n")
