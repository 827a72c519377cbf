"""Switches a robot on in the background; may be cancelled."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager, suppress
from time import monotonic
from types import FrameType
from typing import Any, Generic, NoReturn

from tangy_hw.cancellation import Cancellation
from tangy_tui.app.robot_opening import Opened, Opening

ENDING = (signal.SIGHUP, signal.SIGTERM, signal.SIGINT)
"""The signals by which a person or a system ends a program."""
HEARD_AFTER = 0.05
"""The longest delay of a signal, in s.

A signal that arrives just as a thread starts to wait for another does not interrupt it: without
this timeout, Python would handle it only after the opening.
"""
SIGNALLED = 128
"""The exit status of a program ended by a signal is this plus the signal's number."""


class SwitchingOn(Generic[Opened]):
    """A robot to `open` on one thread, `cancel` from another, and `close` at the end."""

    def __init__(self, opening: Opening[Opened], *, stepped: bool = False) -> None:
        """Prepare it.

        Args:
            opening: opens the robot, or its bench.
            stepped: run simulated time as fast as possible, on a bench.
        """
        self._opening = opening
        self._stepped = stepped
        self._cancellation = Cancellation()
        self._opened = ExitStack()
        self.took = 0.0
        """How long the robot took to come on, in s; 0: it has not come on yet."""
        self.failure = ""
        """Why it did not come on, for people to read; empty: it is on, or was cancelled."""

    def open(self) -> Opened:
        """Switch the robot on, which takes seconds; after an error it can be tried again.

        Raises:
            Cancelled: it was cancelled; nothing is on.
            TangyError: it cannot be switched on.
        """
        try:
            self._cancellation.check()
            with ExitStack() as opened:
                began = monotonic()
                world = opened.enter_context(self._opening(self._stepped, self._cancellation))
                self.took = monotonic() - began
                self._cancellation.complete()
                self._opened = opened.pop_all()
        except BaseException:
            self._cancellation = Cancellation()  # people may switch it on once more
            raise
        return world

    @property
    def parts(self) -> tuple[str, ...]:
        """The parts started so far; the last one is being started."""
        return self._cancellation.parts

    @property
    def done(self) -> tuple[int, int] | None:
        """The progress of the last part: pieces done and in total; None: it has no pieces."""
        return self._cancellation.done

    def cancel(self) -> None:
        """Cancel the opening, from any thread and without waiting; no effect once it is open."""
        self._cancellation.cancel()

    def close(self) -> None:
        """Switch the robot off, if it is on; pending waits end at once."""
        self._opened.close()


@contextmanager
def switched_on(
    opening: Opening[Opened],
    *,
    stepped: bool,
    tell: Callable[[str], object] = lambda part: None,
    meanwhile: Callable[[], object] = lambda: None,
) -> Iterator[Opened]:
    """Switch a robot on for a program without a screen, and off again however that ends.

    Args:
        opening: opens the robot, or its bench.
        stepped: run simulated time as fast as possible, on a bench.
        tell: called with the name of each part when it is started.
        meanwhile: called again and again until the robot is on.

    Raises:
        TangyError: it cannot be switched on.
        SystemExit: the program got SIGHUP or SIGTERM.
        KeyboardInterrupt: ctrl+c was pressed.
    """
    robot = SwitchingOn(opening, stepped=stepped)
    with _Signals(robot.cancel) as signals:
        try:
            with ThreadPoolExecutor(1, "opening") as thread:
                opened = thread.submit(robot.open)
                told = 0
                while not wait([opened], HEARD_AFTER).done:
                    meanwhile()
                    for part in robot.parts[told:]:
                        tell(part)
                        told += 1
            signals.raise_from_now_on()
            yield opened.result()
        finally:
            robot.close()


class _Signals:
    """Handles the signals that end a program, so that no process is left behind.

    At first a signal only cancels the opening, because a process may just be starting. Later it
    raises at once.
    """

    def __init__(self, call_off: Callable[[], None]) -> None:
        self._call_off = call_off
        self._raises = False
        self._first = 0  # the number of the first signal
        self._before: dict[int, Any] = {}

    def __enter__(self) -> _Signals:
        for number in ENDING:
            with suppress(ValueError):  # signals reach only the main thread
                if signal.getsignal(number) != signal.SIG_IGN:  # as under `nohup`
                    self._before[number] = signal.signal(number, self._hear)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def raise_from_now_on(self) -> None:
        """Raise on the next signal; at once if one has already come."""
        self._raises = True
        if self._first:
            self._raise()

    def _hear(self, number: int, _: FrameType | None) -> None:
        if self._first:
            return  # already handled
        self._first = number
        if self._raises:
            self._raise()
        self._call_off()

    def _raise(self) -> NoReturn:
        if self._first == signal.SIGINT:
            raise KeyboardInterrupt
        raise SystemExit(SIGNALLED + self._first)
