"""Later symptoms that a fault explains: devices that have not recovered since.

A link that was lost takes all with it that is reached by it, and they do not come back at the very
moment at which it does: a camera opens its stream anew, a scanner has to turn once. Until each of
them was well once they say nothing new. For a while only: what does not come back is a fault of
its own.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass

from tangy_profiles.faults import Evidence, FaultBook, FaultRule
from tangy_profiles.health import ERROR, STALE, Fact
from tangy_tui.monitoring.diagnosis import Diagnosis, diagnose

GRACE_SECONDS = 5.0
"""From the end of a cause to when what it took along has to be back; cameras took up to 2.5 s."""


@dataclass
class _Cause:
    """A fault that took devices along: which are still missed, and since when it is over."""

    rule: FaultRule
    missed: set[str]
    over_since: float | None = None


class Aftermath:
    """Knows which symptoms an earlier fault still explains. `begin` each game."""

    def __init__(self, book: FaultBook, devices: Iterable[str]) -> None:
        """Prepare.

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
        """Let a fault explain nothing any more; return whether it still did."""
        return self._causes.pop(code, None) is not None

    def without(self, evidence: Evidence, clock: Callable[[], float]) -> Evidence:
        """Return evidence without what an earlier fault still explains.

        Args:
            evidence: the facts known at this moment.
            clock: returns the world's time, in s.
        """
        explained: set[str] = set()
        for code, cause in list(self._causes.items()):
            if cause.rule.matched(evidence) is not None:
                cause.over_since = None
                continue  # it explains them by itself
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
        """Keep which devices the faults that were found have taken along."""
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
        """Say whether something is still wrong with a device that a cause explains."""
        mine: Mapping[str, Fact] = {
            key: value for key, value in evidence.items() if key.partition(".")[0] == name
        }
        symptoms = cause.rule.symptoms
        return any(symptoms & one.evidence.keys() for one in diagnose(self._book, mine))


def _is_gone(name: str, evidence: Evidence, explained: Collection[str]) -> bool:
    state = f"{name}.state"
    return state in explained and evidence.get(state) in (STALE, ERROR)
