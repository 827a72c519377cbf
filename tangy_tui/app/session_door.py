"""The socket in a data folder through which onlookers follow the games of a running program.

One JSON line each way: an onlooker receives the snapshot of the game (`game_view`) on connecting
and whenever it changes, and may stop the robot. Onlookers read the log themselves. Without
onlookers the thread only waits.
"""

from __future__ import annotations

import json
import logging
import os
import selectors
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from tangy_profiles.codec import encode
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.game_view import GameView

_LOG = logging.getLogger(__name__)

FILE = "tangy.sock"
LOOK_SECONDS = 0.2  # between two snapshots
MOST_GUESTS = 32
LONGEST_LINE = 1000  # bytes that an onlooker may send before a line ends
LONGEST_NAME = 40  # characters of an onlooker's name

StoppedBy = Callable[[str], object]
"""Called by the socket's thread with the name of an onlooker who stopped the robot."""


class SessionDoor:
    """Serves onlookers. `open` it once; `attach` each controller of games."""

    def __init__(self, folder: Path) -> None:
        """Serve a data folder; nobody can connect before `open`."""
        self._folder = folder
        self._control: GameController | None = None
        self._stopped: StoppedBy = lambda guest: None
        self._socket: socket.socket | None = None
        self._ends = threading.Event()
        self._wake: tuple[socket.socket, socket.socket] | None = None
        self._thread: threading.Thread | None = None
        self._guests: dict[socket.socket, bytes] = {}
        self._shown = b""

    def attach(self, control: GameController, stopped: StoppedBy = lambda guest: None) -> None:
        """Show the games of a controller from now on.

        Args:
            control: runs the games.
            stopped: is called with the name of an onlooker who stopped the robot, afterwards.
        """
        self._control, self._stopped = control, stopped

    def detach(self, control: GameController) -> None:
        """Stop showing the games of a controller, if they are the ones shown."""
        if self._control is control:
            self._control, self._stopped = None, lambda guest: None

    def open(self) -> None:
        """Listen for onlookers, if the system has Unix sockets; may be repeated."""
        if self._thread is not None:
            return
        try:
            self._socket = _listen(self._folder)
        except OSError as error:
            _LOG.warning("nobody can look on: %s", error)
            return
        self._wake = socket.socketpair()
        self._thread = threading.Thread(target=self._run, name="door", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Disconnect everybody; may be repeated."""
        thread, self._thread = self._thread, None
        if thread is None or self._wake is None:
            return
        self._ends.set()
        with suppress(OSError):  # it is awake, and may have ended already
            self._wake[1].send(b".")
        thread.join()
        with suppress(OSError):
            (self._folder / FILE).unlink()

    def _run(self) -> None:
        assert self._socket is not None and self._wake is not None  # noqa: S101 - `open` made them
        with selectors.DefaultSelector() as ready, self._socket, self._wake[0], self._wake[1]:
            ready.register(self._socket, selectors.EVENT_READ)
            ready.register(self._wake[0], selectors.EVENT_READ)
            due = time.monotonic()
            while not self._ends.is_set():
                left = max(0.0, due - time.monotonic()) if self._guests else None
                for key, _ in ready.select(left):
                    if key.fileobj is self._socket:
                        self._let_in(ready)
                    elif isinstance(key.fileobj, socket.socket) and key.fileobj in self._guests:
                        self._hear(key.fileobj, ready)
                if self._guests and time.monotonic() >= due:
                    due = time.monotonic() + LOOK_SECONDS
                    self._show(ready)
            for guest in self._guests:
                guest.close()

    def _let_in(self, ready: selectors.BaseSelector) -> None:
        assert self._socket is not None  # noqa: S101 - it is ready to accept
        with suppress(OSError):
            guest, _ = self._socket.accept()
            guest.setblocking(False)
            if len(self._guests) >= MOST_GUESTS:  # the new one may want to stop
                first = next(iter(self._guests))
                self._hear(first, ready)
                self._show_out(first, ready)
            self._guests[guest] = b""
            ready.register(guest, selectors.EVENT_READ)
            self._tell(guest, self._look(), ready)

    def _hear(self, guest: socket.socket, ready: selectors.BaseSelector) -> None:
        """Read from an onlooker; disconnect one who has gone or sends too long a line."""
        try:
            said = guest.recv(LONGEST_LINE)
        except BlockingIOError:
            return
        except OSError:
            said = b""
        *lines, rest = (self._guests[guest] + said).split(b"\n")
        if not said or len(rest) > LONGEST_LINE:
            self._show_out(guest, ready)
            return
        self._guests[guest] = rest
        for line in lines:
            if (name := _stops(line)) is not None:
                self._tell(guest, _line({"stopped": self._stop(name)}), ready)

    def _stop(self, name: str) -> bool:
        """Stop the robot, and return whether it is stopped; errors must not end the thread."""
        control, stopped = self._control, self._stopped
        if control is None:
            return False
        try:
            from tangy_tui.app.game_commands import StopRobot

            control.apply(StopRobot(by=name))
            stopped(name)
        except Exception:
            _LOG.exception("a stop of somebody who looks on went wrong")
        return control.stopped

    def _show(self, ready: selectors.BaseSelector) -> None:
        view = self._look()
        if view == self._shown:
            return
        self._shown = view
        for guest in list(self._guests):
            self._tell(guest, view, ready)

    def _look(self) -> bytes:
        control = self._control
        view = None if control is None else _view_of(control)
        return _line({"pid": os.getpid(), "view": None if view is None else encode(view)})

    def _tell(self, guest: socket.socket, line: bytes, ready: selectors.BaseSelector) -> None:
        """Send a line to an onlooker; disconnect one who does not read, so that nobody waits."""
        try:
            whole = guest.send(line) == len(line)
        except OSError:
            whole = False
        if not whole:
            self._show_out(guest, ready)

    def _show_out(self, guest: socket.socket, ready: selectors.BaseSelector) -> None:
        if self._guests.pop(guest, None) is not None:
            ready.unregister(guest)
            guest.close()


def _line(said: object) -> bytes:
    return (
        json.dumps(said, ensure_ascii=False, separators=(",", ":")).encode(errors="replace") + b"\n"
    )


def _stops(line: bytes) -> str | None:
    """Return the name of an onlooker whose line stops the robot, None for any other line."""
    try:
        said = json.loads(line)
    except (ValueError, RecursionError):
        return None
    name = said.get("stop") if isinstance(said, dict) else None
    return plain(name)[:LONGEST_NAME] if isinstance(name, str) else None


def _listen(folder: Path) -> socket.socket:
    """Create the socket; replace one that a killed program left behind."""
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        with reachable(folder) as place:
            path = Path(place) / FILE
            path.unlink(missing_ok=True)
            listening.bind(str(path))
            path.chmod(0o600)
        listening.listen(MOST_GUESTS)
        listening.setblocking(False)
    except BaseException:
        listening.close()
        raise
    return listening


@contextmanager
def reachable(folder: Path) -> Iterator[str]:
    """Yield a short path of a folder: a socket's path is limited to about a hundred characters."""
    opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        short = Path(f"/proc/self/fd/{opened}")
        yield str(short if short.is_dir() else folder)
    finally:
        os.close(opened)


def _view_of(control: GameController) -> GameView | None:
    from tangy_tui.app.game_view import view_of  # only if somebody connects

    return view_of(control)
