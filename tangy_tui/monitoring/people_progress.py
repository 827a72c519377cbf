"""People's responses in a session: requests by strategy, and the beliefs before and after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime
from typing import Any

from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.persuading import PAPER, PersuasionConfig
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.memory import PersonModel, PersonModels, counted, replayed
from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.replay import GameReplay, activities_of

RESULTS = ("complied", "late", "refused", "void", "awaited")
"""Outcomes of a request: the counts of `Attempts`."""


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
class MethodProgress:
    """One person's requests in the activities of a session that use the same method.

    `activities` are their titles, `chosen` is the method's configuration, and `strategies` the
    results. The beliefs are those of that method, which all responses in this world count in.
    """

    activities: tuple[str, ...]
    chosen: PersuasionConfig
    strategies: Mapping[str, Attempts]

    @property
    def interactions(self) -> int:
        """How often the person was asked for something."""
        return sum(one.used for one in self.strategies.values())

    def to_json(self) -> dict[str, Any]:
        """Return the activities, the method, and the results."""
        return {
            "activities": list(self.activities),
            "method": asdict(self.chosen),
            "strategies": {s: one.to_json() for s, one in self.strategies.items()},
        }


@dataclass(frozen=True, slots=True)
class Progress:
    """One person in a session: their results with each method."""

    id: str
    name: str
    methods: tuple[MethodProgress, ...]

    @property
    def strategies(self) -> Mapping[str, Attempts]:
        """The results of each strategy over all methods; the beliefs are of the last one used."""
        found: dict[str, Attempts] = {}
        for strategy in dict.fromkeys(s for one in self.methods for s in one.strategies):
            every = [one.strategies[strategy] for one in self.methods if strategy in one.strategies]
            found[strategy] = _added([one for one in every if one.used] or every[:1])
        return found

    @property
    def interactions(self) -> int:
        """How often the person was asked for something."""
        return sum(one.interactions for one in self.methods)

    def total(self, what: str) -> int:
        """Sum one of the counts over the strategies."""
        return sum(getattr(a, what) for one in self.methods for a in one.strategies.values())

    def to_json(self) -> dict[str, Any]:
        """Return the person with the results, over all methods and by method."""
        return {
            "id": self.id,
            "name": self.name,
            "interactions": self.interactions,
            "strategies": {s: one.to_json() for s, one in self.strategies.items()},
            "methods": [one.to_json() for one in self.methods],
        }


def _added(every: Sequence[Attempts]) -> Attempts:
    counts = {what: sum(getattr(one, what) for one in every) for what in RESULTS}
    return Attempts(**counts, before=every[-1].before, after=every[-1].after)


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
    groups: dict[PersuasionConfig, list[GameReplay]] = {}
    for replay in [r for r in replays if r.persuades] or replays:
        groups.setdefault(_chosen(replay), []).append(replay)
    world, asking = replays[-1].game.world, [r for group in groups.values() for r in group]
    models = [
        (PersonModels(store, _strategies(group), chosen, world=world), group)
        for chosen, group in groups.items()
    ]
    every = PersonModels(store, _strategies(asking), next(iter(groups)), world=world)
    responses = every.responses()
    found = []
    for person in present:
        own = every.feedback.method(person) is not None  # it holds in all activities
        history = every.history(person)
        parts = [
            _with_method(person, model.recall(person, responses), history, replays, group, said)
            for model, group in ([(every, asking)] if own else models)
        ]
        found.append(Progress(person, names.get(person, person), tuple(parts)))
    return tuple(found)


def _chosen(replay: GameReplay) -> PersuasionConfig:
    return PAPER if replay.activity is None else replay.activity.persuasion


def _strategies(replays: Sequence[GameReplay]) -> tuple[str, ...]:
    """Return the strategies of some games; of an unknown activity, those that were used."""
    known = [s for one in activities_of(replays) for s in one.strategies]
    used = [a.strategy for r in replays if r.activity is None for _, a in r.answers]
    return tuple(dict.fromkeys([*known, *used]))


def _with_method(
    person: str,
    known: PersonModel,
    history: Sequence[FeedbackEntry],
    replays: Sequence[GameReplay],
    asking: Sequence[GameReplay],
    said: Mapping[str, bool | None],
) -> MethodProgress:
    """Count the results of each strategy, and compute the beliefs before and after.

    Corrections made later apply: a response that was voided counts in neither belief.

    Args:
        person: the id of the person.
        known: the model by the method of these games.
        history: all requests to the person.
        replays: the games of the session.
        asking: those of them in which this method is used.
        said: whether a response followed too late, by the id of the request.
    """
    games = {replay.game.id for replay in replays}
    own = {replay.game.id for replay in asking}
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
        if entry.game not in own or one is None or entry.settled:
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
    titles = tuple(dict.fromkeys(replay.title for replay in asking))
    return MethodProgress(titles, known.chosen, found)


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
