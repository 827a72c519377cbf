"""Parser of conditions and effects, as the interpreter uses them."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import cast

from tangy_profiles.declared.model import Effect, Fact, FactCondition
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.vocabulary import (
    DOES,
    QUANTIFIERS,
    SELECTORS,
    WHOSE,
    Comparison,
    Does,
    Quantifier,
    Selector,
)
from tangy_profiles.reading import nearest

Facts = Mapping[str, Fact]
_CONDITION = re.compile(
    rf"\s*(?:({'|'.join(QUANTIFIERS)})\s+)?(\S.*?)\s+(is\s+not|is|>=|<)\s+(\S.*?)\s*"
)
LARGEST = 9_999
ALIKE = 0.8
"""The similarity from which a word counts as a misspelt selector."""
TAKES_FACT = ("set", "add", "clear", "start", "invite")


class Phrasing:
    """Parses conditions and effects of one file; mistakes are recorded in their section."""

    def __init__(self, facts: Facts) -> None:
        """Use the facts that the file declares, and the built-in ones."""
        self.facts = facts
        self.whose: dict[Selector, FactCondition] = {}
        """The conditions of the selectors read so far that have one."""

    def conditions(self, section: Section, key: str) -> tuple[FactCondition, ...]:
        """Parse the conditions of a key; all must hold."""
        return self.all_of(section, key, section.texts(key))

    def all_of(self, section: Section, key: str, texts: Sequence[str]) -> tuple[FactCondition, ...]:
        """Parse conditions that were already read from a key."""
        found = (self.condition(section, key, text) for text in texts)
        return tuple(one for one in found if one is not None)

    def condition(self, section: Section, key: str, text: str) -> FactCondition | None:
        """Parse one condition, or record its problem."""
        match = _CONDITION.fullmatch(text)
        if match is None:
            section.wrong(key, f"{text!r} is no condition; write FACT is VALUE", text)
            return None
        quantifier, name, comparison, value = match.groups("")
        fact = self.fact(section, key, name, text)
        if fact is None:
            return None
        if quantifier and not fact.per_player:
            section.wrong(key, f"{name!r} is not a fact of each player: leave {quantifier!r}", text)
            return None
        comparison, number = " ".join(comparison.split()), 0
        if comparison in (">=", "<"):
            if fact.kind not in ("count", "timer"):
                section.wrong(key, f"{name!r} has no number to compare: write 'is'", text)
                return None
            if not (value.isdecimal() and value.isascii() and int(value[:6]) <= LARGEST):
                section.wrong(key, f"{value!r} must be a whole number up to {LARGEST}", text)
                return None
            number = int(value)
        elif value not in fact.values:
            section.wrong(key, self._no_value(fact, value), text)
            return None
        return FactCondition(
            cast(Quantifier, quantifier), name, cast(Comparison, comparison), value, number
        )

    def fact(self, section: Section, key: str, name: str, text: str) -> Fact | None:
        """Return a fact by its name, or record that there is none."""
        fact = self.facts.get(name)
        if fact is None:
            section.wrong(key, f"{name!r} is not a fact; {nearest(name, self.facts)}", text)
        return fact

    def selector(self, section: Section, key: str, text: str, quoted: str = "") -> Selector:
        """Parse the selector of a person; return "" and record the problem if it is invalid.

        Args:
            section: the section that contains it.
            key: its key.
            text: the selector.
            quoted: the text that contains it, if it is only a part.
        """
        words = " ".join(text.split())
        if words in SELECTORS:
            return words
        if not (words.startswith(WHOSE) and _CONDITION.fullmatch(words.removeprefix(WHOSE))):
            meant = words.startswith(WHOSE) and not get_close_matches(words, SELECTORS, 1, ALIKE)
            near = "write whose FACT is VALUE" if meant else nearest(words, SELECTORS)
            section.wrong(key, f"{text!r} is not known; {near}", quoted or text)
            return ""
        condition = self.condition(section, key, words.removeprefix(WHOSE))
        if condition is None:
            return ""
        if condition.quantifier or not self.facts[condition.fact].per_player:
            problem = f"{text!r}: {condition.fact!r} must be a fact of each player"
            section.wrong(key, problem, quoted or text)
            return ""
        self.whose[words] = condition
        return words

    def effects(self, section: Section, key: str) -> tuple[Effect, ...]:
        """Parse the effects of a behaviour, in order."""
        found = (self.effect(section, key, text) for text in section.texts(key))
        return tuple(one for one in found if one is not None)

    def effect(self, section: Section, key: str, text: str) -> Effect | None:
        """Parse one effect, or record its problem."""
        words, _, tail = " ".join(text.split()).partition(" if ")
        parts = tail.split(" and ") if tail else []
        conditions = self.all_of(section, key, parts)
        does = next((one for one in DOES if words == one or words.startswith(f"{one} ")), None)
        if does is None:
            near = nearest(words, DOES)
            section.wrong(key, f"{text!r} is nothing that a behaviour does; {near}", text)
            return None
        rest = words[len(does) :].strip()
        if does not in TAKES_FACT:
            if rest:
                section.wrong(key, f"{text!r}: nothing can follow {does!r}", text)
                return None
            return Effect(does, conditions=conditions)
        return self._of_fact(section, key, text, does, rest, conditions)

    def _of_fact(
        self,
        section: Section,
        key: str,
        text: str,
        does: Does,
        rest: str,
        conditions: tuple[FactCondition, ...],
    ) -> Effect | None:
        named = max((n for n in self.facts if f"{rest} ".startswith(f"{n} ")), key=len, default="")
        fact = self.fact(section, key, named or rest.partition(" ")[0], text)
        if fact is None:
            return None
        value, number = rest[len(fact.name) :].strip(), 1
        problem = ""
        if fact.built_in or fact.kind == "test":
            problem = f"{fact.name!r} cannot be changed so"
        elif does == "set" and fact.kind not in ("flag", "choice"):
            problem = f"{fact.name!r} cannot be set: add, start or clear it"
        elif does in ("set", "invite") and fact.kind in ("flag", "choice"):
            problem = "" if value in fact.values else self._no_value(fact, value)
        elif does == "add":
            number = int(value) if value.isascii() and value.isdecimal() and len(value) < 5 else 1
            wrong = bool(value) and str(number) != value
            problem = f"{value!r} must be a whole number" if wrong else ""
            problem = problem if fact.kind == "count" else f"{fact.name!r} is not a count"
        elif does == "start" and fact.kind != "timer":
            problem = f"{fact.name!r} is not a timer"
        elif value:
            problem = f"nothing can follow {fact.name!r}"
        if problem:
            section.wrong(key, problem, text)
            return None
        return Effect(does, fact.name, value, number, conditions)

    def _no_value(self, fact: Fact, value: str) -> str:
        near = nearest(value, fact.values)
        if not value:
            return f"{fact.name!r} needs a value; {near}"
        return f"{value!r} is not a value of {fact.name!r}; {near}"
