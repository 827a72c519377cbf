"""A fault and what was done about it: the record that console, log and reports share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, TypeAlias

from tangy_profiles.faults import FaultRule
from tangy_profiles.health import Fact
from tangy_profiles.person import MOST_PEOPLE, load_people
from tangy_profiles.store import Event, Store
from tangy_tui.learning.effects import Mismatch

FAULT = "fault"
RECOVERY = "recovery"
ACCEPTED = "effect accepted"
STAFF = "staff action"
"""What people did that is neither a behaviour nor a move: stopping the robot, letting it go on,
bringing a fault about."""

NAME = "{name}"
"""What stands for a person's name in the log, from which names can be forgotten."""
SOMEBODY = "somebody"

OPEN, BORNE, OVER = "open", "borne", "over"
"""What a fault can be: still to be dealt with; there, but Tangy goes on without; over."""

ENDINGS = frozenset(("recovered", "taught", "accepted", "cleared", "ended", "left"))
"""The moves after which a fault is over."""


@dataclass(frozen=True, slots=True)
class RecoveryEvent:
    """One step of a recovery: what, the how-manieth time, by whom, what was said, when (s)."""

    kind: str
    seconds: float
    attempt: int = 0
    by: str = ""
    to: str = ""
    speech: str = ""
    image: str = ""
    remedy: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return the move as `--json` prints it; what is empty is left out."""
        body = {name: getattr(self, name) for name in self.__slots__}
        return {name: value for name, value in body.items() if value or name == "seconds"}

    def called(self, name: str) -> RecoveryEvent:
        """Return the move with the person's name where the log only has a slot for it."""
        return replace(self, speech=_named(self.speech, name), image=_named(self.image, name))

    @classmethod
    def from_json(cls, body: Mapping[str, Any]) -> RecoveryEvent:
        """Read a move that `to_json` wrote."""
        return cls(**{name: body[name] for name in cls.__slots__ if name in body})


@dataclass
class Fault:
    """One occurrence of a fault.

    `seconds` is the time in the game at which it was diagnosed, `step` the last step before that,
    and `behaviour` what had been executed, if it was noticed by that. `why` is its evidence in
    words. `texts` are the name of the fault, what staff are told, and their steps; {name} stands
    in them for the person, who is `called` something: the log never holds a name.
    """

    id: str
    game: str
    code: str
    critical: bool
    recovery: str
    step: int
    seconds: float
    behaviour: str
    person: str | None
    called: str
    texts: tuple[str, ...]
    why: str
    evidence: Mapping[str, Fact]
    mismatches: tuple[Mismatch, ...]
    moves: list[RecoveryEvent] = field(default_factory=list)
    at: str = ""
    """When it was logged (ISO 8601, UTC)."""
    status: str = OPEN
    """Whether it is open, borne or over."""

    def add(self, move: RecoveryEvent) -> None:
        """Add what was done about it."""
        self.moves.append(move)
        if move.kind in ENDINGS:
            self.status = OVER
        elif move.kind == "went on":
            self.status = BORNE

    @property
    def name(self) -> str:
        """What the fault is called."""
        return _named(self.texts[0], self.called)

    @property
    def console(self) -> str:
        """What staff are told."""
        return _named(self.texts[1], self.called)

    @property
    def advice(self) -> tuple[str, ...]:
        """What staff should do, step by step."""
        return tuple(_named(text, self.called) for text in self.texts[2:])

    @property
    def unnamed(self) -> str:
        """The fault and what staff are told, in words that the log may keep."""
        return _named(f"{self.texts[0]}: {self.texts[1]}", SOMEBODY)

    @property
    def asks_only(self) -> bool:
        """Whether nothing went wrong, and Tangy only does not know what to do."""
        return "situation.shown" in self.evidence

    @property
    def acknowledged(self) -> bool:
        """Whether staff said that they have seen it."""
        return any(move.kind == "acknowledged" for move in self.moves)

    @property
    def succeeded(self) -> bool:
        """Whether it was recovered from, or Tangy went on with it as it should."""
        return self.status in (OVER, BORNE)

    @property
    def ladder(self) -> tuple[str, ...]:
        """The recoveries that were begun, from the first to the last that was needed."""
        return (self.recovery, *(move.to for move in self.moves if move.kind == "escalated"))

    def to_json(self) -> dict[str, Any]:
        """Return the fault as the log keeps it, without its moves."""
        return {
            "game": self.game,
            "fault": self.id,
            "code": self.code,
            "name": self.texts[0],
            "criticality": "critical" if self.critical else "non-critical",
            "recovery": self.recovery,
            "step": self.step,
            "seconds": self.seconds,
            "behaviour": self.behaviour,
            "console": self.texts[1],
            "why": self.why,
            "evidence": dict(self.evidence),
            "mismatches": [
                {
                    "behaviour": m.behaviour,
                    "variable": m.variable,
                    "expected": list(m.expected),
                    "seen": m.seen,
                }
                for m in self.mismatches
            ],
            "advice": list(self.texts[2:]),
        }

    def document(self) -> dict[str, Any]:
        """Return the fault with what was done about it, as `--json` prints it."""
        return {
            **self.to_json(),
            "name": self.name,
            "console": self.console,
            "advice": list(self.advice),
            "person": self.person,
            "status": self.status,
            "ladder": list(self.ladder),
            "moves": [move.to_json() for move in self.moves],
            "reason": f"{self.name}: {self.console}",
        }


