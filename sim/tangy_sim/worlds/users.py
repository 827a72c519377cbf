"""Model of simulated people: rates of mistakes and requests, and one player with a card."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from importlib.resources import files
from math import log
from pathlib import Path

from tangy_profiles.cards import CardState, Deck, judge
from tangy_profiles.reading import read_toml


@dataclass(frozen=True)
class UserModel:
    """Fitted rates of simulated people; `users.toml` describes each.

    `ask` is per person and call duration; `away_calls` in call durations; `call_seconds` in s.
    """

    miss: float
    slip: float
    ask: float
    ask_with_error: float
    occluded: float
    call_seconds: float
    away_calls: float
    preferred: float
    other: float
    teaching_factor: float

    def teaching(self) -> UserModel:
        """Return the model of a teaching game, in which people ask for help more often."""
        return replace(self, ask=self.ask * self.teaching_factor)


def load_users(path: Path | None = None) -> UserModel:
    """Read the default user model, or another of the same form.

    Raises:
        ProfileError: one line with file, key and value.
    """
    top = read_toml(path or Path(str(files("tangy_sim.worlds"))) / "users.toml")
    play, teaching, compliance = top.table("play"), top.table("teaching"), top.table("compliance")
    model = UserModel(
        miss=play.number("miss", 0, 1),
        slip=play.number("slip", 0, 1),
        ask=play.number("ask", 0, 10),
        ask_with_error=play.number("ask_with_error", 1, 100),
        occluded=play.number("occluded", 0, 1),
        call_seconds=play.number("call_seconds", 1, 600),
        away_calls=play.number("away_calls", 0, 100),
        preferred=compliance.number("preferred", 0, 1),
        other=compliance.number("other", 0, 1),
        teaching_factor=teaching.number("ask_factor", 0, 100),
    )
    for table in (play, teaching, compliance, top):
        table.close()
    return model


class SimulatedUser:
    """A simulated person at the table: a card, its marks, and the next actions."""

    __slots__ = ("asks_at", "called", "cell", "deck", "did", "id", "marked", "numbers", "slips_at")

    def __init__(self, id: str, deck: Deck, numbers: tuple[int, ...]) -> None:
        self.id = id
        self.deck = deck
        self.numbers = numbers
        self.cell = {number: place for place, number in enumerate(numbers)}
        self.marked = self.called = deck.free
        self.slips_at = 0  # call after which the next uncalled number is marked
        self.asks_at = 0.0  # earliest time of the next request, in calls
        self.did: tuple[int, str, int] = (-1, "", 0)  # step, action, number

    @property
    def has_error(self) -> bool:
        """Whether the marks differ from the called numbers."""
        return self.marked != self.called

    def mark(self, cell: int) -> bool:
        """Put a marker on a cell; return whether that completes a line, winning or not."""
        self.marked |= 1 << cell
        marked = self.marked
        for line in self.deck.lines_through[cell]:  # noqa: SIM110 - twice as fast as any()
            if marked & line == line:
                return True
        return False

    def catch_up(self, called: Iterable[int]) -> None:
        """Mark all numbers that were called so far, and no others."""
        for number in called:
            if (cell := self.cell.get(number)) is not None:
                self.called |= 1 << cell
        self.marked = self.called

    def uncall(self, number: int) -> None:
        """Revert the call of a number, and remove a marker on it."""
        if (cell := self.cell.get(number)) is not None:
            self.called &= ~(1 << cell)
            self.marked &= ~(1 << cell)

    def cells(self, mask: int) -> tuple[int, ...]:
        """Return the numbers on the cells of a mask."""
        return tuple(n for place, n in enumerate(self.numbers) if mask >> place & 1)

    def slip(self, uniform: Callable[[], float]) -> tuple[int, bool] | None:
        """Mark an uncalled number by mistake; return the number and whether a line is complete."""
        open_cells = [c for c in self.cell.values() if not (self.marked | self.called) >> c & 1]
        if not open_cells:
            return None
        cell = open_cells[int(uniform() * len(open_cells))]
        return self.numbers[cell], self.mark(cell)

    def judged(self, states: tuple[CardState, ...]) -> str:
        """Return the user activity state of the card."""
        return judge(states, self.deck, self.marked, self.called)


def waiting_calls(uniform: Callable[[], float], chance: float) -> int:
    """Draw the number of calls until an event of this probability per call (geometric)."""
    if chance <= 0:
        return 1_000_000_000
    if chance >= 1:
        return 1
    return 1 + int(log(1 - uniform()) / log(1 - chance))


def waiting_time(uniform: Callable[[], float], rate: float) -> float:
    """Draw the time until an event of this rate (exponential), in s for a rate in 1/s."""
    return -log(1 - uniform()) / rate if rate > 0 else 1e18
