"""Faults on the bench: the kinds of `tangy_sim.worlds.injection`, injected into devices.

This module only records each fault, its device and its start; each part of the bench asks for its
own kinds by name and simulates them. A test names the kinds that no part simulates.
"""

from __future__ import annotations

from dataclasses import dataclass

from tangy_sim.worlds.injection import KINDS, FaultKind

MUTE = ("voice-dead", "screen-dead")
"""Faults that end together when a lost connection returns."""
COMES_BACK = 0.5
"""P(a device works again after a restart)."""


@dataclass
class SimulatedFault:
    """An active fault: its start (s), the person it concerns, and whether it has shown."""

    kind: FaultKind
    since: float
    person: str = ""
    shown: bool = False


class Faults:
    """Faults of one game."""

    def __init__(self) -> None:
        self.present: dict[str, SimulatedFault] = {}
        self.lifted: list[SimulatedFault] = []
        """Faults that have ended and not been handled yet; the handler empties the list."""

    def __contains__(self, kind: str) -> bool:
        return kind in self.present

    def clear(self) -> None:
        """End all faults."""
        for kind in list(self.present):
            self.lift(kind)

    def inject(self, kind: str, now: float) -> SimulatedFault:
        """Start a fault at a time in s.

        Raises:
            KeyError: there is no such kind.
        """
        return self.present.setdefault(kind, SimulatedFault(KINDS[kind], now))

    def lift(self, kind: str) -> bool:
        """End a fault; return whether it was active."""
        fault = self.present.pop(kind, None)
        if fault is not None:
            self.lifted.append(fault)
        return fault is not None

    def of(self, code: str) -> list[str]:
        """Return the active kinds with a diagnosis code."""
        kinds = [name for name, fault in self.present.items() if fault.kind.code == code]
        return kinds or [kind for kind in MUTE if code == "mute" and kind in self.present]

    def helped(self, code: str) -> list[str]:
        """Return the active kinds with a diagnosis code that people at the table can fix."""
        return [kind for kind in self.of(code) if KINDS[kind].helped]

    def concerns(self, kind: str, person: str) -> bool:
        """Return whether a fault concerns a person; it is assigned to the first one asked about."""
        fault = self.present.get(kind)
        if fault is None:
            return False
        if not fault.person:
            fault.person = person
        return fault.person == person
