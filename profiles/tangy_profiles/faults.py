"""The fault rules (III-C, diagnosis module): faults, their evidence, and their recoveries.

They are data: an ordered list in TOML. Each rule has the evidence of a fault, its criticality, its
recoveries, and the texts of screen and robot. `monitoring.diagnosis` applies them.
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
"""Recoveries: Tangy continues, asks a user, asks a teacher, or halts and asks an expert (III-C)."""

URGENCY = ("expert", "user", "teacher", "continue")
"""The order of recoveries if several faults are present."""

LEAVE_TO_STAFF = "leave to staff"
OWN_REMEDIES = (
    *("spin", "restart", "replan", "do without", "other requests", "set aside"),
    LEAVE_TO_STAFF,
)
"""Automatic remedies.

Spin to localise; restart a device; replan a path; do without a device; take requests by voice or
key; close a person's request, and also stop judging their card in this game.
"""

SOLVED = ("evidence gone", "card in view", "request closed")
"""How success of a recovery is observed; by default the evidence is gone."""

CONTEXT: Mapping[str, str] = MappingProxyType(
    {
        "behaviour.name": "the behaviour that was executed",
        "behaviour.effect": "its effect",
        "behaviour.completed": "whether the world could carry it out",
        "behaviour.response": "what the person did: none, complied, late, not followed",
    }
)
"""Evidence about the executed behaviour. It narrows a rule down, and is never a symptom."""

SYMPTOMS: Mapping[str, str] = MappingProxyType(
    {
        "person.refusals": "how often in a row a person would rather not",
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
"""All evidence at one moment, by dotted key: `laser.age`, `mismatch.card`, ..."""


class Remedy(NamedTuple):
    """A remedy for a world to carry out against a fault.

    `kind` is one of OWN_REMEDIES, or: `halt` and `resume` moving, `ask` people for help (with
    speech and image), `call expert`, or `look again` whether it is gone. `fault` is the diagnosed
    code.
    """

    kind: str
    fault: str
    device: str = ""
    person: str | None = None
    speech: str = ""
    image: str = ""


class Condition(NamedTuple):
    """A comparison of a piece of evidence; false if that evidence is missing."""

    key: str
    test: str
    value: Fact

    def holds(self, evidence: Evidence) -> bool:
        """Return whether the condition holds for the evidence."""
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
        """Return whether the other condition holds whenever this one does."""
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
        """The numeric limit in words; "" if there is none."""
        if self.test not in ("above", "below", "at_least"):
            return ""
        return f"limit {self.value:g}" if not isinstance(self.value, str) else ""

    def __str__(self) -> str:
        words = {"is": "is", "not": "is not", "at_least": "at least"}.get(self.test, self.test)
        return f"{self.key} {words} {self.value}"


@dataclass(frozen=True)
class FaultRule:
    """One fault: diagnosed if all conditions of one of the alternatives in `when` hold.

    `also` are further symptoms of the fault, which later rules do not explain. `recovery` is a
    ladder: after an unsuccessful recovery the next one follows, and after the last one an expert is
    asked. `tries` limits each. A `bearable` fault may stay: Tangy continues without the broken
    part. `advice` are steps for staff. If one of the faults that it `continues` (codes) is present,
    this is the same fault with more evidence.
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
        """Whether it is only logged: Tangy continues, and nobody has to act."""
        return self.recovery == (RECOVERIES[0],) and not self.remedy and not self.device

    @property
    def urgency(self) -> int:
        """Its rank among simultaneous faults; the lowest comes first."""
        return URGENCY.index(self.recovery[0])

    @cached_property
    def symptoms(self) -> frozenset[str]:
        """The keys of the evidence that this fault explains."""
        named = {c.key for conditions in self.when for c in conditions if c.key not in CONTEXT}
        return frozenset(named.union(self.also))

    @cached_property
    def devices(self) -> frozenset[str]:
        """The first parts of the keys in its conditions: devices, person, behaviour."""
        return frozenset(c.key.partition(".")[0] for conditions in self.when for c in conditions)

    def matched(self, evidence: Evidence) -> tuple[Condition, ...] | None:
        """Return the conditions of a matching alternative, or None."""
        for conditions in self.when:
            if all(condition.holds(evidence) for condition in conditions):
                return conditions
        return None

    def hides(self, conditions: Sequence[Condition]) -> bool:
        """Return whether this rule always explains a later one with these conditions."""
        theirs = {condition.key for condition in conditions if condition.key not in CONTEXT}
        return theirs <= self.symptoms and any(
            all(any(one.implies(mine) for one in conditions) for mine in alternative)
            for alternative in self.when
        )

    def fill(self, text: str, *, name: str, object: str, why: str = "") -> str:
        """Fill the person's name, the activity's object and the evidence into a text."""
        return text.format(name=name, object=object, why=why)


@dataclass(frozen=True)
class FaultBook:
    """All fault rules in order; the last one is the fallback."""

    rules: tuple[FaultRule, ...]
    source: str

    @property
    def fallback(self) -> FaultRule:
        """The diagnosis if no other rule matches."""
        return self.rules[-1]

    def rule(self, code: str) -> FaultRule:
        """Return a rule by its code.

        Raises:
            ProfileError: there is none; the message suggests the nearest code.
        """
        for rule in self.rules:
            if rule.code == code:
                return rule
        codes = [rule.code for rule in self.rules]
        raise ProfileError(f"There is no fault {code!r}: {nearest(code, codes)}")
