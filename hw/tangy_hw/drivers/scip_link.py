"""Connection to a scanner: TCP (`tcp://host:port`) or a serial port (`/dev/ttyACM0`)."""

from __future__ import annotations

import asyncio
import contextlib
import importlib
import threading
from typing import Any, Protocol
from urllib.parse import urlsplit

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.reading import plain

PORT = 10940
"""Default port of Hokuyo's scanners."""

OPEN_SECONDS = 2.0  # timeout of a connection
WRITE_SECONDS = 1.0
CHUNK = 1 << 16


class Link(Protocol):
    """A connection: bytes in both directions, until it is closed or lost."""

    async def read(self) -> bytes:
        """Return the next bytes; b"" at the end."""
        ...

    async def write(self, sent: bytes) -> None:
        """Send bytes.

        Raises:
            OSError: they cannot be sent.
        """
        ...

    def close(self) -> None:
        """Close the connection."""
        ...


async def open_link(address: str, baud: int = 115_200) -> Link:
    """Open the connection to an address.

    Args:
        address: `tcp://host:port`, or the path of a serial port.
        baud: speed of a serial port; ignored over USB.

    Raises:
        DeviceError: it cannot be opened; a few words say why.
    """
    if "://" in address:
        host, port = tcp_address(address)
        try:
            async with asyncio.timeout(OPEN_SECONDS):
                return TcpLink(*await asyncio.open_connection(host, port))
        except TimeoutError:
            raise DeviceError("does not answer") from None
        except (OSError, UnicodeError) as error:  # UnicodeError: an impossible host
            why = "nobody listens there" if isinstance(error, ConnectionRefusedError) else error
            raise DeviceError(f"cannot be reached ({plain(str(why))})") from None
    return await SerialLink.open(address, baud)


def tcp_address(address: str) -> tuple[str, int]:
    """Parse `tcp://host:port`.

    Raises:
        DeviceError: it is not such an address.
    """
    try:
        parts = urlsplit(address)
        if parts.scheme == "tcp" and parts.hostname:
            return parts.hostname, parts.port or PORT
    except ValueError:
        pass
    raise DeviceError("has no such address (write tcp://HOST:PORT, or a port such as /dev/ttyACM0)")


class TcpLink:
    """A TCP connection."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    async def read(self) -> bytes:
        """Return the next bytes; b"" at the end."""
        try:
            return await self._reader.read(CHUNK)
        except OSError:
            return b""

    async def write(self, sent: bytes) -> None:
        """Send bytes."""
        self._writer.write(sent)
        await self._writer.drain()

    def close(self) -> None:
        """Close the connection without flushing."""
        self._writer.transport.abort()


class SerialLink:
    """A serial port; a thread reads it, because pyserial does not support asyncio."""

    def __init__(self, port: Any) -> None:
        self._port = port
        self._reader = asyncio.StreamReader()
        self._loop = asyncio.get_running_loop()
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._receive, name="scip", daemon=True)
        self._thread.start()

    @classmethod
    async def open(cls, path: str, baud: int) -> SerialLink:
        """Open a port.

        Raises:
            DeviceError: it cannot be opened.
        """
        try:
            serial = importlib.import_module("serial")  # only users of serial ports need it
        except ImportError:
            raise DeviceError("needs pyserial (pip install pyserial)") from None
        try:
            port = await asyncio.to_thread(
                serial.Serial, path, baud, timeout=0.1, write_timeout=WRITE_SECONDS, exclusive=True
            )
        except (OSError, ValueError) as error:  # pyserial's errors are OSErrors
            said = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
            raise DeviceError(f"cannot be opened ({plain(said)[:100]})") from None
        return cls(port)

    async def read(self) -> bytes:
        """Return the next bytes; b"" at the end."""
        return await self._reader.read(CHUNK)

    async def write(self, sent: bytes) -> None:
        """Send bytes."""
        await asyncio.to_thread(self._port.write, sent)

    def close(self) -> None:
        """Close the port; its thread ends within .1 s."""
        self._closed.set()

    def _receive(self) -> None:
        try:
            while not self._closed.is_set():
                came = self._port.read(max(1, self._port.in_waiting))
                if came:
                    self._say(self._reader.feed_data, came)
        except (OSError, TypeError):  # TypeError: pyserial, if a port vanishes during a read
            pass
        finally:
            with contextlib.suppress(OSError):
                self._port.close()
            self._say(self._reader.feed_eof)

    def _say(self, what: Any, *arguments: Any) -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended before the thread
            self._loop.call_soon_threadsafe(what, *arguments)
