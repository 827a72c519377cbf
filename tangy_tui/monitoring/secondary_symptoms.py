"""Secondary symptoms of a fault: devices that have not recovered since.

A lost link makes all devices behind it fail, and they recover some time after the link: a camera
reopens its stream, a scanner has to turn once. Until then their symptoms are explained by the link.
A device that does not recover in time is a fault of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

from tangy_profiles.faults import Evidence, FaultBook, FaultRule
from tangy_profiles.health import ERROR, STALE, Fact
from tangy_tui.monitoring.diagnosis import Diagnosis, diagnose

GRACE_SECONDS = 5.0
"""The time (s) devices have to recover after the cause has ended; cameras took up to 2.5 s."""


@dataclass
class _Cause:
    """A fault that made devices fail: those not yet recovered, and when the fault ended."""

    rule: FaultRule
    missed: set[str]
    over_since: float | None = None


class SecondarySymptoms:
    """Removes symptoms that an earlier fault explains; call `begin` for each game."""

    def __init__(self, book: FaultBook, devices: Iterable[str]) -> None:
        """Prepare for a robot.

        Args:
            book: the fault rules.
            devices: the names of the robot's devices.
        """
        self._book = book
        self._devices = tuple(devices)
        self._causes: dict[str, _Cause] = {}

    def begin(self) -> None:
        """Reset for a new game."""
        self._causes.clear()

    def end(self, code: str) -> bool:
        """Stop a fault from explaining symptoms; return whether it still did."""
        return self._causes.pop(code, None) is not None

    def without(self, evidence: Evidence, clock: Callable[[], float]) -> Evidence:
        """Return the evidence without the symptoms that an earlier fault explains.

        Args:
            evidence: the current evidence.
            clock: returns the world's time, in s.
        """
        explained: set[str] = set()
        for code, cause in list(self._causes.items()):
            if cause.rule.matched(evidence) is not None:
                cause.over_since = None
                continue  # the fault itself is still there
            now = clock()
            cause.over_since = now if cause.over_since is None else min(cause.over_since, now)
            cause.missed = {name for name in cause.missed if self._is_missed(name, cause, evidence)}
            if not cause.missed or now - cause.over_since > GRACE_SECONDS:
                del self._causes[code]
                continue
            explained |= {
                key for key in cause.rule.symptoms if key.partition(".")[0] in cause.missed
            }
        if not explained:
            return evidence
        return {key: value for key, value in evidence.items() if key not in explained}

    def take(self, found: Iterable[Diagnosis], evidence: Evidence) -> None:
        """Record the devices that new faults made fail."""
        for diagnosis in found:
            rule = diagnosis.rule
            missed = {
                name
                for name in self._devices
                if name not in rule.devices and _is_gone(name, evidence, rule.symptoms)
            }
            if missed:
                cause = self._causes.setdefault(diagnosis.rule.code, _Cause(diagnosis.rule, set()))
                cause.missed |= missed

    def _is_missed(self, name: str, cause: _Cause, evidence: Evidence) -> bool:
        """Return whether a device that a cause explains still has a symptom."""
        mine: Mapping[str, Fact] = {
            key: value for key, value in evidence.items() if key.partition(".")[0] == name
        }
        symptoms = cause.rule.symptoms
        return any(symptoms & one.evidence.keys() for one in diagnose(self._book, mine))


def _is_gone(name: str, evidence: Evidence, explained: Collection[str]) -> bool:
    state = f"{name}.state"
    return state in explained and evidence.get(state) in (STALE, ERROR)
