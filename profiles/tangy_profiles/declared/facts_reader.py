"""Reads the facts of an activity's file."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from tangy_profiles.declared.conditions import LARGEST, Phrasing
from tangy_profiles.declared.model import Fact, FactCondition
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.vocabulary import (
    BUILT_IN,
    HERE,
    ITEMS,
    KINDS,
    NO,
    QUANTIFIERS,
    SOURCES,
    YES,
    Kind,
    Source,
)
from tangy_profiles.reading import nearest

ATTENTION = "attention"
KEYS = ("kind", "values", "per", "bands", "from", "options", "checks", "when", "steps", ATTENTION)
MOST_FACTS, MOST_VALUES = 60, 20
JUDGED_VALUES = 3
"""The values of a judged fact: no answer, a right one, a wrong one."""


def read_facts(top: Section, columns: Sequence[str]) -> dict[str, Fact]:
    """Read the flags and the facts of a file, with the built-in ones.

    Args:
        top: the file.
        columns: the columns of the items.
    """
    facts = {
        name: Fact(name, "choice", values, per_player=name != ITEMS, built_in=True)
        for name, values in BUILT_IN.items()
    }
    for name in top.texts("flags"):
        if _free(top, "flags", name, facts):
            facts[name] = Fact(name, "flag", (NO, YES))
    declared = top.table("facts")
    for name in declared:
        if _free(declared, name, name, facts):
            facts[name] = _read_fact(declared.table(name), name, columns)
    if len(facts) > MOST_FACTS:
        top.wrong("facts", f"there can be {MOST_FACTS} at most")
    known: dict[str, Fact] = {name: fact for name, fact in facts.items() if fact.kind != "test"}
    for name, fact in facts.items():
        if fact.kind == "test":
            known[name] = facts[name] = _read_test(declared.table(name), fact, Phrasing(known))
    return facts


def read_words(top: Section, facts: dict[str, Fact]) -> dict[str, Fact]:
    """Read the words for the values of facts: for each fact one text per value."""
    section = top.table("words")
    named = dict(facts)
    for name in section:
        if name not in facts:
            section.wrong(name, f"{name!r} is not a fact; {nearest(name, facts)}", name)
            continue
        values, words = facts[name].values, section.texts(name)
        if words and len(words) != len(values):
            needed = f"must hold {len(values)} texts: for {', '.join(values)}"
            section.wrong(name, needed if values else "is a number: give it bands first")
        else:
            named[name] = replace(facts[name], words=words)
    return named


def _free(section: Section, key: str, name: str, facts: dict[str, Fact]) -> bool:
    if name in facts:
        built = "is built in" if facts[name].built_in else "stands here twice"
        section.wrong(key, f"the fact {name!r} {built}", name)
        return False
    words = name.split()
    if name == HERE:
        section.wrong(key, f"the fact {name!r} is built in", name)
        return False
    if (
        " ".join(words) != name
        or not words
        or any(f"{name} ".startswith(f"{one} ") for one in QUANTIFIERS)
    ):
        section.wrong(key, f"{name!r} cannot be the name of a fact", name)
        return False
    if {"is", "if", ">=", "<"} & set(words):
        section.wrong(key, f"{name!r} holds a word that conditions are made with", name)
        return False
    return True


def _read_fact(section: Section, name: str, columns: Sequence[str]) -> Fact:
    section.only(*KEYS)
    usual = "choice" if "values" in section else "flag"
    usual = "test" if "when" in section or "steps" in section else usual
    kind = cast(Kind, section.word("kind", KINDS, usual))
    per_player = "per" in section
    if per_player:
        section.word("per", ("player",))
    bands = section.wholes("bands", 1, LARGEST)
    if bands and kind not in ("count", "timer"):
        section.wrong("bands", "only a count or a timer has bands")
    sources = section.texts("from", single=True)
    for one in sources:
        if one not in SOURCES:
            section.wrong("from", f"{one!r} is not known; {nearest(one, SOURCES)}", one)
    for key in ("when", "steps"):
        if key in section and kind != "test":
            section.wrong(key, "only a test has conditions")
    fact = Fact(
        name,
        kind,
        _values(section, kind, bands),
        per_player=per_player,
        bands=bands,
        sources=cast(tuple[Source, ...], tuple(one for one in sources if one in SOURCES)),
        options=_columns(section, "options", columns),
        checks=(_columns(section, "checks", columns) or ("",))[0],
    )
    fact = replace(fact, attention=_attention(section, fact))
    if "checks" in section and len(fact.values) != JUDGED_VALUES:
        problem = "an answer that is checked needs 3 values: none, right and wrong"
        section.wrong("values" if "values" in section else "checks", problem)
    if "options" in section and "checks" not in section:
        section.wrong("options", "these have no use without 'checks'")
    return fact


def _values(section: Section, kind: Kind, bands: Sequence[int]) -> tuple[str, ...]:
    if "values" in section and kind != "choice":
        section.wrong("values", f"a {kind} has no values of its own")
    match kind:
        case "flag" | "test":
            return (NO, YES)
        case "count" | "timer":
            if not bands:
                return ()
            middle = [
                f"{low}-{high - 1}" if high - low > 1 else str(low)
                for low, high in itertools.pairwise(bands)
            ]
            return (f"<{bands[0]}", *middle, f">={bands[-1]}")
        case "choice":
            values = section.texts("values")
            if not 2 <= len(set(values)) == len(values) <= MOST_VALUES:
                section.wrong("values", f"must be from 2 to {MOST_VALUES} texts, each another")
            return values or (NO, YES)


def _attention(section: Section, fact: Fact) -> tuple[str, ...]:
    """Read the values of a person's fact that the report names under what to look after."""
    values = section.texts(ATTENTION, single=True)
    if values and not (fact.per_player and fact.sources and fact.kind in ("choice", "flag")):
        section.wrong(ATTENTION, "only values that people bring about, with 'per' and 'from'")
        return ()
    for one in values:
        if one not in fact.values:
            section.wrong(ATTENTION, f"{one!r} is not a value; {nearest(one, fact.values)}", one)
    return values


def _columns(section: Section, key: str, columns: Sequence[str]) -> tuple[str, ...]:
    named = section.texts(key, single=True)
    for one in named:
        if one not in columns:
            near = nearest(one, columns)
            section.wrong(key, f"{one!r} is not a column of the items; {near}", one)
    if key == "checks" and len(named) > 1:
        section.wrong(key, "must name one column")
    return tuple(one for one in named if one in columns)


def _read_test(section: Section, fact: Fact, phrasing: Phrasing) -> Fact:
    tests: list[tuple[str, tuple[FactCondition, ...]]] = []
    if "steps" in section:
        steps = section.table("steps")
        tests = [(value, phrasing.conditions(steps, value)) for value in steps]
        if len(tests) < 2:
            section.wrong("steps", "must hold at least 2 values, each with its conditions")
            return fact
        if "when" in section:
            section.wrong("when", "give either 'when' or 'steps'")
        values = tuple(value for value, _ in tests)
    else:
        conditions = phrasing.conditions(section, "when")
        if not conditions:
            section.wrong("when", "must hold at least 1 condition")
        tests, values = [(YES, conditions)], (NO, YES)
    per_player = any(
        not one.quantifier and phrasing.facts[one.fact].per_player
        for _, conditions in tests
        for one in conditions
    )
    return replace(fact, values=values, tests=tuple(tests), per_player=per_player)
