"""Fault recovery (III-C): climbs the ladder of each fault, rung by rung, until it is over.

The ladder is a list of recoveries in the fault's rule: continue (by an automatic remedy, or without
the broken device), ask a user, ask a teacher, halt and ask an expert. Every recovery is tried a
limited number of times; then the next one follows, and the expert comes last. So recovery always
terminates. Every event is logged before it is reported.
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Callable
from typing import TypeAlias
from uuid import uuid4

from tangy_profiles.faults import LEAVE_TO_STAFF, URGENCY, FaultRule, Remedy
from tangy_profiles.game_records import CallMade, FaultMove, MoveKind, named
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.health import STALE
from tangy_profiles.robot import LINK, Robot
from tangy_profiles.state import ActivityState
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, GameEvent
from tangy_tui.monitoring.detection import Detector, symptoms
from tangy_tui.monitoring.diagnosis import Diagnosis
from tangy_tui.monitoring.evidence import evidence_words
from tangy_tui.monitoring.fault import (
    BORNE,
    ENDINGS,
    NAME,
    OPEN,
    OVER,
    SOMEBODY,
    Diagnosed,
    Fault,
    FaultEvent,
    Moved,
    RecoveryEvent,
    rule_texts,
)

_LOG = logging.getLogger(__name__)

Event: TypeAlias = GameEvent | FaultEvent | CallMade

AGAIN = 3
"""After this many occurrences in a game, recovery starts one rung higher."""

DONE = ENDINGS - {"taught", "left"}
"""The moves that reset the counts of a person's unsuccessful requests."""

TO_TEACH = "Say what to do here, or look at what happened at the table."


