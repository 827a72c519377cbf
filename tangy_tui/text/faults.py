"""Words for faults: status, banner, list, recovery, and evidence beside expectation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, NamedTuple

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, FaultBook, FaultRule
from tangy_profiles.health import ERROR, STALE, Fact, Health
from tangy_tui.monitoring.detection import LATE
from tangy_tui.monitoring.diagnosis import narrows
from tangy_tui.monitoring.evidence import STATES, Label, mismatch_words, written
from tangy_tui.monitoring.fault import (
    BORNE,
    OPEN,
    OVER,
    Diagnosed,
    Fault,
    FaultEvent,
    RecoveryEvent,
)
from tangy_tui.text.fault_moves import RECOVERY_WORDS, move_words
from tangy_tui.text.fault_views import BEGINS, WAITS
from tangy_tui.text.numbers import listed
from tangy_tui.text.times import clock, time_of_day

if TYPE_CHECKING:
    from tangy_profiles.robot import DeviceProfile, Robot
    from tangy_tui.monitoring.supervision import Supervision

Name = Callable[[str], str]
"""Returns a person's name for an id."""

CRITICAL_MARK, MARK = "!!", "! "
"""The marks of critical and other faults."""

DOING_REMEDIES = {
    "spin": "turning to find its place",
    "restart": "starting it again",
    "replan": "taking another way",
    "do without": "doing without it",
    "other requests": "taking requests by voice and key",
    "set aside": "leaving it at that",
    "leave to staff": "leaving it to you",
}
"""Words for Tangy's own recovery actions in progress."""

_DOING = {
    "teacher asked": "asking the teacher",
    "halted": "Tangy stands still",
    "acknowledged": "",  # shows the move before it
    "kept": "another fault comes first",
    "expert called": "staff saw whom to call",
    "still there": "it is still there",
    "given up": "the game was given up",
    "left open": "left open at the end of the game",
}


def status_words(status: tuple[str, str]) -> str:
    """Format the state of the robot and its cause; silence is not an error."""
    word, cause = status
    if not cause:
        return word
    if word == LATE:
        return f"{WAITS}{cause}"
    if word == STALE:
        return f"{word}: {STATES[STALE]} from the {cause}"
    if word == ERROR:
        return f"{word}: the {cause} {STATES[ERROR]}"
    return f"{word}: {cause}"


def mark_of(fault: Fault) -> str:
    """Return the symbol of a fault's criticality."""
    return CRITICAL_MARK if fault.critical else MARK


def kind_words(fault: Fault) -> str:
    """Tell whether a fault is critical."""
    return "critical" if fault.critical else "non-critical"


def doing_words(fault: Fault, book: FaultBook) -> str:
    """Tell what Tangy does about a fault at present."""
    move = _last(fault)
    if move is None:
        return BEGINS[fault.recovery]
    match move.kind:
        case "asked":
            return f"asks{_tries(fault, move, book)}"
        case "remedied":
            return f"{DOING_REMEDIES.get(move.remedy, move.remedy)}{_tries(fault, move, book)}"
        case "went on":
            return "going on without"
        case "escalated":
            return f"that did not help: {BEGINS[move.to]}"
    return _DOING.get(move.kind) or move_words(move)


def said_words(fault: Fault) -> str:
    """Return Tangy's present speech about a fault: its request for help."""
    move = _last(fault)
    return "" if move is None else move.speech


def _last(fault: Fault) -> RecoveryEvent | None:
    """Return the last recovery event; the state before an acknowledgement remains."""
    done = [move for move in fault.moves if _DOING.get(move.kind) != ""]
    return done[-1] if done else None


def _tries(fault: Fault, move: RecoveryEvent, book: FaultBook) -> str:
    tries = book.rule(fault.code).tries
    return f" ({move.attempt} of {tries})" if tries > 1 else ""


def banner_words(fault: Fault, doing: str) -> tuple[str, ...]:
    """Format the banner of a fault, from the longest form to the shortest: mark, name, recovery."""
    mark, name = mark_of(fault).strip(), fault.name
    return (
        f"{mark} FAULT {kind_words(fault)}: {name} -> {doing}",
        f"{mark} FAULT {name} -> {doing}",
        f"{mark} {name}: {doing}",
    )