@dataclass(frozen=True, slots=True)
class Diagnosed:
    """A fault was detected and diagnosed."""

    fault: Fault


@dataclass(frozen=True, slots=True)
class Moved:
    """Something was done about a fault, or happened to it."""

    fault: Fault
    move: RecoveryEvent


FaultEvent: TypeAlias = Diagnosed | Moved


def fault_documents(faults: Iterable[Fault], stopped: str | None) -> list[dict[str, Any]]:
    """Return what went wrong in a game, as `--json` prints it.

    Where Tangy only did not know what to do, that is told if it ended the game (`stopped` says
    why it ended).
    """
    told = list(faults)
    documents = [fault.document() for fault in told if not fault.asks_only]
    if stopped is None or any(m.kind == "given up" for f in told for m in f.moves):
        return documents
    asked = next((fault for fault in reversed(told) if fault.asks_only), None)
    return [*documents, {**(asked.document() if asked is not None else {}), "reason": stopped}]


def read_faults(store: Store, game: str | None = None) -> list[Fault]:
    """Read the faults of a game (of all games) with their moves from the log, in order."""
    return fold_faults(
        (
            event
            for event in store.events(FAULT, RECOVERY)
            if game is None or event.body["game"] == game
        ),
        store.names(),
    )


def fold_faults(events: Iterable[Event], names: Mapping[str, str]) -> list[Fault]:
    """Put faults and their moves together from their events; `names` are what people are called."""
    known = {**{person.id: person.name for person in load_people(MOST_PEOPLE)}, **names}
    found: dict[str, Fault] = {}
    for event in events:
        id = event.body["fault"]
        if event.kind == FAULT:
            found.setdefault(id, _read_fault(event, known))
        elif id in found:
            fault = found[id]
            fault.add(RecoveryEvent.from_json(event.body).called(fault.called))
    return list(found.values())


def _read_fault(event: Event, known: Mapping[str, str]) -> Fault:
    body = event.body
    return Fault(
        id=body["fault"],
        game=body["game"],
        code=body["code"],
        critical=body["criticality"] == "critical",
        recovery=body["recovery"],
        step=int(body["step"]),
        seconds=float(body["seconds"]),
        behaviour=body["behaviour"],
        person=event.person,
        called=known.get(event.person, event.person) if event.person else SOMEBODY,
        texts=(body["name"], body["console"], *body["advice"]),
        why=body["why"],
        evidence=body["evidence"],
        mismatches=tuple(
            replace(Mismatch(**one), expected=tuple(one["expected"])) for one in body["mismatches"]
        ),
        at=event.at,
    )


def rule_texts(rule: FaultRule, object: str, why: str) -> tuple[str, ...]:
    """Return the texts of a rule with object and evidence filled in, but not the person."""
    return tuple(
        rule.fill(text, name=NAME, object=object, why=why)
        for text in (rule.name, rule.console, *rule.advice)
    )


def _named(text: str, name: str) -> str:
    return text.replace(NAME, name)
