"""The file of fault rules: reads and checks TOML, and reports each mistake in one line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from tangy_profiles.defaults import SHIPPED
from tangy_profiles.errors import ProfileError
from tangy_profiles.faults import (
    CONTEXT,
    CRITICAL,
    NON_CRITICAL,
    OWN_REMEDIES,
    RECOVERIES,
    SLOTS,
    SOLVED,
    SYMPTOMS,
    Condition,
    FaultBook,
    FaultRule,
)
from tangy_profiles.health import STATES, Fact
from tangy_profiles.known_devices import possible_devices
from tangy_profiles.reading import Table, nearest, plain, read_toml
from tangy_profiles.robot import DeviceProfile, Robot
from tangy_profiles.rules_for_robot import for_devices

_TESTS = ("is", "not", "above", "below", "at_least")


def load_faults(robot: Robot, path: Path | None = None) -> FaultBook:
    """Load the built-in fault rules, or a file in the same format, for a robot.

    Raises:
        ProfileError: one line with file, key, value and the nearest valid word.
    """
    book, mistakes = check_faults(robot, path)
    if book is None:
        raise ProfileError(mistakes[0])
    return book


def check_faults(robot: Robot, path: Path | None = None) -> tuple[FaultBook | None, list[str]]:
    """Read fault rules as `load_faults` does, and return the problems, a line for each entry.

    Without mistakes the book has the rules for this robot; with any it is None.
    """
    path = path or SHIPPED / "faults.toml"
    devices = possible_devices(robot)
    known = evidence_keys(devices)
    rules: list[FaultRule] = []
    mistakes: list[str] = []
    read = True
    try:
        top = read_toml(path)
        for entry in top.tables("faults"):
            read = False
            try:
                needs = entry.choice("needs", (*devices, ""), "")
                rule = _read_rule(entry, devices, known)
                _check_order(entry, rule, rules)
                entry.close()
            except ProfileError as error:
                mistakes.append(str(error))
            else:
                read = True
                if not needs or needs in robot.devices:
                    rules.append(rule)
        top.close()
    except ProfileError as error:
        mistakes.append(str(error))
        return None, mistakes
    if read and not (rules and rules[-1].fallback):
        mistakes.append(
            f"{plain(path.name)}: the last of the faults must have `fallback = true`: it is what "
            "is diagnosed when no other rule explains what was seen."
        )
    book = None if mistakes else FaultBook(for_devices(rules, robot.devices), path.name)
    return book, mistakes


def evidence_keys(devices: Mapping[str, DeviceProfile]) -> dict[str, str]:
    """Return every key that a rule may use, with its description."""
    keys = {**CONTEXT, **SYMPTOMS}
    for device in devices.values():
        keys[f"{device.name}.state"] = f"{device.label}: OK, WARN, STALE or ERROR"
        keys[f"{device.name}.age"] = f"{device.label}: s since the newest data"
        for fact, measure in device.facts.items():
            keys[f"{device.name}.{fact}"] = f"{device.label}: {measure.says}"
    return keys


def _read_rule(
    entry: Table, devices: Mapping[str, DeviceProfile], known: Mapping[str, str]
) -> FaultRule:
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
        when=() if fallback else _alternatives(entry, known, devices),
        also=entry.words("also", known, ()),
        continues=entry.words("continues", default=()),
        device=entry.choice("device", (*devices, ""), ""),
        tries=entry.whole("tries", 1, 10, 1),
        remedy=entry.choice("remedy", OWN_REMEDIES, ""),
        solved=entry.choice("solved", SOLVED, SOLVED[0]),
        bearable=entry.flag("bearable", False),
        aloud=_text(entry, "aloud", optional=True),
        aloud_again=_text(entry, "aloud_again", optional=True),
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
    entry: Table, known: Mapping[str, str], devices: Mapping[str, DeviceProfile]
) -> tuple[tuple[Condition, ...], ...]:
    found: list[tuple[Condition, ...]] = []
    for alternative in entry.tables("when"):
        conditions: list[Condition] = []
        for key in alternative:
            if key not in known:
                meant = nearest(key, known)
                device, fact = _undeclared(key, devices)
                if not fact:
                    raise alternative.wrong(key, f"is no evidence; {meant}")
                close = f"{meant} Otherwise no" if meant.endswith("?") else "no"
                raise alternative.wrong(
                    key,
                    f"is no evidence; {close} device declares the fact {fact!r}; add facts.{fact} "
                    f"to {device} in the robot's file.",
                )
            test = alternative.table(key)
            words = list(test)
            if len(words) != 1 or words[0] not in _TESTS:
                raise alternative.wrong(key, f"must hold one of: {', '.join(_TESTS)}.")
            condition = Condition(key, words[0], _value(test, words[0]))
            if problem := _never(condition, devices):
                raise test.wrong(words[0], problem)
            conditions.append(condition)
        if not conditions:
            raise entry.wrong("when", "holds an alternative without a condition.")
        found.append(tuple(conditions))
    if not found:
        raise entry.wrong("when", "must hold at least one alternative.")
    return tuple(found)


def _undeclared(key: str, devices: Mapping[str, DeviceProfile]) -> tuple[str, str]:
    """Return the device and the fact of unknown evidence; two "" if it names no device."""
    device, _, fact = key.partition(".")
    return (device, fact) if device in devices and fact else ("", "")


def _never(condition: Condition, devices: Mapping[str, DeviceProfile]) -> str:
    """Return why a condition on a device's report can never hold; "" if it can."""
    head, _, fact = condition.key.partition(".")
    device = devices.get(head)
    if device is None or fact == "age":
        return ""
    if fact == "state":
        known = condition.value in STATES and condition.test in ("is", "not")
        return "" if known else f"is no state; {nearest(str(condition.value).upper(), STATES)}"
    measure = device.facts[fact]
    if condition.test not in ("is", "not") and measure.high is None:
        return "compares something that is not a number: use is or not."
    return measure.wrong(condition.value)


def _value(test: Table, word: str) -> Fact:
    if word in ("is", "not"):
        return test.word_or_number(word)
    return test.number(word)


def _text(entry: Table, key: str, *, optional: bool = False) -> str:
    text = entry.text(key, "" if optional else None)
    entry.check_slots(key, text, SLOTS)
    return text


def _texts(entry: Table, key: str) -> tuple[str, ...]:
    texts = entry.words(key)
    for text in texts:
        entry.check_slots(key, text, SLOTS)
    return texts


def _check_order(entry: Table, rule: FaultRule, earlier: Sequence[FaultRule]) -> None:
    """Reject a rule that can never be reached.

    Raises:
        ProfileError: names the rule that always matches first.
    """
    if any(other.code == rule.code for other in earlier):
        raise entry.wrong("code", "was used before: every fault has its own.")
    if earlier and earlier[-1].fallback:
        raise entry.wrong("code", f"comes after {earlier[-1].code!r}, which explains everything.")
    for conditions in rule.when:
        for other in earlier:
            if conditions and other.hides(conditions):
                raise entry.wrong(
                    "when", f"can never be reached: {other.code!r} matches first, and explains it."
                )
