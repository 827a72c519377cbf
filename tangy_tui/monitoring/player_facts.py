"""Players' answers and counts in games of activities declared by facts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.memory import GameMemory
from tangy_profiles.declared.model import Declaration, Fact
from tangy_tui.monitoring.replay import Done, GameReplay, Unclear


@dataclass(frozen=True, slots=True)
class PlayerAct:
    """A person set a fact: when (ISO 8601), to which value, and at which item.

    `round` counts the items of the game from 1 (0 before the first); `item` is the item's first
    column.
    """

    at: str
    person: str
    fact: str
    value: str
    round: int
    item: str

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "at": self.at,
            "person": self.person,
            "fact": self.fact,
            "value": self.value,
            "round": self.round,
            "item": self.item,
        }


@dataclass(frozen=True, slots=True)
class PlayerFacts:
    """A game's answers in order, and each person's counts at its end."""

    game: str
    people: tuple[str, ...]
    facts: tuple[Fact, ...]
    """The facts that players set, each for themselves."""
    counts: Mapping[str, Mapping[str, int]]
    """Fact -> person -> count, for every person."""
    acts: tuple[PlayerAct, ...]
    unclear: Mapping[str, int]
    """How often each person's answer was unclear."""

    def of(self, person: str, fact: Fact) -> dict[str, int]:
        """Return how often a person set each value of a fact, in the fact's order."""
        found = Counter(
            act.value for act in self.acts if (act.person, act.fact) == (person, fact.name)
        )
        return {value: found[value] for value in fact.values if found[value]}

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON."""
        return {
            "game": self.game,
            "counts": {fact: dict(numbers) for fact, numbers in self.counts.items()},
            "acts": [act.to_json() for act in self.acts],
            "unclear": dict(self.unclear),
        }


def player_facts(replays: Sequence[GameReplay]) -> list[PlayerFacts]:
    """Read the games of activities by facts; skip those without player facts."""
    found = [
        _facts_of(replay, replay.activity.declaration)
        for replay in replays
        if isinstance(replay.activity, DeclaredActivity)
    ]
    return [one for one in found if one.counts or one.acts]


def _facts_of(replay: GameReplay, declaration: Declaration) -> PlayerFacts:
    steps = [(moment.at, moment.what) for moment in replay.moments if isinstance(moment.what, Done)]
    last = next((done.memory for _, done in reversed(steps) if done.memory is not None), None)
    own = [f for f in declaration.facts.values() if f.per_player and not f.built_in]
    brought = tuple(fact for fact in own if fact.sources and fact.kind != "count")
    people, counts = replay.game.people, dict[str, Mapping[str, int]]()
    if last is not None:
        ended = {(fact, whose): int(number) for fact, whose, number in last.counts}
        counts = {
            fact.name: {person: ended.get((fact.name, person), 0) for person in people}
            for fact in own
            if fact.kind == "count"
        }
    unclear = Counter(m.what.person for m in replay.moments if isinstance(m.what, Unclear))
    acts = tuple(_acts(steps, declaration, {fact.name for fact in brought}))
    return PlayerFacts(replay.game.id, people, brought, counts, acts, unclear)


def _acts(
    steps: Sequence[tuple[str, Done]], declaration: Declaration, facts: set[str]
) -> Iterator[PlayerAct]:
    """Yield the facts that people set, step by step.

    A value that lasts over several steps is one act, unless a step cleared the fact in between.
    """
    before = dict[tuple[str, str], str]()
    for at, done in steps:
        memory = done.memory
        if memory is None:
            continue
        now = {(fact, whose): value for fact, whose, value in memory.values if fact in facts}
        cleared = _cleared(done, declaration)
        for (fact, person), value in now.items():
            anew = fact in cleared and done.target in (None, person)
            if value != declaration.facts[fact].values[0] and (
                anew or before.get((fact, person)) != value
            ):
                yield PlayerAct(at, person, fact, value, memory.round, _item(declaration, memory))
        before = now


def _cleared(done: Done, declaration: Declaration) -> set[str]:
    behaviour = declaration.behaviours.get(done.behaviour)
    if behaviour is None or not done.completed:
        return set()
    return behaviour.clears


def _item(declaration: Declaration, memory: GameMemory) -> str:
    """Return the first column of the current item; "" before the first."""
    items = declaration.items
    if not items.columns or not 0 < memory.round <= len(memory.order):
        return ""
    return items.value(memory.order[memory.round - 1], items.columns[0])