def state_words(fault: Fault) -> str:
    """Name the status of a fault: open, borne or over."""
    return {OPEN: "open", BORNE: "going on without", OVER: "over"}[fault.status]


def short_state(fault: Fault) -> str:
    """Name the status in one word, for little room."""
    return {OPEN: "open", BORNE: "without", OVER: "over"}[fault.status]


def last_words(fault: Fault) -> str:
    """Describe the last move of a fault."""
    return move_words(fault.moves[-1]) if fault.moves else "nothing yet"


def searched(fault: Fault, name: Name) -> str:
    """Return the text in which the filter searches."""
    person = name(fault.person) if fault.person is not None else ""
    return " ".join(
        (fault.name, fault.code, kind_words(fault), state_words(fault), fault.status, person)
    ).lower()


def told_in_banner(supervision: Supervision) -> list[Fault]:
    """Return the faults for the banner, the most urgent first.

    A fault that Tangy continues without stays in the banner until acknowledged.
    """
    there = [f for f in supervision.waiting if not f.asks_only]
    there += [f for f in supervision.faults if f.status == BORNE and not f.acknowledged]
    first = supervision.halted
    return there if first is None else [first, *(f for f in there if f is not first)]


class EvidenceLine(NamedTuple):
    """One piece of evidence in words, and its expectation ("": none)."""

    what: str
    note: str = ""


def evidence_of(
    fault: Fault, book: FaultBook, robot: Robot, label: Label = str
) -> list[EvidenceLine]:
    """Pair observations with their expectations; `label` returns the words for a behaviour."""
    rule = book.rule(fault.code)
    pieces: list[EvidenceLine] = []
    for key, value in fault.evidence.items():
        if key in CONTEXT or key.startswith("mismatch.") or key == "situation.shown":
            continue
        head, _, fact = key.partition(".")
        device = robot.devices.get(head)
        if device is not None and fact == "age":
            pieces += _age(device, value)
            continue
        if device is None:
            what = SYMPTOMS.get(key, key)
        elif fact == "state":
            what = device.label
        else:
            measure = device.facts.get(fact)
            what = f"{device.label}, {measure.says if measure is not None else fact}"
        expected = _expected(key, value, rule, book)
        if expected:
            observed = _observed(fact, value)
            pieces.append(EvidenceLine(f"{what}: {observed}", f"expected: {expected}"))
    for one in fault.mismatches:
        words = mismatch_words(one, label)
        wanted = listed(one.expected, "or") or "nothing known"
        note = f"{one.variable}: {one.seen}; expected: {wanted}"
        pieces.append(EvidenceLine(f"{words[:1].upper()}{words[1:]}", note))
    return pieces


def ages_of(fault: Fault, book: FaultBook, robot: Robot, health: Health) -> list[EvidenceLine]:
    """Tell the age of a fault's device data if it is too old and not part of the evidence."""
    device = robot.devices.get(book.rule(fault.code).device)
    if device is None or f"{device.name}.age" in fault.evidence:
        return []
    ages = (reading.age for reading in health if reading.device == device.name)
    return [piece for age in ages for piece in _age(device, age)]


def known_now(fault: Fault, supervision: Supervision) -> Fault:
    """Return a fault in the words of a more specific rule that has matched since, if any.

    A robot whose own process froze looks at first as if the link were lost.
    """
    evidence = supervision.devices
    for rule in supervision.book.rules:
        if fault.code in rule.continues and rule.matched(evidence):
            return replace(fault, texts=(rule.name, rule.console, *rule.advice))
    return fault


def still_there_words(fault: Fault, supervision: Supervision) -> str:
    """Tell whether a fault is still present; "" if the devices cannot tell."""
    book, evidence = supervision.book, supervision.devices
    rule = book.rule(fault.code)
    if rule.fallback or not rule.device:
        return ""
    known_better = (one for one in book.rules if fault.code in one.continues)
    rules = (*known_better, rule)
    conditions = next(filter(None, (one.matched(evidence) for one in rules)), None)
    if conditions is None:
        clear = "press {accept} to clear."
        keys = clear if fault.acknowledged else "press {acknowledge}, and {accept} to clear."
        return f"It is gone now: {keys}"
    now = {condition.key: evidence[condition.key] for condition in conditions}
    there = replace(fault, evidence=now, mismatches=())
    pieces = evidence_of(there, supervision.book, supervision.robot)
    return f"Still there: {'; '.join(piece.what for piece in pieces)}."