class Recovery:
    """The faults of the current game and their recoveries; call `begin` for each game."""

    def __init__(
        self,
        game: Facilitation,
        detector: Detector,
        robot: Robot,
        store: Store,
        name: Callable[[str], str],
    ) -> None:
        self.faults: list[Fault] = []
        """All faults, in the order of diagnosis."""
        self.halted: Fault | None = None
        """The fault that halts the robot."""
        self.on_halt: Callable[[Fault], None] = lambda fault: None
        """Called with the fault that halts the robot."""
        self.on_release: Callable[[], None] = lambda: None
        """Called when the robot is no longer halted, or the game has ended."""
        self.hides_cards: Callable[[], bool] = lambda: False
        """Returns whether a device fault hides the cards now."""
        self._game = game
        self._detector = detector
        self._robot = robot
        self._store = store
        self.name_of = name
        self.begin()

    def begin(self, seconds: float = 0.0) -> None:
        """Reset for a game; `seconds` is the time in the game (s)."""
        self.faults = []
        self.halted = None
        self._passed = seconds
        self._there: list[Fault] = []  # those that are not over
        self._rules: dict[str, FaultRule] = {}
        self._rung: Counter[str] = Counter()
        self._tried: Counter[str] = Counter()
        self._times: Counter[tuple[str, str | None, str]] = Counter()

    @property
    def seconds(self) -> float:
        """The time in the current game, in s; at least the time played."""
        return max(self._passed, self._game.log.seconds)

    @seconds.setter
    def seconds(self, seconds: float) -> None:
        """Set the time in s."""
        self._passed = seconds

    def pass_time(self, seconds: float) -> None:
        """Advance the time by some s, at least to the time played."""
        self.seconds = self._passed + seconds

    @property
    def there(self) -> list[Fault]:
        """The faults that are not over: open ones first, by urgency."""
        return sorted(self._there, key=lambda f: (f.status == BORNE, self._rules[f.id].urgency))

    @property
    def waiting(self) -> list[Fault]:
        """The open faults, most urgent first.

        Faults of the robot come before those that concern a person.
        """
        there = [fault for fault in self._there if fault.status == OPEN]
        return sorted(there, key=lambda f: (URGENCY.index(self._rung_of(f)), f.person is not None))

    @property
    def ended(self) -> bool:
        """Whether the game has ended, reported or not."""
        return self._game.over or self._game.world.over

    def rule(self, fault: Fault) -> FaultRule:
        """Return the rule that diagnosed a fault."""
        return self._rules[fault.id]

    def knows(self, diagnosis: Diagnosis, person: str | None) -> bool:
        """Return whether a diagnosis is of a fault that is there already."""
        same = {diagnosis.rule.code, *diagnosis.rule.continues}
        return any(fault.code in same and fault.person == person for fault in self._there)

    def keep(self, diagnosis: Diagnosis, acted: Acted | None, person: str | None) -> list[Event]:
        """Record a new diagnosis as a fault; stop the robot first if it is critical."""
        rule = diagnosis.rule
        conditions = rule.matched(diagnosis.evidence) or ()
        seen = {k: v for k, v in diagnosis.evidence.items() if k not in diagnosis.beside}
        looks = self._game.observation.fused if diagnosis.mismatches else None
        label = self._game.world.activity.behaviour_words
        why = evidence_words(seen, diagnosis.mismatches, self._robot, conditions, looks, label)
        fault = Fault(
            id=uuid4().hex[:12],
            game=self._game.game,
            critical=rule.critical,
            code=rule.code,
            recovery=rule.recovery[0],
            step=self._game.steps,
            seconds=self.seconds,
            behaviour=acted.action.behaviour.name if acted is not None else "",
            person=person,
            why=why,
            called=self.name_of(person) if person is not None else SOMEBODY,
            texts=rule_texts(rule, self._game.world.activity.object, why),
            evidence=diagnosis.evidence,
            mismatches=diagnosis.mismatches,
            at=self._store.now().isoformat(),
            real_time=self._game.world.played_in != SIMULATED,
        )
        self._times[fault.code, fault.person, fault.behaviour] += 1
        times = self._times[fault.code, fault.person, fault.behaviour]
        self._rules[fault.id] = rule
        if rule.critical:
            self.remedy(fault, "halt")  # before logging, which can fail
        self._store.append(fault.record(), person=person)
        _LOG.warning("fault %s (%s): %s", fault.id, fault.code, fault.why)
        self.faults.append(fault)
        self._there.append(fault)
        told: list[Event] = [Diagnosed(fault)]
        if acted is not None and rule.recovery[0] in ("user", "teacher"):
            for _ in range((times - 1) // AGAIN):
                if self._rung_of(fault) != "expert":
                    told += self._escalate(fault)
        return told

    def _rung_of(self, fault: Fault) -> str:
        ladder = self._rules[fault.id].recovery
        rung = self._rung[fault.id]
        return ladder[rung] if rung < len(ladder) else "expert"

    def go_further(self, fault: Fault) -> list[Event]:
        """Make one move against a fault."""
        rule = self._rules[fault.id]
        if rule.device and not rule.remedy and self.solved(fault):
            return self.move(fault, RecoveryEvent("ended", self.seconds))
        match self._rung_of(fault):
            case "user":
                return self._ask_user(fault, rule)
            case "teacher":
                return self._ask_teacher(fault)
            case "continue":
                return self._go_on(fault, rule)
            case _:
                return self.halt_if_critical()

    def _ask_user(self, fault: Fault, rule: FaultRule) -> list[Event]:
        self._tried[fault.id] += 1
        attempt = self._tried[fault.id]
        aloud = rule.aloud if attempt % 2 else rule.aloud_again or rule.aloud
        speech, image = self._text(fault, aloud), self._text(fault, rule.image)
        move = RecoveryEvent("asked", self.seconds, attempt=attempt, speech=speech, image=image)
        told = self.move(fault, move)
        self.remedy(fault, "ask", move.called(fault.called))
        person = None if self.hides_cards() else fault.person
        if person is not None and not self.solved(fault):
            self._game.refused(person)
            self._detector.refused(person)
        return told + self._judge(fault, rule, attempt)

    def _go_on(self, fault: Fault, rule: FaultRule) -> list[Event]:
        if not rule.remedy:
            kind: MoveKind = "recovered" if self.solved(fault) else "went on"
            return self.move(fault, RecoveryEvent(kind, self.seconds))
        speech, image = self._text(fault, rule.aloud), self._text(fault, rule.image)
        if rule.recovery[0] != "continue":
            speech = image = ""  # they belong to the rung of asking a user
        self._tried[fault.id] += 1
        attempt = self._tried[fault.id]
        move = RecoveryEvent(
            "remedied",
            self.seconds,
            attempt=attempt,
            remedy=rule.remedy,
            speech=speech,
            image=image,
        )
        told = self.move(fault, move)
        self.remedy(fault, rule.remedy, move.called(fault.called))
        return told + self._judge(fault, rule, attempt)

    def _judge(self, fault: Fault, rule: FaultRule, attempt: int) -> list[Event]:
        """Check whether an attempt helped; after the last attempt, escalate."""
        if self.solved(fault):
            return self.move(fault, RecoveryEvent("recovered", self.seconds))
        if attempt < rule.tries:
            return []
        if rule.bearable and self._rung_of(fault) == "continue":
            return self.move(fault, RecoveryEvent("went on", self.seconds))
        return self._escalate(fault) + self.halt_if_critical()

    def supersede(self, fault: Fault) -> list[Event]:
        """End the faults of the same person whose symptoms a newer fault covers."""
        told: list[Event] = []
        spoken_for = self._rules[fault.id].symptoms
        for other in list(self._there):
            mine = {f"mismatch.{one.variable}" for one in other.mismatches}
            if other is fault or other.critical or fault.person is None:
                continue
            if other.person == fault.person and mine and mine <= spoken_for:
                told += self.move(other, RecoveryEvent("left", self.seconds))
        return told

    def _ask_teacher(self, fault: Fault) -> list[Event]:
        asked = self._game.ask(fault.console, TO_TEACH, fault.id)
        if not asked:
            return self._escalate(fault) + self.halt_if_critical()
        return [*self.move(fault, RecoveryEvent("teacher asked", self.seconds)), *asked]

    def _escalate(self, fault: Fault) -> list[Event]:
        tried, self._tried[fault.id] = self._tried[fault.id], 0
        self._rung[fault.id] += 1
        to = self._rung_of(fault)
        return self.move(fault, RecoveryEvent("escalated", self.seconds, attempt=tried, to=to))

    def halt_if_critical(self) -> list[Event]:
        """Halt the robot if the most urgent fault needs an expert."""
        fault = next(iter(self.waiting), None)
        if self.halted is not None or fault is None or self.ended:
            return []
        if self._rung_of(fault) != "expert":
            return []
        self.halted = fault
        self.remedy(fault, "halt")
        self.on_halt(fault)
        self._game.withdraw()
        return self.move(fault, RecoveryEvent("halted", self.seconds))

    def solved(self, fault: Fault) -> bool:
        """Return whether a fault is gone, as observed now."""
        rule = self._rules[fault.id]
        devices = self._detector.watch(self._game.world.health())
        if any(devices.get(f"{device}.state") == STALE for device in (LINK, *rule.devices)):
            return False  # a silent device does not show that it is gone
        if rule.fallback:
            return not symptoms({key: devices[key] for key in fault.evidence if key in devices})
        if rule.solved == "evidence gone" or fault.person is None:
            return rule.matched(devices) is None
        person, unread = fault.person, self._game.world.activity.unread

        def is_gone(state: ActivityState) -> bool:
            user = state.user(person)
            in_view = rule.solved == "card in view" and user.activity != unread
            return in_view or user.request == "ANR"

        return self._game.observation.shows(is_gone)

    def remedy(self, fault: Fault, kind: str, move: RecoveryEvent | None = None) -> None:
        """Let the world carry out a recovery; `move` has its texts."""
        device = self._rules[fault.id].device
        said = ("", "") if move is None else (move.speech, move.image)
        self.seconds += self._game.world.recover(
            Remedy(kind, fault.code, device, fault.person, *said)
        )

    def leave_to_staff(self, person: str) -> None:
        """Close a person's request again, because an earlier fault was left to staff."""
        for fault in self.faults:
            rule = self._rules[fault.id]
            if fault.person == person and rule.remedy == LEAVE_TO_STAFF:
                said = named(self._text(fault, rule.aloud), fault.called)
                image = named(self._text(fault, rule.image), fault.called)
                remedy = Remedy(LEAVE_TO_STAFF, fault.code, "", person, said, image)
                self.seconds += self._game.world.recover(remedy)
                return

    def _text(self, fault: Fault, text: str) -> str:
        """Fill in a text of a rule, except the person's name."""
        rule, object = self._rules[fault.id], self._game.world.activity.object
        return rule.fill(text, name=NAME, object=object, why=fault.why)

    def release(self) -> None:
        """Record that no fault halts the robot any more."""
        self.halted = None
        self.on_release()

    def leave_open(self) -> list[Event]:
        """Record that the game ended with faults still open."""
        self.on_release()
        told: list[Event] = []
        for fault in list(self._there):
            if fault.status == OPEN and not any(m.kind == "given up" for m in fault.moves):
                told += self.move(fault, RecoveryEvent("left open", self.seconds))
        return told

    def move(self, fault: Fault, move: RecoveryEvent) -> list[Event]:
        """Log a recovery event of a fault, and return it."""
        moved = FaultMove(game=fault.game, fault=fault.id, move=move)
        self._store.append(moved, person=fault.person)
        _LOG.info("fault %s (%s): %s", fault.id, fault.code, move.kind)
        told = move.called(fault.called)
        fault.add(told)
        if fault.status == OVER:
            self._there.remove(fault)
            if move.kind in DONE:
                self._detector.forgive(fault.person)
        return [Moved(fault, told)]
