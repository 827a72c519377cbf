"""Drift: change-point detection in a person's responses to a strategy.

The test is the generalised likelihood ratio test for Bernoulli samples (Besson, Kaufmann, Maillard
and Seznec 2022). After each response the responses so far are split where the two parts differ
most. The split is a change if its ratio exceeds a threshold that holds at all times.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import log

from tangy_profiles.beliefs import Beliefs, Beta

ALARM = 0.05
"""The highest probability of ever detecting a change when there is none."""

FEWEST = 8
"""With fewer responses to a strategy no split is significant."""

Counts = tuple[int, int]
"""How often a person complied, and did not."""


@dataclass(frozen=True, slots=True)
class Drift:
    """A change in a person's responses to a strategy: the counts before and after it."""

    strategy: str
    before: Counts
    after: Counts

    @property
    def worse(self) -> bool:
        """Whether the strategy works less well than before."""
        (yes, no), (now_yes, now_no) = self.before, self.after
        return now_yes * (yes + no) < yes * (now_yes + now_no)


class DriftWatch:
    """One person's responses to each strategy since its last change."""

    def __init__(self, responses: Iterable[tuple[str, bool]] = ()) -> None:
        """Start with the responses of the log, oldest first."""
        self.changes: dict[str, Drift] = {}
        """The last change of each strategy that has changed."""
        self._since: dict[str, list[bool]] = {}
        for strategy, complied in responses:
            self.add(strategy, complied)

    def add(self, strategy: str, complied: bool) -> Drift | None:
        """Add a response; return a change that it makes significant, or None."""
        since = self._since.setdefault(strategy, [])
        since.append(complied)
        at = change_point(since)
        if at is None:
            return None
        before, after = since[:at], since[at:]
        self._since[strategy] = after
        change = Drift(strategy, _counts(before), _counts(after))
        self.changes[strategy] = change
        return change

    @property
    def drifts(self) -> tuple[Drift, ...]:
        """The last change of each strategy, with its counts until now."""
        return tuple(
            Drift(name, change.before, _counts(self._since[name]))
            for name, change in self.changes.items()
        )

    def forgotten(self, beliefs: Beliefs, prior: Beliefs) -> Beliefs:
        """Return beliefs without the responses before the last change of each strategy."""
        found = dict(beliefs)
        for name in self.changes:
            if name in prior:
                yes, no = _counts(self._since[name])
                start = prior[name]
                counts = None if start.counts is None else (yes, no)
                found[name] = Beta(start.alpha + yes, start.beta + no, counts)
        return found


def change_point(responses: list[bool]) -> int | None:
    """Return the index of the first response after a change; None if none is significant."""
    n = len(responses)
    if n < FEWEST:
        return None
    total, yes = sum(responses), 0
    threshold = log(3 * n**1.5 / ALARM)
    best, at = threshold, None
    for k in range(1, n):
        yes += responses[k - 1]
        ratio = k * _divergence(yes / k, total / n) + (n - k) * _divergence(
            (total - yes) / (n - k), total / n
        )
        if ratio > best:
            best, at = ratio, k
    return at


def _divergence(p: float, q: float) -> float:
    """Return the Kullback-Leibler divergence of two Bernoulli rates, a number >= 0."""
    found = 0.0
    if p > 0:
        found += p * log(p / q)
    if p < 1:
        found += (1 - p) * log((1 - p) / (1 - q))
    return found


def _counts(responses: Iterable[bool]) -> Counts:
    listed = list(responses)
    return sum(listed), len(listed) - sum(listed)


def most_seen(counts: Mapping[tuple[str, str], Counts], person: str) -> int:
    """Return the number of a person's responses to their most frequent strategy."""
    return max((yes + no for (who, _), (yes, no) in counts.items() if who == person), default=0)
