"""People's responses in a session: requests by strategy, and the beliefs before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.persuading import PAPER
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.memory import PersonModel, PersonModels, counted, replayed
from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.replay import GameReplay, activities_of

RESULTS = (
    ("complied", "did it"),
    ("late", "did it late"),
    ("refused", "would rather not"),
    ("void", "void"),
    ("awaited", "without an answer"),
)
"""Outcomes of a request: the counts of `Attempts`, and their words."""


@dataclass
class Attempts:
    """Results of one strategy with one person: its uses, and the responses.

    `late`: followed too late to count as complied. `void` ones do not count in the belief,
    `awaited` ones have no answer yet. `before` and `after` are the beliefs.
    """

    complied: int = 0
    late: int = 0
    refused: int = 0
    void: int = 0
    awaited: int = 0
    before: Beta = field(default_factory=Beta)
    after: Beta = field(default_factory=Beta)

    @property
    def used(self) -> int:
        """How often the strategy was used in the session."""
        return self.complied + self.late + self.refused + self.void + self.awaited

    @property
    def in_words(self) -> str:
        """The results in words: "2 complied, 1 without an answer"."""
        return result_words({what: getattr(self, what) for what, _ in RESULTS})

    def to_json(self) -> dict[str, Any]:
        """Return the counts, and the beliefs with mean and interval."""
        return {
            "used": self.used,
            "complied": self.complied,
            "late": self.late,
            "not": self.refused,
            "void": self.void,
            "awaited": self.awaited,
            "before": _belief(self.before),
            "after": _belief(self.after),
        }


@dataclass(frozen=True, slots=True)
class Progress:
    """One person in a session: strategy -> results."""

    id: str
    name: str
    strategies: Mapping[str, Attempts]

    @property
    def interactions(self) -> int:
        """How often the person was asked for something."""
        return sum(one.used for one in self.strategies.values())

    def total(self, what: str) -> int:
        """Sum one of the counts over the strategies."""
        return sum(getattr(one, what) for one in self.strategies.values())

    @property
    def in_words(self) -> str:
        """The results of all requests, over the strategies."""
        return result_words({what: self.total(what) for what, _ in RESULTS})


def result_words(counts: Mapping[str, int]) -> str:
    """Format the outcomes of requests in words, without zero counts."""
    return ", ".join(f"{counts[what]} {words}" for what, words in RESULTS if counts[what])


def people_progress(
    store: Store,
    replays: Sequence[GameReplay],
    names: Mapping[str, str],
) -> tuple[Progress, ...]:
    """Return the people of some games of one world, with their responses.

    Args:
        store: the log.
        replays: the games.
        names: people's names, by id.
    """
    present = tuple(attention(replays))  # without those who were away for all games
    if not present:
        return ()
    said = {a.uuid: a.followed for replay in replays for _, a in replay.answers}
    known = activities_of(replays)
    used = [a.strategy for r in replays if r.activity is None for _, a in r.answers]
    strategies = dict.fromkeys([*(s for one in known for s in one.strategies), *used])
    asking = [r.activity.persuasion for r in replays if r.activity is not None and r.persuades]
    chosen = asking[0] if asking else PAPER
    memory = PersonModels(store, tuple(strategies), chosen, world=replays[-1].game.world)
    responses = memory.responses()
    return tuple(
        _progress(
            person,
            names.get(person, person),
            memory.recall(person, responses),
            memory.history(person),
            replays,
            said,
        )
        for person in present
    )


def _progress(
    person: str,
    name: str,
    known: PersonModel,
    history: Sequence[FeedbackEntry],
    replays: Sequence[GameReplay],
    said: Mapping[str, bool | None],
) -> Progress:
    """Count the results of each strategy, and compute the beliefs before and after.

    Corrections made later apply: a response that was voided counts in neither belief.
    """
    games = {replay.game.id for replay in replays}
    first, last = replays[0].game, replays[-1].game
    asked = {entry.request: entry.seq for entry in history if entry.request == entry.uuid}
    before = [e for e in history if asked.get(e.request, e.seq) < first.seq]
    after = [
        e for e in history
        if last.last_seq is None or asked.get(e.request, e.seq) <= last.last_seq or e.game in games
    ]  # fmt: skip
    until = last.ended or max((entry.at for entry in after), default=last.at)
    old = _beliefs(known, person, before, first.at)
    new = _beliefs(known, person, after, until)
    found = {s: Attempts(before=old[s], after=new[s]) for s in known.beliefs}
    for entry in history:
        one = found.get(entry.strategy)
        if entry.game not in games or one is None or entry.settled:
            continue  # another entry has the answer to this request
        if entry.void:
            one.void += 1
        elif entry.complied is None:
            one.awaited += 1
        elif entry.complied:
            one.complied += 1
        elif said.get(entry.uuid):
            one.late += 1
        else:
            one.refused += 1
    return Progress(person, name, found)


def _beliefs(
    known: PersonModel, person: str, entries: Sequence[FeedbackEntry], now: datetime
) -> Beliefs:
    if known.method.forgets:
        return replayed(known.method, known.prior, entries, now)
    counts: dict[tuple[str, str], tuple[int, int]] = {}
    for entry in entries:
        if entry.counts:
            yes, no = counts.get((person, entry.strategy), (0, 0))
            complied = bool(entry.complied)
            counts[person, entry.strategy] = (yes + complied, no + (not complied))
    return counted(known.prior, person, counts)


def _belief(belief: Beta) -> dict[str, Any]:
    return {
        "alpha": belief.alpha,
        "beta": belief.beta,
        "mean": belief.mean,
        "interval": list(belief.interval()),
    }
