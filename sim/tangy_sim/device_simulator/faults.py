"""Faults on the bench: the kinds of `tangy_sim.worlds.injection`, injected into devices.

This module only records each fault, its device and its start; each part of the bench queries its
own kinds and simulates them. Kinds that cannot be injected here are recorded and reported, too.
"""

from __future__ import annotations

from dataclasses import dataclass

from tangy_sim.worlds.injection import KINDS, Kind

MUTE = ("voice-dead", "screen-dead")
"""The faults that end together when a lost connection returns."""
COMES_BACK = 0.5
"""P(a device comes back when it is started again)."""


@dataclass
class SimulatedFault:
    """A fault that is there: since when (s), with whom, and whether it has shown."""

    kind: Kind
    since: float
    person: str = ""
    shown: bool = False


class Faults:
    """The faults of one game."""

    def __init__(self) -> None:
        self.present: dict[str, SimulatedFault] = {}
        self.lifted: list[SimulatedFault] = []
        """Faults ended since the last look; the part that handles them empties it."""

    def __contains__(self, kind: str) -> bool:
        return kind in self.present

    def clear(self) -> None:
        """Put everything right."""
        for kind in list(self.present):
            self.lift(kind)

    def inject(self, kind: str, now: float) -> SimulatedFault:
        """Bring about a fault at a time in s.

        Raises:
            KeyError: there is no such kind.
        """
        return self.present.setdefault(kind, SimulatedFault(KINDS[kind], now))

    def lift(self, kind: str) -> bool:
        """Put a fault right; say whether it was there."""
        fault = self.present.pop(kind, None)
        if fault is not None:
            self.lifted.append(fault)
        return fault is not None

    def of(self, code: str) -> list[str]:
        """Return the kinds that are there of which a diagnosis is right."""
        kinds = [name for name, fault in self.present.items() if fault.kind.code == code]
        return kinds or [kind for kind in MUTE if code == "mute" and kind in self.present]

    def helped(self, code: str) -> list[str]:
        """Return the kinds that are there, and that people at the table can put right."""
        return [kind for kind in self.of(code) if KINDS[kind].helped]

    def concerns(self, kind: str, person: str) -> bool:
        """Say whether somebody is the one whom a fault is about; the first one asked becomes it."""
        fault = self.present.get(kind)
        if fault is None:
            return False
        if not fault.person:
            fault.person = person
        return fault.person == person
