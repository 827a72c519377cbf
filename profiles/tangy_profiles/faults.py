"""The fault rules (III-C, the diagnosis module): what is wrong, by which evidence, and what then.

They are data: an ordered list in TOML. Each says by which evidence a fault is recognised, whether
it is critical, how to recover from it, and what console and robot say. `monitoring.diagnosis`
reads the evidence by them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from pathlib import Path
from string import Formatter
from types import MappingProxyType
from typing import NamedTuple

from tangy_profiles.errors import ProfileError
from tangy_profiles.health import STATES, Fact
from tangy_profiles.reading import Table, nearest, plain, read_toml
from tangy_profiles.robot import Robot
from tangy_profiles.state import VARIABLES

CRITICAL, NON_CRITICAL = "critical", "non-critical"
RECOVERIES = ("continue", "user", "teacher", "expert")
"""Whose turn it is: Tangy goes on, asks a user, a teacher, or halts and asks an expert (III-C)."""

URGENCY = ("expert", "user", "teacher", "continue")
"""Which recovery comes first when several faults are there at once."""

OWN_REMEDIES = ("spin", "restart", "replan", "do without", "other requests", "set aside")
"""What a robot can do by itself: turn on the spot to find where it is; start a device again; plan
another way; leave a device alone; take requests by voice or key; close a person's request."""

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
        "visit.fruitless": "behaviours in a row after which nothing had changed",
        "situation.shown": "whether a teacher has shown what to do in the situation",
        **{f"mismatch.{name}": f"an unexpected value of: {name}" for name in VARIABLES},
    }
)
"""Symptoms that no device reports: they come from the world state and the execution."""

SLOTS = ("name", "object", "why")
"""What the texts of a rule may have filled in: the person, what people handle, the evidence."""

Evidence = Mapping[str, Fact]
"""Everything known at one moment, by dotted key: `laser.age`, `mismatch.card`, ..."""

_TESTS = ("is", "not", "above", "below", "at_least")


class Remedy(NamedTuple):
    """What a world is to do about a fault.

    `kind` is one of OWN_REMEDIES, or: `halt` and `resume` moving, `ask` people for help (say the
    speech, show the image), `call expert`. `fault` is the code that was diagnosed.
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
        """The limit that a number passed, in words; "" where there is none."""
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
    goes on without what is broken. `advice` are the staff's steps, in their words.
    """

    code: str
    name: str
    criticality: str
    recovery: tuple[str, ...]
    console: str
    advice: tuple[str, ...]
    when: tuple[tuple[Condition, ...], ...] = ()
    also: tuple[str, ...] = ()
    device: str = ""
    tries: int = 1
    remedy: str = ""
    solved: str = SOLVED[0]
    bearable: bool = False
    aloud: str = ""
    image: str = ""
    fallback: bool = False

    @property
    def critical(self) -> bool:
        """Whether the robot must stand still until an expert has seen to it."""
        return self.criticality == CRITICAL

    @property
    def urgency(self) -> int:
        """Its place among faults that are there at once; the smallest comes first."""
        return URGENCY.index(self.recovery[0])

    @cached_property
    def symptoms(self) -> frozenset[str]:
        """The keys of the evidence that this fault explains."""
        named = {c.key for conditions in self.when for c in conditions if c.key not in CONTEXT}
        return frozenset(named.union(self.also))

    def matched(self, evidence: Evidence) -> tuple[Condition, ...] | None:
        """Return the conditions by which the fault is recognised, or None."""
        for conditions in self.when:
            if all(condition.holds(evidence) for condition in conditions):
                return conditions
        return None

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


def load_faults(robot: Robot, path: Path | None = None) -> FaultBook:
    """Load the fault rules that ship, or a file of the same form, for a robot.

    Raises:
        ProfileError: one line that says file, key, value and the nearest valid word.
    """
    book, mistakes = check_faults(robot, path)
    if book is None:
        raise ProfileError(mistakes[0])
    return book


def check_faults(robot: Robot, path: Path | None = None) -> tuple[FaultBook | None, list[str]]:
    """Read fault rules as `load_faults` does, and return what is wrong, a line for each entry.

    Without mistakes there is a book; with any there is none.
    """
    path = path or Path(str(files("tangy_profiles"))) / "faults.toml"
    known = evidence_keys(robot)
    rules: list[FaultRule] = []
    mistakes: list[str] = []
    read = True
    try:
        top = read_toml(path)
        for entry in top.tables("faults"):
            read = False
            try:
                rule = _read_rule(entry, robot, known)
                _check_order(entry, rule, rules)
                entry.close()
            except ProfileError as error:
                mistakes.append(str(error))
            else:
                rules.append(rule)
                read = True
        top.close()
    except ProfileError as error:
        mistakes.append(str(error))
        return None, mistakes
    if read and not (rules and rules[-1].fallback):
        mistakes.append(
            f"{plain(path.name)}: the last of the faults must have `fallback = true`: it is what "
            "is diagnosed when no other rule explains what was seen."
        )
    return (None if mistakes else FaultBook(tuple(rules), path.name)), mistakes


def evidence_keys(robot: Robot) -> dict[str, str]:
    """Return every key that a rule may look at, with what it is."""
    keys = {**CONTEXT, **SYMPTOMS}
    for device in robot.devices.values():
        keys[f"{device.name}.state"] = f"{device.label}: OK, WARN, STALE or ERROR"
        keys[f"{device.name}.age"] = f"{device.label}: s since the newest data"
        for fact, measure in device.facts.items():
            keys[f"{device.name}.{fact}"] = f"{device.label}: {measure.says}"
    return keys


