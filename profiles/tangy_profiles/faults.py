"""The fault rules (III-C, diagnosis module): faults, their evidence, and their recoveries.

They are data: an ordered list in TOML. Each says by which evidence a fault is recognised, whether
it is critical, how to recover from it, and what console and robot say. `monitoring.diagnosis`
reads the evidence by them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import NamedTuple

from tangy_profiles.errors import ProfileError
from tangy_profiles.health import Fact
from tangy_profiles.reading import nearest
from tangy_profiles.state import VARIABLES

CRITICAL, NON_CRITICAL = "critical", "non-critical"
RECOVERIES = ("continue", "user", "teacher", "expert")
"""Whose turn it is: Tangy goes on, asks a user, a teacher, or halts and asks an expert (III-C)."""

URGENCY = ("expert", "user", "teacher", "continue")
"""Which recovery comes first when several faults are there at once."""

LEAVE_TO_STAFF = "leave to staff"
OWN_REMEDIES = (
    *("spin", "restart", "replan", "do without", "other requests", "set aside"),
    LEAVE_TO_STAFF,
)
"""What a robot can do by itself: turn on the spot to find where it is; start a device again; plan
another way; leave a device alone; take requests by voice or key; close a person's request, and
also judge what they have no more in this game."""

SOLVED = ("evidence gone", "card in view", "request closed")
"""How it is seen that a recovery succeeded, where that is not that the evidence is gone."""

CONTEXT: Mapping[str, str] = MappingProxyType(
    {
        "behaviour.name": "the behaviour that was executed",
        "behaviour.effect": "its effect",
        "behaviour.completed": "whether the world could carry it out",
        "behaviour.response": "what the person did: none, complied, late, not followed",
    }
)
"""Evidence about what was done. It narrows a rule down, and is never a symptom."""

SYMPTOMS: Mapping[str, str] = MappingProxyType(
    {
        "person.refusals": "how often in a row a person did not follow",
        "person.spent": "whether a person was asked as often as the activity allows",
        "person.unchanged": "how often what was asked for looked as before, and nobody refused",
        "visit.fruitless": "behaviours in a row after which nothing had changed",
        "situation.shown": "whether a teacher has shown what to do in the situation",
        **{f"mismatch.{name}": f"an unexpected value of: {name}" for name in VARIABLES},
    }
)
"""Symptoms that no device reports: they come from the world state and the execution."""

SLOTS = ("name", "object", "why")
"""Slots in the texts of a rule: the person, the object people handle, the evidence."""

Evidence = Mapping[str, Fact]
"""Everything known at one moment, by dotted key: `laser.age`, `mismatch.card`, ..."""


class Remedy(NamedTuple):
    """A remedy for a world to carry out against a fault.

    `kind` is one of OWN_REMEDIES, or: `halt` and `resume` moving, `ask` people for help (say the
    speech, show the image), `call expert`, or `look again` whether it is gone, when staff say so.
    `fault` is the code that was diagnosed.
    """

    kind: str
    fault: str
    device: str = ""
    person: str | None = None
    speech: str = ""
    image: str = ""


class Condition(NamedTuple):
    """One comparison of a piece of evidence; evidence that is not there never agrees."""

    key: str
    test: str
    value: Fact

    def holds(self, evidence: Evidence) -> bool:
        """Say whether the evidence agrees."""
        found = evidence.get(self.key)
        if found is None:
            return False
        if self.test in ("is", "not"):
            return (found == self.value) is (self.test == "is")
        if isinstance(found, str) or isinstance(self.value, str):
            return False
        if self.test == "above":
            return found > self.value
        if self.test == "below":
            return found < self.value
        return found >= self.value

    def implies(self, other: Condition) -> bool:
        """Say whether whatever agrees with this condition agrees with the other one as well."""
        if self.key != other.key:
            return False
        if self == other:
            return True
        ups = {"above", "at_least"}
        if isinstance(self.value, str) or isinstance(other.value, str):
            return False
        if self.test in ups and other.test in ups:
            strict = other.test == "above" and self.test == "at_least"
            return self.value > other.value or (self.value == other.value and not strict)
        return self.test == other.test == "below" and self.value <= other.value

    @property
    def limit(self) -> str:
        """The limit that a number passed, in words; "" if there is none."""
        if self.test not in ("above", "below", "at_least"):
            return ""
        return f"limit {self.value:g}" if not isinstance(self.value, str) else ""

    def __str__(self) -> str:
        words = {"is": "is", "not": "is not", "at_least": "at least"}.get(self.test, self.test)
        return f"{self.key} {words} {self.value}"


@dataclass(frozen=True)
class FaultRule:
    """One fault: recognised when all conditions of one of the alternatives in `when` hold.

    `also` are the symptoms that follow from the fault as well: a rule further down has nothing to
    say about them. `recovery` is a ladder: what does not help leads to its next rung, and after
    the last one an expert is asked. `tries` bounds each rung. A `bearable` fault may stay: Tangy
    goes on without the broken part. `advice` are the staff's steps, in their words. While one of
    the faults that it `continues` (codes) is there, it is that one, of which more is known now.
    """

    code: str
    name: str
    criticality: str
    recovery: tuple[str, ...]
    console: str
    advice: tuple[str, ...]
    when: tuple[tuple[Condition, ...], ...] = ()
    also: tuple[str, ...] = ()
    continues: tuple[str, ...] = ()
    device: str = ""
    tries: int = 1
    remedy: str = ""
    solved: str = SOLVED[0]
    bearable: bool = False
    aloud: str = ""
    aloud_again: str = ""
    image: str = ""
    fallback: bool = False

    @property
    def critical(self) -> bool:
        """Whether the robot must stand still until an expert has cleared it."""
        return self.criticality == CRITICAL

    @property
    def quiet(self) -> bool:
        """Whether it is noted and no more: Tangy goes on, and nobody has to do anything."""
        return self.recovery == (RECOVERIES[0],) and not self.remedy and not self.device

    @property
    def urgency(self) -> int:
        """Its place among faults that are there at once; the smallest comes first."""
        return URGENCY.index(self.recovery[0])

    @cached_property
    def symptoms(self) -> frozenset[str]:
        """The keys of the evidence that this fault explains."""
        named = {c.key for conditions in self.when for c in conditions if c.key not in CONTEXT}
        return frozenset(named.union(self.also))

    @cached_property
    def devices(self) -> frozenset[str]:
        """The first parts of the keys that it is recognised by: devices, person, behaviour."""
        return frozenset(c.key.partition(".")[0] for conditions in self.when for c in conditions)

    def matched(self, evidence: Evidence) -> tuple[Condition, ...] | None:
        """Return the conditions by which the fault is recognised, or None."""
        for conditions in self.when:
            if all(condition.holds(evidence) for condition in conditions):
                return conditions
        return None

    def hides(self, conditions: Sequence[Condition]) -> bool:
        """Say whether this rule explains all symptoms whenever conditions of a later one hold."""
        theirs = {condition.key for condition in conditions if condition.key not in CONTEXT}
        return theirs <= self.symptoms and any(
            all(any(one.implies(mine) for one in conditions) for mine in alternative)
            for alternative in self.when
        )

    def fill(self, text: str, *, name: str, object: str, why: str = "") -> str:
        """Put the person's name, the activity's object and the evidence into a text."""
        return text.format(name=name, object=object, why=why)


@dataclass(frozen=True)
class FaultBook:
    """All fault rules in order, the last one for what no other explains."""

    rules: tuple[FaultRule, ...]
    source: str

    @property
    def fallback(self) -> FaultRule:
        """The diagnosis of what no other rule explains."""
        return self.rules[-1]

    def rule(self, code: str) -> FaultRule:
        """Return a rule by its code.

        Raises:
            ProfileError: there is none; says which is nearest.
        """
        for rule in self.rules:
            if rule.code == code:
                return rule
        codes = [rule.code for rule in self.rules]
        raise ProfileError(f"There is no fault {code!r}: {nearest(code, codes)}")