def _age(device: DeviceProfile, age: Fact) -> list[EvidenceLine]:
    if isinstance(age, (bool, str)) or age <= device.stale_after:
        return []
    expected = f"expected: at most {device.stale_after:g} s old"
    return [EvidenceLine(f"{device.label}, newest data: {written(age)} s old", expected)]


def _expected(key: str, value: Fact, rule: FaultRule, book: FaultBook) -> str:
    """Return the expectation that an observation violates; "" if it only narrows the fault down."""
    if key.endswith(".state"):
        return "OK" if value != "OK" else ""
    for conditions in rule.when:
        for condition in conditions:
            if condition.key == key and condition.holds({key: value}):
                return "" if narrows(condition, conditions, book) else _otherwise(condition)
    return "nothing of the kind"


def _otherwise(condition: Condition) -> str:
    value = condition.value
    match condition.test:
        case "above":
            return f"at most {written(value)}"
        case "below":
            return f"at least {written(value)}"
        case "at_least":
            return f"less than {written(value)}"
        case "is" if isinstance(value, bool):
            return written(not value)
        case "is":
            return f"not {written(value)}"
    return written(value)


def _observed(fact: str, value: Fact) -> str:
    if fact != "state":
        return written(value)
    return f"{STATES[str(value)]} ({value})" if value in STATES else str(value)


def recovery_words(rule: FaultRule) -> str:
    """Describe the recoveries of a rule, step by step."""
    tries = f" (up to {rule.tries} times)" if rule.tries > 1 else ""
    first, *rest = (RECOVERY_WORDS[word] for word in rule.recovery)
    return "; else ".join([first + tries, *rest])


HALTED = "Tangy stands still. Type: seen, expert, reached, clear, what, faults, or quit."


def fault_lines(event: FaultEvent) -> list[str]:
    """Format a fault or a recovery event as lines."""
    fault = event.fault
    if fault.asks_only:
        return []  # Tangy's question tells all of it
    if isinstance(event, Diagnosed):
        kind = "CRITICAL" if fault.critical else "non-critical"
        return [f"!  Fault, {kind}: {fault.name}. {fault.console}", f"   Why: {fault.why}."]
    if event.move.kind == "halted" and not fault.critical:
        return [f"!  Tangy halts: {fault.name}.", *_said(event.move)]
    return [f"   {fault.name}: {move_words(event.move)}.", *_said(event.move)]


def advice_lines(game: Supervision) -> list[str]:
    """Return the advice about Tangy's question, or about the fault that halts it."""
    question = game.question
    about = "" if question is None else question.fault
    fault = game.halted or next((one for one in game.faults if one.id == about), None)
    if fault is None:
        return []
    now = known_now(fault, game)
    why = f" Why: {fault.why}." if now is fault else ""
    steps = [f"  {number}. {step}" for number, step in enumerate(now.advice, 1)]
    return [f"{now.console}{why}", *steps]


def _said(move: RecoveryEvent) -> list[str]:
    return [f"   Tangy says: {move.speech}"] if move.speech else []


def fault_time(fault: Fault, seconds: float, *, short: bool = False) -> str:
    """Format when something happened about a fault: the time of day, or in the game if simulated.

    Args:
        fault: the fault.
        seconds: the time in the game, in s.
        short: without seconds of the time of day.
    """
    if not fault.real_time or not fault.at:
        return clock(seconds)
    at = datetime.fromisoformat(fault.at) + timedelta(seconds=seconds - fault.seconds)
    return time_of_day(at.isoformat())[: 5 if short else 8]


def list_lines(faults: list[Fault]) -> list[str]:
    """List faults with their recoveries."""
    lines: list[str] = []
    for number, fault in enumerate(faults, 1):
        lines.append(f"{number}. {fault_time(fault, fault.seconds)} {fault.name} ({fault.status})")
        lines += [
            f"   {fault_time(fault, move.seconds)}  {move_words(move)}" for move in fault.moves
        ]
    return lines or ["No faults in this game."]
