"""A declared activity, parsed and checked: facts, items, stages, behaviours, people."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

from tangy_profiles.declared.table_text import ReadAs
from tangy_profiles.declared.vocabulary import (
    ADDRESSED,
    Comparison,
    Does,
    Kind,
    Order,
    Quantifier,
    Selector,
    Source,
    Turns,
)

PAUSE_SECONDS = 8.0
"""The time (s) after a behaviour in which people can act."""


@dataclass(frozen=True, slots=True)
class FactCondition:
    """One condition: `[QUANTIFIER] FACT is|is not VALUE`, `FACT >= N` or `FACT < N`."""

    quantifier: Quantifier
    fact: str
    comparison: Comparison
    value: str
    number: int = 0
    """The operand of >= or <."""


@dataclass(frozen=True, slots=True)
class Fact:
    """A variable of a game.

    `values` are its values for conditions and the policy: for a count or a timer its bands. `tests`
    has the conditions for each value of a test; the last one that holds counts.
    """

    name: str
    kind: Kind
    values: tuple[str, ...]
    per_player: bool = False
    bands: tuple[int, ...] = ()
    sources: tuple[Source, ...] = ()
    options: tuple[str, ...] = ()
    """The columns of the items with the answers to choose from."""
    checks: str = ""
    """The column of the items with the right answer, with synonyms separated by bars."""
    tests: tuple[tuple[str, tuple[FactCondition, ...]], ...] = ()
    built_in: bool = False
    words: tuple[str, ...] = ()
    """The words for each of the values (): made from the names."""
    attention: tuple[str, ...] = ()
    """The values after which staff should look after the person."""

    def band(self, number: float) -> str:
        """Return the band of a count, or of a timer's number of s."""
        place = sum(number >= bound for bound in self.bands)
        return self.values[place]


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect of a behaviour, if its conditions hold."""

    does: Does
    fact: str = ""
    value: str = ""
    number: int = 1
    conditions: tuple[FactCondition, ...] = ()


@dataclass(frozen=True, slots=True)
class Stage:
    """A stage; the first one whose conditions hold is the current one."""

    name: str
    when: tuple[FactCondition, ...]
    about: Selector
    sees: tuple[str, ...]
    words: str = ""
    """A description for people; {name} is the person of the stage ("": made from the name)."""


class MediaFile(NamedTuple):
    """A picture, or a sound of this many s: the path of its file."""

    path: str
    seconds: float = 0.0


@dataclass(frozen=True, slots=True)
class DeclaredBehaviour:
    """A declared behaviour: its effects, its persons, and its texts."""

    name: str
    effects: tuple[Effect, ...]
    needs: tuple[FactCondition, ...]
    to: tuple[Selector, ...]
    says: Mapping[str, tuple[str, ...]]
    """The texts by persuasive strategy, each list used in turn."""
    phrases: tuple[str, ...]
    question: str
    posture: str
    image: str
    """The text of the chest screen ("": it stays as it is, see `DeclaredGame.screen`)."""
    wordings: tuple[str, ...] = ()
    """Other wordings: training data for understanding, but not for speech recognition."""
    again: tuple[str, ...] = ()
    """The texts that repeat the question, in order, if a person does not answer."""
    picture: str = ""
    """The name of a picture file, perhaps with columns of the items as slots ("": none)."""
    sound: str = ""
    """The name of a sound file, likewise."""
    pause: float = PAUSE_SECONDS
    """For how many s Tangy waits after it, unless people act."""

    @property
    def invites(self) -> bool:
        """Whether it asks a person to do something that they may refuse."""
        return any(effect.does == "invite" for effect in self.effects)

    @property
    def visits(self) -> bool:
        """Whether the robot goes to a person."""
        return any(effect.does == "go to whom" for effect in self.effects)

    @property
    def passes_turn(self) -> bool:
        """Whether it lets the next player have the turn."""
        return any(effect.does == "next turn" for effect in self.effects)

    @property
    def clears(self) -> set[str]:
        """The names of the facts that it clears."""
        return {effect.fact for effect in self.effects if effect.does == "clear"}

    @property
    def needs_item(self) -> bool:
        """Whether it presents the next item, whatever the facts are."""
        return any(one.does == "next item" and not one.conditions for one in self.effects)


@dataclass(frozen=True, slots=True)
class Habit:
    """A habit of simulated people: when, with which chance, and to which values they set a fact."""

    fact: str
    when: tuple[FactCondition, ...]
    chance: float
    weights: tuple[tuple[str, float], ...]
    last: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Expectation:
    """One line of a test's expected behaviours; the first that matches counts."""

    stage: str
    conditions: tuple[FactCondition, ...]
    behaviour: str
    to: Selector | None = None


