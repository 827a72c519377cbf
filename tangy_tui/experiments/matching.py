"""Matching of diagnoses to induced faults: right, wrong, repeated, missed, or false."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from tangy_tui.experiments.induced import Induced
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.scoring import seconds_to_recover as seconds_to_recover

RIGHT, AGAIN, WRONG, NOTHING = "right", "again", "wrong cause", "no cause"
"""Verdicts: the right cause; the same fault again; a wrong cause; no cause (a false alarm)."""


@dataclass(frozen=True)
class DiagnosisMatch:
    """A diagnosis, its verdict, and the induced fault it was matched to."""

    fault: Fault
    verdict: str
    induced: Induced | None


@dataclass
class MatchCounts:
    """All diagnoses of a game, and the induced faults that were never diagnosed."""

    matches: list[DiagnosisMatch] = field(default_factory=list)
    missed: list[Induced] = field(default_factory=list)
    asked: int = 0
    """How often Tangy only asked what to do in an unknown situation."""

    def of(self, induced: Induced) -> list[DiagnosisMatch]:
        """Return the diagnoses of one induced fault."""
        return [match for match in self.matches if match.induced is induced]

    @property
    def false_alarms(self) -> int:
        """How many diagnoses had no cause."""
        return sum(match.verdict == NOTHING for match in self.matches)


def match_faults(induced: Sequence[Induced], faults: Sequence[Fault]) -> MatchCounts:
    """Match each diagnosis of a game to an induced fault that was present at that step.

    An induced fault is present until it is removed or the game ends. The code of its kind is the
    right diagnosis. Any other diagnosis, while one is still undiagnosed, is a wrong diagnosis of
    that one.
    """
    found = MatchCounts()
    known: list[Induced] = []
    for fault in faults:
        if fault.asks_only:
            found.asked += 1
            continue
        there = [
            one
            for one in induced
            if one.step <= fault.step and (one.lifted is None or fault.step <= one.lifted)
        ]
        unknown = [one for one in there if one not in known]
        new = [one for one in unknown if one.kind.code == fault.code]
        same = [one for one in there if one.kind.code == fault.code]
        if new:
            known.append(new[0])
            found.matches.append(DiagnosisMatch(fault, RIGHT, new[0]))
        elif same:
            found.matches.append(DiagnosisMatch(fault, AGAIN, same[-1]))
        elif unknown:
            found.matches.append(DiagnosisMatch(fault, WRONG, unknown[-1]))
        else:
            found.matches.append(DiagnosisMatch(fault, NOTHING, None))
    found.missed = [one for one in induced if one not in known and one.could_show]
    return found
