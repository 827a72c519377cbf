"""A unix socket that only its owner can reach, at most one per path.

It is bound and given its mode in a folder that nobody else can enter, and only then moved to its
path. A lock file, released when its holder dies, distinguishes a socket in use from a stale one.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import socket
import stat
import struct
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tangy_hw.audio.wav import SoundError
from tangy_profiles.reading import plain

LONGEST_ADDRESS = 103  # bytes that every system supports; Linux supports 107
HALF_OPEN = 8  # backlog of pending connections


class ListeningSocket:
    """A socket that listens at a path until it is closed."""

    def __init__(self, path: Path) -> None:
        """Listen at a path; a stale socket is replaced.

        Raises:
            SoundError: another program listens there, or it is impossible.
        """
        self.path = path.absolute()
        try:
            self._lock = _locked(self._beside)
            try:
                with _address(self.path):
                    pass  # for clients: refuse a path that is too long
                _clear(self.path)
                self.socket = _bound(self.path)
                self._made = self.path.lstat()
            except BaseException:
                self._unlock()
                raise
        except OSError as error:
            reason = error.strerror or "it is not possible"
            raise SoundError(plain(f"{self.path}: cannot be listened at ({reason}).")) from None

    @property
    def _beside(self) -> Path:
        return self.path.with_name(self.path.name + ".lock")

    def close(self) -> None:
        """Stop listening, and remove the socket."""
        self.socket.close()
        with contextlib.suppress(OSError):
            if os.path.samestat(self.path.lstat(), self._made):
                self.path.unlink()
        self._unlock()

    def _unlock(self) -> None:
        if self._lock >= 0:
            with contextlib.suppress(OSError):
                self._beside.unlink()
            os.close(self._lock)
            self._lock = -1


def connect(path: Path) -> socket.socket | None:
    """Connect to the listener at a path; None if there is none.

    Raises:
        SoundError: it belongs to another user, or is not a socket.
    """
    path = path.absolute()
    connection = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        connection.setblocking(False)
        with _address(path) as address:
            connection.connect(address)
        if not same_user(connection):
            raise SoundError(plain(f"{path}: another user listens there; sound is not sent to it."))
    except (FileNotFoundError, NotADirectoryError, ConnectionRefusedError, BlockingIOError):
        connection.close()
        if path.exists() and not path.is_socket():
            raise SoundError(plain(f"{path}: is there, and is no socket.")) from None
        return None
    except PermissionError:
        connection.close()
        raise SoundError(
            plain(f"{path}: may not be used; log in as the user that Tangy runs as.")
        ) from None
    except OSError as error:
        connection.close()
        reason = error.strerror or "it is not possible"
        raise SoundError(plain(f"{path}: cannot be connected to ({reason}).")) from None
    except SoundError:
        connection.close()
        raise
    return connection


def same_user(connection: socket.socket) -> bool:
    """Return whether the peer belongs to this user or root.

    On systems without peer credentials, the mode of the socket has to suffice.
    """
    if sys.platform != "linux":
        return True
    size = struct.calcsize("3i")
    _, user, _ = struct.unpack(
        "3i", connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, size)
    )
    return user in (os.geteuid(), 0)


def _locked(path: Path) -> int:
    """Acquire the lock, and return the file descriptor that holds it."""
    while True:
        lock = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o600)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if os.path.samestat(path.stat(), os.fstat(lock)):
                return lock
        except FileNotFoundError:
            pass  # its last holder has just removed it
        except BlockingIOError:
            os.close(lock)
            raise SoundError(
                plain(f"{path.with_suffix('')}: another Tangy listens here; end it first.")
            ) from None
        os.close(lock)


def _clear(path: Path) -> None:
    """Reject a path in use; a stale socket may be replaced."""
    try:
        kind = path.lstat().st_mode
    except FileNotFoundError:
        return
    if not stat.S_ISSOCK(kind):
        raise SoundError(plain(f"{path}: is there, and is no socket; choose another path."))
    with contextlib.closing(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)) as probe:
        probe.setblocking(False)
        try:
            with _address(path) as address:
                probe.connect(address)
        except (ConnectionRefusedError, FileNotFoundError):
            return
        except BlockingIOError:
            pass
    raise SoundError(plain(f"{path}: another program listens here; choose another path."))


def _bound(path: Path) -> socket.socket:
    """Create the socket where nobody else can reach it, then move it to its path."""
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    apart = Path(tempfile.mkdtemp(prefix=".mic-", dir=path.parent))  # 0700
    made = apart / "s"
    try:
        listening.setblocking(False)
        with _address(made) as address:
            listening.bind(address)
        made.chmod(0o600)
        listening.listen(HALF_OPEN)
        made.rename(path)
    except BaseException:
        listening.close()
        with contextlib.suppress(OSError):
            made.unlink()
        raise
    finally:
        with contextlib.suppress(OSError):
            apart.rmdir()
    return listening


@contextmanager
def _address(path: Path) -> Iterator[str]:
    """Yield a socket address for a path; a long folder is replaced by its descriptor in /proc."""
    if len(os.fsencode(path)) <= LONGEST_ADDRESS:
        yield str(path)
        return
    if not Path("/proc/self/fd").exists():
        raise SoundError(plain(f"{path}: is too long for a socket; choose a shorter path."))
    folder = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        short = f"/proc/self/fd/{folder}/{path.name}"
        if len(os.fsencode(short)) > LONGEST_ADDRESS:
            raise SoundError(plain(f"{path}: its name is too long; choose a shorter one."))
        yield short
    finally:
        os.close(folder)