@dataclass(frozen=True, slots=True)
class Items:
    """The rows of the items file, and the number and order of those used in a game."""

    columns: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    order: Order = "given"
    rounds: int = 0
    file: str = ""

    def value(self, row: int, column: str) -> str:
        """Return the cell of a row and column ("": there is no such row)."""
        if not 0 <= row < len(self.rows):
            return ""
        return self.rows[row][self.columns.index(column)]


@dataclass(frozen=True)
class Declaration:
    """A whole activity as declared in its file."""

    name: str
    title: str
    source: str
    facts: Mapping[str, Fact]
    stages: tuple[Stage, ...]
    behaviours: Mapping[str, DeclaredBehaviour]
    items: Items = Items()
    teams: tuple[str, ...] = ()
    turns: Turns = "in order"
    habits: tuple[Habit, ...] = ()
    expected: tuple[Expectation, ...] = ()
    strategies: Mapping[str, str] = field(default_factory=dict)
    plain_strategy: str = ""
    patience: float = 10.0
    summary: str = ""
    """For how many people it is, how long it takes, and what is needed."""
    media: Mapping[str, MediaFile] = field(default_factory=dict)
    """The pictures and sounds, by file name."""
    tables: tuple[ReadAs, ...] = ()
    """How the tables beside the file were read."""
    whose: Mapping[Selector, FactCondition] = field(default_factory=dict)
    """The conditions of the selectors that have one."""
    pronunciations: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def bounds_of(self, fact: Fact) -> tuple[int, ...]:
        """Return the ascending limits that divide a count or a timer (in s) into bands."""
        numbers = {
            one.number
            for one in self.conditions
            if one.fact == fact.name and one.comparison in (">=", "<")
        }
        return tuple(sorted(numbers.union(fact.bands)))

    @cached_property
    def takes_turns(self) -> bool:
        """Whether players take turns."""
        return any(behaviour.passes_turn for behaviour in self.behaviours.values())

    @cached_property
    def most_counted(self) -> int:
        """The highest number that a count is compared with."""
        counts = [fact for fact in self.facts.values() if fact.kind == "count"]
        return max((bound for fact in counts for bound in self.bounds_of(fact)), default=0)

    @cached_property
    def looked_at(self) -> tuple[tuple[Fact, tuple[int, ...]], ...]:
        """The facts that change and are used anywhere, with their bounds."""
        names = {one.fact for one in self.conditions}
        names.update(name for stage in self.stages for name in stage.sees)
        return tuple(
            (fact, self.bounds_of(fact))
            for fact in self.facts.values()
            if fact.name in names and not fact.built_in and fact.kind != "test"
        )

    @cached_property
    def remembers_addressed(self) -> bool:
        """Whether the last addressed person matters."""
        looked = any(one.fact == ADDRESSED for one in self.conditions)
        seen = any(ADDRESSED in stage.sees for stage in self.stages)
        return looked or seen or bool(self.selectors & {"addressed", "next in circle"})

    @cached_property
    def conditions(self) -> tuple[FactCondition, ...]:
        """Every condition of the file, except the expectations of tests."""
        found: list[FactCondition] = []
        for stage in self.stages:
            found += stage.when
        for fact in self.facts.values():
            for _, conditions in fact.tests:
                found += conditions
        for behaviour in self.behaviours.values():
            found += behaviour.needs
            for effect in behaviour.effects:
                found += effect.conditions
        for habit in self.habits:
            found += habit.when
        return (*found, *self.whose.values())

    @cached_property
    def reasons(
        self,
    ) -> tuple[tuple[Habit, tuple[tuple[FactCondition, ...], tuple[FactCondition, ...]]], ...]:
        """Each habit with its conditions: those of the group, and those of each player."""
        found = []
        for habit in self.habits:
            own = tuple(
                one for one in habit.when if not one.quantifier and self._is_own(one.fact, set())
            )
            group = tuple(one for one in habit.when if one not in own)
            found.append((habit, (group, own)))
        return tuple(found)

    @cached_property
    def last_acts(self) -> frozenset[tuple[str, str]]:
        """The facts with the values that end a game."""
        return frozenset((habit.fact, value) for habit in self.habits for value in habit.last)

    def _is_own(self, name: str, met: set[str]) -> bool:
        """Return whether a fact may differ between players."""
        fact = self.facts[name]
        if fact.kind != "test" or fact.per_player:
            return fact.per_player
        if name in met:
            return False
        met.add(name)
        conditions = (one for _, conditions in fact.tests for one in conditions)
        return any(not one.quantifier and self._is_own(one.fact, met) for one in conditions)

    @cached_property
    def selectors(self) -> frozenset[Selector]:
        """The selectors that the file uses."""
        found = {stage.about for stage in self.stages}
        for behaviour in self.behaviours.values():
            found.update(behaviour.to)
        return frozenset(found)

    def stage(self, name: str) -> Stage:
        """Return a stage by its name.

        Raises:
            KeyError: there is no such stage.
        """
        for stage in self.stages:
            if stage.name == name:
                return stage
        raise KeyError(name)
