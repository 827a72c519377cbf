"""A remote laptop's microphone, which `tangy mic` forwards through a unix socket.

Each client receives a line when its sound is accepted. The newest connection replaces the current
one, because a lost link leaves a silent connection open. Clients send raw samples and nothing else.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket
from pathlib import Path

from tangy_hw.audio.socket_place import ListeningSocket, same_user
from tangy_hw.audio.source import Chunks, Source, WholeSamples
from tangy_hw.audio.wav import SoundError
from tangy_profiles.reading import plain

LISTENING = b"listening\n"  # sent to a client when its sound is accepted
TAKEN = b"taken\n"  # and when another client replaces it
PIECE = 3_200  # bytes, 100 ms
QUIET = 10  # pieces
AFTER_ERROR = 1.0  # s until the next attempt after a failed accept


class LaptopMicrophone(Source):
    """Listens at a socket to one stream at a time."""

    def __init__(self, name: str, path: Path) -> None:
        """Listen at a path; its folder is created if necessary.

        Raises:
            SoundError: another Tangy listens there, or it is impossible.
        """
        super().__init__(name, live=True)
        try:
            path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        except OSError as error:
            reason = error.strerror or "it is not possible"
            raise SoundError(plain(f"{path.parent}: cannot be made ({reason}).")) from None
        self._place = ListeningSocket(path)
        self._heard: socket.socket | None = None
        self._next: socket.socket | None = None
        self._arrival = asyncio.Event()

    @property
    def path(self) -> Path:
        """Path of the socket."""
        return self._place.path

    async def _sound(self) -> Chunks:
        accepting = asyncio.create_task(self._accept())
        self.tell("Waiting for the laptop's microphone.")
        try:
            while True:
                await self._arrival.wait()
                self._arrival.clear()
                connection, self._next = self._next, None
                if connection is None:
                    continue
                self.tell("The laptop's microphone is connected.")
                async with contextlib.aclosing(self._stream(connection)) as chunks:
                    async for chunk in chunks:
                        yield chunk
                if self._next is None:
                    self.tell("The laptop's microphone has gone; waiting for it to come back.")
                else:
                    self.tell("Another microphone has connected, and takes the place of this one.")
                for _ in range(QUIET):  # silence ends the last utterance
                    yield bytes(PIECE)
        finally:
            accepting.cancel()
            await asyncio.wait({accepting})

    def _release(self) -> None:
        for connection in (self._heard, self._next):
            if connection is not None:
                connection.close()
        self._place.close()

    async def _stream(self, connection: socket.socket) -> Chunks:
        """Yield the data of one connection, until it ends or is replaced."""
        loop = asyncio.get_running_loop()
        whole = WholeSamples()
        self._heard = connection
        try:
            while chunk := await loop.sock_recv(connection, PIECE):
                yield whole.of(chunk)
        except ConnectionError:
            pass
        finally:
            self._heard = None
            connection.close()

    async def _accept(self) -> None:
        loop = asyncio.get_running_loop()
        while True:
            try:
                connection, _ = await loop.sock_accept(self._place.socket)
            except OSError:  # too many open files
                await asyncio.sleep(AFTER_ERROR)
                continue
            if not same_user(connection):
                connection.close()
                self.tell("Another user tried to send sound here, and was refused.")
                continue
            with contextlib.suppress(OSError):
                connection.send(LISTENING)
            if self._heard is not None:
                _dismiss(self._heard)
            if self._next is not None:
                _dismiss(self._next)
                self._next.close()
            self._next = connection
            self._arrival.set()


def _dismiss(connection: socket.socket) -> None:
    """End a stream; its reader reads to the end."""
    with contextlib.suppress(OSError):
        connection.send(TAKEN)
    with contextlib.suppress(OSError):
        connection.shutdown(socket.SHUT_RDWR)