def _read_rule(entry: Table, robot: Robot, known: Mapping[str, str]) -> FaultRule:
    code = entry.text("code")
    if not code.replace("-", "").isalnum() or code != code.lower():
        raise entry.wrong("code", "must be lower-case words with hyphens.")
    fallback = entry.flag("fallback", False)
    criticality = entry.choice("criticality", (CRITICAL, NON_CRITICAL))
    recovery = entry.words("recovery", RECOVERIES)
    if not recovery or len(set(recovery)) < len(recovery):
        raise entry.wrong("recovery", "must name one or more recoveries, each once.")
    if (criticality == CRITICAL) != (recovery[0] == "expert"):
        raise entry.wrong(
            "recovery",
            'must begin with "expert" for a critical fault, and with another one otherwise.',
        )
    if "expert" in recovery[:-1]:
        raise entry.wrong("recovery", "cannot go on after the expert: nobody comes after that.")
    rule = FaultRule(
        code=code,
        name=_text(entry, "name"),
        criticality=criticality,
        recovery=recovery,
        console=_text(entry, "console"),
        advice=_texts(entry, "advice"),
        when=() if fallback else _alternatives(entry, known, robot),
        also=entry.words("also", known, ()),
        device=entry.choice("device", (*robot.devices, ""), ""),
        tries=entry.whole("tries", 1, 10, 1),
        remedy=entry.choice("remedy", OWN_REMEDIES, ""),
        solved=entry.choice("solved", SOLVED, SOLVED[0]),
        bearable=entry.flag("bearable", False),
        aloud=_text(entry, "aloud", optional=True),
        image=_text(entry, "image", optional=True),
        fallback=fallback,
    )
    if not rule.advice:
        raise entry.wrong("advice", "must tell staff what to do, in one step or more.")
    if "user" in recovery and not (rule.aloud and rule.image):
        raise entry.wrong("aloud", "and `image` must say what a user is asked to do.")
    if rule.when and not rule.symptoms.difference(rule.also):
        raise entry.wrong("when", "must look at a symptom, not only at what was done.")
    return rule


def _alternatives(
    entry: Table, known: Mapping[str, str], robot: Robot
) -> tuple[tuple[Condition, ...], ...]:
    found: list[tuple[Condition, ...]] = []
    for alternative in entry.tables("when"):
        conditions: list[Condition] = []
        for key in alternative:
            if key not in known:
                raise alternative.wrong(key, f"is no evidence; {nearest(key, known)}")
            test = alternative.table(key)
            words = list(test)
            if len(words) != 1 or words[0] not in _TESTS:
                raise alternative.wrong(key, f"must hold one of: {', '.join(_TESTS)}.")
            condition = Condition(key, words[0], _value(test, words[0]))
            if problem := _never(condition, robot):
                raise test.wrong(words[0], problem)
            conditions.append(condition)
        if not conditions:
            raise entry.wrong("when", "holds an alternative without a condition.")
        found.append(tuple(conditions))
    if not found:
        raise entry.wrong("when", "must hold at least one alternative.")
    return tuple(found)


def _never(condition: Condition, robot: Robot) -> str:
    """Say why a condition on what a device reports can never be met as meant; "" if it can."""
    head, _, fact = condition.key.partition(".")
    device = robot.devices.get(head)
    if device is None or fact == "age":
        return ""
    if fact == "state":
        known = condition.value in STATES and condition.test in ("is", "not")
        return "" if known else f"is no state; {nearest(str(condition.value).upper(), STATES)}"
    measure = device.facts[fact]
    if condition.test not in ("is", "not") and measure.high is None:
        return "compares what is no number: use is or not."
    return measure.wrong(condition.value)


def _value(test: Table, word: str) -> Fact:
    if word in ("is", "not"):
        return test.word_or_number(word)
    return test.number(word)


def _text(entry: Table, key: str, *, optional: bool = False) -> str:
    text = entry.text(key, "" if optional else None)
    _check_slots(entry, key, text)
    return text


def _texts(entry: Table, key: str) -> tuple[str, ...]:
    texts = entry.words(key)
    for text in texts:
        _check_slots(entry, key, text)
    return texts


def _check_slots(entry: Table, key: str, text: str) -> None:
    try:
        slots = [part[1:] for part in Formatter().parse(text) if part[1] is not None]
    except ValueError:
        raise entry.wrong(key, "has an unpaired brace.") from None
    for slot, form, conversion in slots:
        if slot not in SLOTS:
            raise entry.wrong(key, f"cannot fill in {{{slot}}}; {nearest(slot or '', SLOTS)}")
        if form or conversion:
            raise entry.wrong(key, f"must hold just {{{slot}}}, without ':' or '!'.")


def _check_order(entry: Table, rule: FaultRule, earlier: Sequence[FaultRule]) -> None:
    """Refuse a rule that can never be reached.

    Raises:
        ProfileError: naming the rule that always matches first.
    """
    if any(other.code == rule.code for other in earlier):
        raise entry.wrong("code", "was used before: every fault has its own.")
    if earlier and earlier[-1].fallback:
        raise entry.wrong("code", f"comes after {earlier[-1].code!r}, which explains everything.")
    for conditions in rule.when:
        for other in earlier:
            if conditions and _hidden(rule, conditions, other):
                raise entry.wrong(
                    "when", f"can never be reached: {other.code!r} matches first, and explains it."
                )


def _hidden(rule: FaultRule, conditions: Sequence[Condition], other: FaultRule) -> bool:
    """Say whether whenever the conditions hold, an earlier rule explains all their symptoms."""
    mine = {condition.key for condition in conditions if condition.key not in CONTEXT}
    return mine <= other.symptoms and any(
        all(any(mine.implies(theirs) for mine in conditions) for theirs in alternative)
        for alternative in other.when
    )
