"""Interface of a source of help requests."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from typing import NamedTuple

from tangy_profiles.errors import TangyError
from tangy_profiles.health import OK, Reading

DEVICE = "requests"
"""Name of the source in the robot's profile."""


class RequestError(TangyError):
    """A source of requests cannot be used; one sentence that names it."""


class HelpRequest(NamedTuple):
    """A request: its seat (from 1), and the person there ("" if unknown).

    `since` is of the monotonic clock, in s; `sure` is a probability from 0 to 1.
    """

    seat: int
    person: str
    since: float
    sure: float = 1.0


class ShownLetter(NamedTuple):
    """A letter that somebody shows at a seat (from 1), since when, and how sure it is."""

    seat: int
    letter: str
    since: float
    sure: float = 1.0


def _nobody(*_: object) -> None:
    """Ignore the event."""


class RequestSource:
    """Reports who asks: read `asking` at any time, or use `async for asks in source`.

    Use it with `async with`, or call `start` and `close`.
    """

    def __init__(self, name: str, seats: int, people: Sequence[str] = ()) -> None:
        """Prepare a source.

        Args:
            name: name of the source, as given.
            seats: number of seats.
            people: ids of the people at the seats, if known.
        """
        self.name = name
        self.seats = seats
        self.tell: Callable[[str], None] = _nobody
        """Called with a sentence about each change of the source."""
        self.looks = 0
        """Number of processed frames, if it uses a camera."""
        self.agreed = 0
        """Number of consecutive frames that showed exactly the current requests."""
        self._people = tuple(people)
        self._asks: dict[int, HelpRequest] = {}
        self._shown: dict[int, ShownLetter] = {}
        self._changed = asyncio.Event()
        self._closed = False
        self._error: RequestError | None = None

    async def __aenter__(self) -> RequestSource:
        await self.start()
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.close()

    @property
    def asking(self) -> tuple[HelpRequest, ...]:
        """Current requests, the longest waiting first."""
        return tuple(sorted(self._asks.values(), key=lambda ask: ask.since))

    @property
    def showing(self) -> tuple[ShownLetter, ...]:
        """Who shows which letter now, where the source can tell that; the first to do so first."""
        return tuple(sorted(self._shown.values(), key=lambda shown: shown.since))

    def answered(self, seat: int) -> None:
        """End the request of a seat that was visited, if nothing else ends it."""
        self._withdraw(seat)

    def reading(self) -> Reading:
        """Return the reading for the diagnosis."""
        return Reading(DEVICE, 0.0, OK)

    async def start(self) -> None:
        """Start listening; silence is a state, not an error."""

    async def close(self) -> None:
        """Close for good; pending waits end without a change."""
        self._closed = True
        self._changed.set()

    async def __aiter__(self) -> AsyncIterator[tuple[HelpRequest, ...]]:
        """Yield the current requests at each change.

        Raises:
            RequestError: it cannot go on; one sentence that says why.
        """
        shown: tuple[tuple[int, float], ...] = ()
        while not self._closed:
            now = tuple((ask.seat, ask.since) for ask in self.asking)
            if now != shown:
                shown = now
                yield self.asking
                continue
            self._changed.clear()
            await self._changed.wait()
        if self._error is not None:
            raise self._error

    def _ask(self, seat: int, sure: float = 1.0, since: float | None = None) -> None:
        """Record a new or continued request of an existing seat."""
        if not 1 <= seat <= self.seats:
            return
        ask = self._asks.get(seat)
        if ask is None:
            began = time.monotonic() if since is None else since
            self._asks[seat] = HelpRequest(seat, self._person(seat), began, sure)
            self._changed.set()
        else:
            self._asks[seat] = ask._replace(sure=sure)

    def _show(self, letters: Mapping[int, tuple[str, float]], since: float) -> None:
        """Take note of who shows a letter now, and how sure it is."""
        for seat in self._shown.keys() - letters.keys():
            del self._shown[seat]
        for seat, (letter, sure) in letters.items():
            before = self._shown.get(seat)
            same = before is not None and before.letter == letter
            began = before.since if before is not None and same else since
            if 1 <= seat <= self.seats:
                self._shown[seat] = ShownLetter(seat, letter, began, sure)

    def _withdraw(self, seat: int) -> None:
        """Record the end of a request."""
        if self._asks.pop(seat, None) is not None:
            self._changed.set()

    def _person(self, seat: int) -> str:
        return self._people[seat - 1] if seat <= len(self._people) else ""

    def _seat_of(self, word: str) -> int:
        """Return the seat that "2", "seat 2", "seat-2" or a person's id names, or 0."""
        if word in self._people:
            return self._people.index(word) + 1
        number = word.lower().removeprefix("seat").strip(" -_")
        return int(number) if number.isascii() and number.isdigit() and len(number) < 4 else 0
