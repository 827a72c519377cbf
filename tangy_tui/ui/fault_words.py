"""Faults in words for the screens: status, banner, list, evidence against what was expected."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from tangy_profiles.faults import CONTEXT, SYMPTOMS, Condition, FaultBook, FaultRule
from tangy_profiles.health import STALE, Fact, Health
from tangy_profiles.robot import Device, Robot
from tangy_tui.monitoring.fault import BORNE, OPEN, OVER, Fault, Move
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.monitoring.telling import RECOVERY_WORDS, move_words
from tangy_tui.ui.clean_output import clean

Name = Callable[[str], str]
"""Gives a person's name for an id."""

CRITICAL_MARK, MARK = "!!", "! "
"""What stands before a critical fault, and before another one."""

REMEDIES = {
    "spin": "turning to find its place",
    "restart": "starting it again",
    "replan": "taking another way",
    "do without": "doing without it",
    "other requests": "taking requests by voice and key",
    "set aside": "leaving it at that",
}
"""What Tangy does by itself, in words."""

_DOING = {
    "teacher asked": "asking the teacher",
    "halted": "Tangy stands still",
    "acknowledged": "",  # what came before that is still so
    "kept": "another fault comes first",
    "expert called": "the expert was called",
    "still there": "it is still there",
    "given up": "the game was given up",
    "left open": "left open at the end of the game",
}


def status_words(status: tuple[str, str]) -> str:
    """Write how the robot is and of what that comes; nothing heard is not an error."""
    word, cause = status
    if not cause:
        return word
    if word == "STALE":
        return f"STALE: nothing is heard from the {cause}"
    if word == "ERROR":
        return f"ERROR: the {cause} reports a failure"
    return f"{word}: {cause}"


def mark_of(fault: Fault) -> str:
    """Return the symbol of a fault's criticality."""
    return CRITICAL_MARK if fault.critical else MARK


def kind_words(fault: Fault) -> str:
    """Say whether a fault is critical."""
    return "critical" if fault.critical else "non-critical"


def clock_words(seconds: float) -> str:
    """Write a time in a game as minutes and seconds."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"


def doing_words(fault: Fault, book: FaultBook, name: Name, moves: list[Move] | None = None) -> str:
    """Say what Tangy does about a fault at present (after some of its moves, if given)."""
    moves = fault.moves if moves is None else moves
    done = [move for move in moves if _DOING.get(move.kind) != ""]
    if not done:
        return f"next: {RECOVERY_WORDS[fault.recovery]}"
    move = done[-1]
    match move.kind:
        case "asked":
            return f"asking {_asked(fault, name)}{_tries(fault, move, book)}"
        case "remedied":
            words = REMEDIES.get(move.remedy, move.remedy)
            return f"{words}{_tries(fault, move, book)}"
        case "went on":
            return "going on without"
        case "escalated":
            return f"that did not help; next: {RECOVERY_WORDS[move.to]}"
    return _DOING.get(move.kind) or move_words(move)


def _asked(fault: Fault, name: Name) -> str:
    return name(fault.person) if fault.person is not None else "those at the table"


def _tries(fault: Fault, move: Move, book: FaultBook) -> str:
    tries = book.rule(fault.code).tries
    return f", try {move.attempt} of {tries}" if tries > 1 else ""


def banner_words(fault: Fault, doing: str) -> str:
    """Write the banner of a fault: symbol, criticality, name, and what is done about it."""
    return (
        f"{mark_of(fault).strip()} FAULT {kind_words(fault)}: {clean(fault.name)} -> {clean(doing)}"
    )


def state_words(fault: Fault) -> str:
    """Say in a word whether a fault is open, borne or over."""
    return {OPEN: "open", BORNE: "going on without", OVER: "over"}[fault.status]


def last_words(fault: Fault) -> str:
    """Say what happened last to a fault."""
    return move_words(fault.moves[-1]) if fault.moves else "nothing yet"


def searched(fault: Fault, name: Name) -> str:
    """Return everything by which a fault can be found."""
    person = name(fault.person) if fault.person is not None else ""
    return " ".join(
        (fault.name, fault.code, kind_words(fault), state_words(fault), fault.status, person)
    ).lower()


def banner_fault(supervision: Supervision) -> Fault | None:
    """Return the fault that the banner is about: the most urgent one that is there.

    One that Tangy goes on without is told of until somebody has seen it.
    """
    there = [f for f in supervision.waiting if not f.asks_only]
    there += [f for f in supervision.faults if f.status == BORNE and not f.acknowledged]
    return supervision.halted or (there[0] if there else None)


class Piece(NamedTuple):
    """One piece of evidence: of what, what was to be expected, and what was observed."""

    what: str
    expected: str
    observed: str


def evidence_of(fault: Fault, book: FaultBook, robot: Robot) -> list[Piece]:
    """Hold what was observed against what was to be expected."""
    rule = book.rule(fault.code)
    pieces: list[Piece] = []
    for key, value in fault.evidence.items():
        if key in CONTEXT or key.startswith("mismatch.") or key == "situation.shown":
            continue
        head, _, fact = key.partition(".")
        device = robot.devices.get(head)
        if device is not None and fact == "age":
            pieces.append(_age(device, value))
            continue
        if device is None:
            what = SYMPTOMS.get(key, key)
        elif fact == "state":
            what = device.label
        else:
            what = f"{device.label}, {device.facts[fact].says if fact in device.facts else fact}"
        pieces.append(Piece(what, _expected(key, value, rule), _observed(fact, value)))
    for one in fault.mismatches:
        wanted = " or ".join(one.expected) or "nothing known"
        pieces.append(Piece(f"{one.variable} after {one.behaviour}", wanted, one.seen))
    return pieces


def ages_of(fault: Fault, book: FaultBook, robot: Robot, health: Health) -> list[Piece]:
    """Say how old the newest data of a fault's device is, unless its evidence says so."""
    device = robot.devices.get(book.rule(fault.code).device)
    if device is None or f"{device.name}.age" in fault.evidence:
        return []
    return [_age(device, reading.age) for reading in health if reading.device == device.name]


def _age(device: Device, age: Fact) -> Piece:
    old = f"{age:.3g}" if isinstance(age, float) else str(age)
    expected = f"at most {device.stale_after:g} s old"
    return Piece(f"{device.label}, newest data", expected, f"{old} s old")


def _expected(key: str, value: Fact, rule: FaultRule) -> str:
    """Turn the condition by which a fault was recognised round."""
    if key.endswith(".state"):
        return "OK"
    conditions = [c for when in rule.when for c in when if c.key == key and c.holds({key: value})]
    return _otherwise(conditions[0]) if conditions else "nothing of the kind"


def _otherwise(condition: Condition) -> str:
    value = condition.value
    match condition.test:
        case "above":
            return f"at most {_written(value)}"
        case "below":
            return f"at least {_written(value)}"
        case "at_least":
            return f"less than {_written(value)}"
        case "is" if isinstance(value, bool):
            return _written(not value)
        case "is":
            return f"not {_written(value)}"
    return _written(value)


def _observed(fact: str, value: Fact) -> str:
    if fact != "state":
        return _written(value)
    return {STALE: "STALE: nothing comes from it", "ERROR": "ERROR: it reports a failure"}.get(
        str(value), str(value)
    )


def _written(value: Fact) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.2g}" if isinstance(value, float) else str(value)
