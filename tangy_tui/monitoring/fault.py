"""A fault and its recovery: the record that screens, log and reports share."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from tangy_profiles.codec import encode
from tangy_profiles.events import EventRecord
from tangy_profiles.faults import FaultRule
from tangy_profiles.game_records import NAME as NAME
from tangy_profiles.game_records import FaultDiagnosed, FaultMove, Mismatch, named
from tangy_profiles.game_records import RecoveryEvent as RecoveryEvent
from tangy_profiles.health import Fact
from tangy_profiles.person import MOST_PEOPLE, load_people
from tangy_profiles.store import Event, Store

SOMEBODY = "somebody"

FaultStatus: TypeAlias = Literal["open", "borne", "over"]
"""Status of a fault: open; tolerated, so that Tangy goes on; over."""

OPEN: FaultStatus = "open"
BORNE: FaultStatus = "borne"
OVER: FaultStatus = "over"

ENDINGS = frozenset(("recovered", "taught", "accepted", "cleared", "ended", "left"))
"""The moves that end a fault."""


@dataclass
class Fault:
    """One occurrence of a fault.

    `seconds` is the time in the game of the diagnosis, `step` the last step before it, and
    `behaviour` the behaviour after which it was detected, if any. `why` is the evidence in words.
    `texts` are the name of the fault, the message for staff, and their steps. In them {name} stands
    for the person, to be replaced by `called`, because the log never holds a name.
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
    real_time: bool = False
    """Whether the seconds of the game are seconds of the day."""
    status: FaultStatus = OPEN
    """Whether it is open, borne or over."""

    def add(self, move: RecoveryEvent) -> None:
        """Add a recovery event, and update the status."""
        self.moves.append(move)
        if move.kind in ENDINGS:
            self.status = OVER
        elif move.kind == "went on":
            self.status = BORNE

    @property
    def name(self) -> str:
        """The fault's name."""
        return named(self.texts[0], self.called)

    @property
    def console(self) -> str:
        """The message for staff."""
        return named(self.texts[1], self.called)

    @property
    def advice(self) -> tuple[str, ...]:
        """Steps for staff."""
        return tuple(named(text, self.called) for text in self.texts[2:])

    @property
    def unnamed(self) -> str:
        """The fault and the message for staff, without names, for the log."""
        return named(f"{self.texts[0]}: {self.texts[1]}", SOMEBODY)

    @property
    def asks_only(self) -> bool:
        """Whether nothing went wrong, and Tangy only does not know what to do."""
        return "situation.shown" in self.evidence

    @property
    def acknowledged(self) -> bool:
        """Whether staff have acknowledged it."""
        return any(move.kind == "acknowledged" for move in self.moves)

    @property
    def succeeded(self) -> bool:
        """Whether it was recovered from, or Tangy goes on with it as planned."""
        return self.status in (OVER, BORNE)

    @property
    def ladder(self) -> tuple[str, ...]:
        """The recoveries that were tried, in order."""
        return (self.recovery, *(move.to for move in self.moves if move.kind == "escalated"))

    def record(self) -> FaultDiagnosed:
        """Return the log record of the fault, without its moves."""
        return FaultDiagnosed(
            game=self.game,
            fault=self.id,
            code=self.code,
            name=self.texts[0],
            criticality="critical" if self.critical else "non-critical",
            recovery=self.recovery,
            step=self.step,
            seconds=self.seconds,
            behaviour=self.behaviour,
            console=self.texts[1],
            why=self.why,
            evidence=self.evidence,
            mismatches=self.mismatches,
            advice=self.texts[2:],
        )

    def document(self) -> dict[str, Any]:
        """Return the fault and its recovery as `--json` prints them."""
        return {
            **self.record().body,
            "name": self.name,
            "console": self.console,
            "advice": list(self.advice),
            "person": self.person,
            "status": self.status,
            "ladder": list(self.ladder),
            "moves": encode(self.moves),
            "reason": f"{self.name}: {self.console}",
        }


@dataclass(frozen=True, slots=True)
class Diagnosed:
    """A fault was detected and diagnosed."""

    fault: Fault


@dataclass(frozen=True, slots=True)
class Moved:
    """A recovery event of a fault."""

    fault: Fault
    move: RecoveryEvent


FaultEvent: TypeAlias = Diagnosed | Moved


def fault_documents(faults: Iterable[Fault], stopped: str | None) -> list[dict[str, Any]]:
    """Return the faults of a game, as `--json` prints them.

    A question about an unknown situation is included only if it ended the game (`stopped` says why
    it ended).
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
            for event in store.events(FaultDiagnosed, FaultMove)
            if game is None or getattr(event.record, "game", None) == game
        ),
        store.names(),
    )


def fold_faults(events: Iterable[Event[EventRecord]], names: Mapping[str, str]) -> list[Fault]:
    """Build faults with their moves from their events; `names` are people's names by id."""
    known = {**{person.id: person.name for person in load_people(MOST_PEOPLE)}, **names}
    found: dict[str, Fault] = {}
    for event in events:
        match event.record:
            case FaultDiagnosed(fault=id) as record:
                found.setdefault(id, _read_fault(event, record, known))
            case FaultMove(fault=id, move=move) if id in found:
                found[id].add(move.called(found[id].called))
    return list(found.values())


def _read_fault(
    event: Event[EventRecord], record: FaultDiagnosed, known: Mapping[str, str]
) -> Fault:
    return Fault(
        id=record.fault,
        game=record.game,
        code=record.code,
        critical=record.criticality == "critical",
        recovery=record.recovery,
        step=record.step,
        seconds=record.seconds,
        behaviour=record.behaviour,
        person=event.person,
        called=known.get(event.person, event.person) if event.person else SOMEBODY,
        texts=(record.name, record.console, *record.advice),
        why=record.why,
        evidence=record.evidence,
        mismatches=record.mismatches,
        at=event.at,
    )


def rule_texts(rule: FaultRule, object: str, why: str) -> tuple[str, ...]:
    """Return the texts of a rule with object and evidence filled in, but not the person."""
    return tuple(
        rule.fill(text, name=NAME, object=object, why=why)
        for text in (rule.name, rule.console, *rule.advice)
    )
