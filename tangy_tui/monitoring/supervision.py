"""Supervision (III-C): a game that is run with an eye on what goes wrong, and what then.

`Supervision` stands in for the `Facilitation` that it holds: screens, lines and scripts begin,
step and answer through it. It looks before and after every behaviour, diagnoses, and recovers
step by step; while the robot is halted nothing is executed until staff clear the fault. All of it
is in the log before it is told.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import TypeAlias
from uuid import uuid4

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.errors import TangyError
from tangy_profiles.faults import URGENCY, Evidence, FaultBook, FaultRule, Remedy
from tangy_profiles.health import Fact
from tangy_profiles.robot import Robot
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import (
    Acted,
    Facilitation,
    GameEnded,
    GameEvent,
    Taught,
    Unsure,
)
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.verifying import Verifier
from tangy_tui.monitoring import accepted
from tangy_tui.monitoring.detection import Detector, together
from tangy_tui.monitoring.diagnosis import Diagnosis, diagnose
from tangy_tui.monitoring.fault import (
    BORNE,
    FAULT,
    NAME,
    OPEN,
    OVER,
    RECOVERY,
    SOMEBODY,
    Diagnosed,
    Fault,
    FaultEvent,
    Move,
    Moved,
    rule_texts,
)
from tangy_tui.monitoring.telling import evidence_words
from tangy_tui.world import World

Event: TypeAlias = GameEvent | FaultEvent

AGAIN = 3
"""A recovery that had to be repeated so often in a game begins with its next rung."""

MOST_MOVES = 200
"""After so many moves against faults without a behaviour in between, a game is ended."""

TO_TEACH = "Say what to do here, or look at what happened at the table."


class Supervision:
    """Games under execution monitoring. `begin` a game, then `step` until it is `over`.

    While `halted` is a fault, the robot stands still: `acknowledge` it, `call_expert`, and `clear`
    it, or `give_up` the game. While `question` is set, a teacher is asked: `answer`, `accept`, or
    `give_up`.
    """

    def __init__(
        self,
        game: Facilitation,
        book: FaultBook,
        robot: Robot,
        store: Store,
        effects_of: Callable[[Policy], Effects],
        name: Callable[[str], str] = str,
    ) -> None:
        """Prepare to supervise.

        Args:
            game: what runs the games.
            book: the fault rules.
            effects_of: learns the effects that a policy's demonstrations show.
            name: what a person is called.
        """
        self.game = game
        self.book = book
        self.robot = robot
        self.faults: list[Fault] = []
        """The faults of the present game, in the order in which they were diagnosed."""
        self.halted: Fault | None = None
        """The critical fault because of which the robot stands still."""
        self.seconds = 0.0
        """The time in the present game, in s."""
        self._there: list[Fault] = []  # those that are not over
        self._idle = 0
        self._store = store
        self._effects_of = effects_of
        self._name = name
        self._detector = Detector(game.world.activity, robot, effects_of(game.policy))
        self._rules: dict[str, FaultRule] = {}
        self._rung: Counter[str] = Counter()
        self._tried: Counter[str] = Counter()
        self._times: Counter[tuple[str, str | None, str]] = Counter()
        self._seen: Evidence | None = None
        self._acted: Acted | None = None

    # ------------------------------------------------------------- what it stands in for

    @property
    def world(self) -> World:
        """The world in which the games are played."""
        return self.game.world

    @property
    def policy(self) -> Policy:
        """The policy by which Tangy acts; a new one after each answer."""
        return self.game.policy

    @property
    def persuasion(self) -> Persuasion:
        """What is believed of the people, and how strategies are chosen."""
        return self.game.persuasion

    @property
    def games(self) -> int:
        """How many games were begun."""
        return self.game.games

    @property
    def steps(self) -> int:
        """How many behaviours the present game has had."""
        return self.game.steps

    @property
    def over(self) -> bool:
        """Whether the game is over."""
        return self.game.over

    @property
    def question(self) -> Unsure | None:
        """What Tangy asks a teacher."""
        return self.game.question

    def verifier(self) -> Verifier:
        """Make the door through which a teacher answers."""
        return self.game.verifier()

    # ---------------------------------------------------------------------- running games

    def begin(self) -> list[Event]:
        """Begin the next game, in which nothing is known to be wrong."""
        told: list[Event] = list(self.game.begin())
        self.faults, self._there = [], []
        self.halted = None
        self.seconds = 0.0
        self._rules.clear()
        self._rung.clear()
        self._tried.clear()
        self._times.clear()
        self._seen = self._acted = None
        self._idle = 0
        self._detector.begin()
        return told

    def step(self) -> list[Event]:
        """Do the next thing: one move against the most urgent fault, or else one behaviour."""
        if self.over or self.halted is not None or self.question is not None:
            return []
        told = self.look()
        if self.halted is not None:
            return told
        fault = self._next()
        if fault is not None:
            self._idle += 1
            if self._idle > MOST_MOVES:
                return told + self._stop(f"{MOST_MOVES} moves against faults led nowhere.")
            return told + self._recover(fault)
        self._idle = 0
        if not self.game.asks:
            told += self._foresee()
        return told + self._after(self.game.step())

    def look(self) -> list[Event]:
        """Look at the devices, without doing anything: tell what is new there.

        It may be called as often as one likes, also while the robot is halted or asks.
        """
        if self.over:
            return []
        evidence = self._detector.watch(self.world.health())
        if evidence is self._seen:
            return []
        self._seen = evidence
        told: list[Event] = []
        for fault in list(self._there):
            reported = fault.status == BORNE and fault.evidence.keys() & evidence.keys()
            if reported and self._rules[fault.id].matched(evidence) is None:
                told += self._move(fault, Move("ended", self.seconds))
        return told + self._take(diagnose(self.book, evidence), None)

    @property
    def status(self) -> tuple[str, str]:
        """The worst that there is, rolled up, and its cause.

        HALTED, ASKS or WARN name a fault; STALE or ERROR a device about which there is none.
        """
        if self.halted is not None:
            return "HALTED", self.halted.name
        open_now = [] if self.over else self._there
        there = sorted(open_now, key=lambda f: (f.status == BORNE, self._rules[f.id].urgency))
        if self.question is not None:
            return "ASKS", there[0].name if there else ""
        if there:
            return "WARN", there[0].name
        return self._detector.worst(self.world.health())

    @property
    def waiting(self) -> list[Fault]:
        """The faults that are still to be dealt with, the most urgent first."""
        there = [fault for fault in self._there if fault.status == OPEN]
        return sorted(there, key=lambda fault: URGENCY.index(self._rung_of(fault)))

    # ------------------------------------------------------------------- what people do

    def acknowledge(self, by: str, fault: Fault | None = None) -> list[Event]:
        """Let staff say that they have seen a fault (default: the one that halts the robot)."""
        fault = fault or self.halted
        if fault is None or fault.acknowledged:
            return []
        return self._move(fault, Move("acknowledged", self.seconds, by=by))

    def call_expert(self, by: str) -> list[Event]:
        """Call the expert about the fault that halts the robot."""
        fault = self.halted
        if fault is None:
            return []
        told = self.acknowledge(by)
        told += self._move(fault, Move("expert called", self.seconds, by=by))
        self._remedy(fault, "call expert")
        return told + self.look()

    def clear(self, by: str) -> list[Event]:
        """Let the robot move again, if what halted it was seen and is gone.

        A fault that is still there stays; one that nobody acknowledged as well.
        """
        fault = self.halted
        if fault is None or not fault.acknowledged:
            return []
        told = self.look()
        if not self._solved(fault):
            return told + self._move(fault, Move("still there", self.seconds, by=by))
        told += self._move(fault, Move("cleared", self.seconds, by=by))
        self._remedy(fault, "resume")
        self.halted = None
        return told + self._halt_if_critical()

    def answer(self, behaviour: Behaviour, target: str | None, teacher: str) -> list[Event]:
        """Do what a teacher answered, and go on."""
        question = self.question
        if question is None:
            return []
        events = self.game.answer(behaviour, target, teacher)
        taught = any(isinstance(event, Taught) for event in events)
        told: list[Event] = []
        if taught:
            told += self._answered(question, Move("taught", self.seconds, by=teacher))
        found = self._after(events)  # by what was expected before the answer was learnt
        if taught:
            self._detector.effects = self._effects_of(self.policy)
        return found + told

    def accept(self, by: str) -> list[Event]:
        """Let a teacher say that what happened is all right; it is expected from now on."""
        question, acted = self.question, self._acted
        fault = self._asked_about(question)
        if question is None or fault is None or acted is None or not fault.mismatches:
            return []
        with self._store.transaction():
            accepted.accept(self._store, self.world.activity, fault, acted, by)
            told = self._answered(question, Move("accepted", self.seconds, by=by))
        self.game.withdraw()
        self._detector.effects = self._effects_of(self.policy)
        return told

    @property
    def acceptable(self) -> bool:
        """Whether what Tangy asks about can be said to be all right."""
        fault = self._asked_about(self.question)
        return fault is not None and bool(fault.mismatches) and self._acted is not None

    def give_up(self) -> list[Event]:
        """End a game in which Tangy asks or is halted, and nobody helps."""
        halted, question = self.halted, self.question
        if self.over or (halted is None and question is None):
            return []
        told: list[Event] = []
        fault = halted or self._asked_about(question)
        if fault is not None:
            told += self._move(fault, Move("given up", self.seconds))
        if halted is not None:
            return told + self._stop(f"Tangy was halted. {halted.unnamed}")
        if fault is not None and question is not None and question.fault:
            return told + self._stop(f"{fault.unnamed} {question.remedy}")
        return told + self._leave_open() + list(self.game.give_up())

    def leave(self) -> list[Event]:
        """End a game that is going on because whoever watches it leaves."""
        if self.over:
            return []
        return self._leave_open() + list(self.game.leave())

    def _stop(self, reason: str) -> list[Event]:
        return self._leave_open() + list(self.game.stop(reason))

    # ------------------------------------------------------------------ seeing and explaining

    def _after(self, events: Sequence[GameEvent]) -> list[Event]:
        """Hold what was done against what was to be expected."""
        told: list[Event] = []
        for event in events:
            if isinstance(event, GameEnded):
                told += self._leave_open()
            told.append(event)
            if isinstance(event, Acted):
                self._acted = event
                self.seconds += event.outcome.seconds
                execution, mismatches = self._detector.compare(event)
                devices = self._detector.watch(self.world.health())
                known, self._seen = self._seen, devices
                if execution or devices is not known:
                    evidence = together(devices, execution)
                    told += self._take(diagnose(self.book, evidence, mismatches), event)
            elif isinstance(event, Unsure) and not event.fault:
                found = diagnose(self.book, {"situation.shown": False})
                told += self._take(found, None)
                for fault in self.waiting[:1]:
                    told += self._move(fault, Move("teacher asked", self.seconds))
        return told

    def _foresee(self) -> list[Event]:
        """Where nobody can be asked, say why the game is about to end: nobody has shown this."""
        decision = self.policy.decide(self.world.observe().situation)
        if decision.sure:
            return []
        return self._take(diagnose(self.book, {"situation.shown": False}), None)

    def _take(self, found: Sequence[Diagnosis], acted: Acted | None) -> list[Event]:
        """Keep the diagnoses that are new; halt at once if one is critical."""
        told: list[Event] = []
        for diagnosis in found:
            by_device = bool(diagnosis.rule.device)
            person = acted.state.attended if acted is not None and not by_device else None
            if not self._known(diagnosis, person):
                told += self._keep(diagnosis, acted, person)
        if told:
            told += self._halt_if_critical()
            for fault in self.waiting[1:]:
                if not any(move.kind == "kept" for move in fault.moves):
                    told += self._move(fault, Move("kept", self.seconds))
        return told

    def _known(self, diagnosis: Diagnosis, person: str | None) -> bool:
        """Say whether this is a fault that is there already, and not another one."""
        return any(
            fault.code == diagnosis.rule.code and fault.person == person for fault in self._there
        )

    def _keep(self, diagnosis: Diagnosis, acted: Acted | None, person: str | None) -> list[Event]:
        rule = diagnosis.rule
        conditions = rule.matched(diagnosis.evidence) or ()
        why = evidence_words(diagnosis.evidence, diagnosis.mismatches, self.robot, conditions)
        fault = Fault(
            id=uuid4().hex[:12],
            game=self.game.game,
            critical=rule.critical,
            code=rule.code,
            recovery=rule.recovery[0],
            step=self.steps,
            seconds=self.seconds,
            behaviour=acted.action.behaviour.name if acted is not None else "",
            person=person,
            why=why,
            called=self._name(person) if person is not None else SOMEBODY,
            texts=rule_texts(rule, self.world.activity.object, why),
            evidence=diagnosis.evidence,
            mismatches=diagnosis.mismatches,
            at=self._store.now().isoformat(),
        )
        self._times[fault.code, fault.person, fault.behaviour] += 1
        times = self._times[fault.code, fault.person, fault.behaviour]
        self._rules[fault.id] = rule
        if rule.critical and not self.over:
            self._remedy(fault, "halt")  # before it is written down, which can fail
        try:
            self._store.append(FAULT, fault.to_json(), person=person)
        except TangyError:
            self._seen = None  # so that the next look finds it again
            raise
        self.faults.append(fault)
        self._there.append(fault)
        told: list[Event] = [Diagnosed(fault)]
        if times > AGAIN and acted is not None and rule.recovery[0] in ("user", "teacher"):
            told += self._escalate(fault)
        return told

    # ------------------------------------------------------------------------ recovering

    def _rung_of(self, fault: Fault) -> str:
        ladder = self._rules[fault.id].recovery
        rung = self._rung[fault.id]
        return ladder[rung] if rung < len(ladder) else "expert"

    def _next(self) -> Fault | None:
        waiting = self.waiting
        return waiting[0] if waiting else None

    def _recover(self, fault: Fault) -> list[Event]:
        """Make one move against a fault."""
        rule = self._rules[fault.id]
        if rule.device and not rule.remedy and self._solved(fault):
            return self._move(fault, Move("ended", self.seconds))
        match self._rung_of(fault):
            case "user":
                return self._ask_user(fault, rule)
            case "teacher":
                return self._ask_teacher(fault)
            case "continue":
                return self._go_on(fault, rule)
            case _:
                return self._halt_if_critical()

    def _ask_user(self, fault: Fault, rule: FaultRule) -> list[Event]:
        speech, image = self._text(fault, rule.aloud), self._text(fault, rule.image)
        self._tried[fault.id] += 1
        attempt = self._tried[fault.id]
        move = Move("asked", self.seconds, attempt=attempt, speech=speech, image=image)
        told = self._move(fault, move)
        self._remedy(fault, "ask", move.called(fault.called))
        return told + self._judge(fault, rule, attempt)

    def _go_on(self, fault: Fault, rule: FaultRule) -> list[Event]:
        if not rule.remedy:
            kind = "went on" if rule.bearable else "recovered"
            return self._move(fault, Move(kind, self.seconds))
        speech, image = self._text(fault, rule.aloud), self._text(fault, rule.image)
        if rule.recovery[0] != "continue":
            speech = image = ""  # they are for the rung on which a user is asked
        self._tried[fault.id] += 1
        attempt = self._tried[fault.id]
        move = Move(
            "remedied",
            self.seconds,
            attempt=attempt,
            remedy=rule.remedy,
            speech=speech,
            image=image,
        )
        told = self._move(fault, move)
        self._remedy(fault, rule.remedy, move.called(fault.called))
        if rule.remedy == "set aside":
            self._detector.forgive(fault.person)
        return told + self._judge(fault, rule, attempt)

    def _judge(self, fault: Fault, rule: FaultRule, attempt: int) -> list[Event]:
        """See whether a try has helped; where it has not, and was the last one, go further."""
        if self._solved(fault):
            return self._move(fault, Move("recovered", self.seconds))
        if attempt < rule.tries:
            return []
        if rule.bearable and self._rung_of(fault) == "continue":
            return self._move(fault, Move("went on", self.seconds))
        return self._escalate(fault) + self._halt_if_critical()

    def _ask_teacher(self, fault: Fault) -> list[Event]:
        asked = self.game.ask(fault.console, TO_TEACH, fault.id)
        if not asked:
            return self._escalate(fault) + self._halt_if_critical()
        return [*self._move(fault, Move("teacher asked", self.seconds)), *asked]

    def _escalate(self, fault: Fault) -> list[Event]:
        self._rung[fault.id] += 1
        self._tried[fault.id] = 0
        return self._move(fault, Move("escalated", self.seconds, to=self._rung_of(fault)))

    def _halt_if_critical(self) -> list[Event]:
        """Stand still if what is most urgent needs an expert."""
        fault = self._next()
        if self.halted is not None or fault is None or self.over:
            return []
        if self._rung_of(fault) != "expert":
            return []
        self.halted = fault
        self._remedy(fault, "halt")
        self.game.withdraw()
        return self._move(fault, Move("halted", self.seconds))

    def _solved(self, fault: Fault) -> bool:
        """Say whether a fault is gone, by what can be observed now."""
        rule = self._rules[fault.id]
        if rule.solved == "evidence gone" or fault.person is None:
            return rule.matched(self._detector.watch(self.world.health())) is None
        user = self.world.observe().user(fault.person)
        closed = user.request == "ANR"
        if rule.solved == "card in view":
            return closed or user.activity != self.world.activity.unread
        return closed

    def _remedy(self, fault: Fault, kind: str, move: Move | None = None) -> None:
        device = self._rules[fault.id].device
        said = ("", "") if move is None else (move.speech, move.image)
        self.seconds += self.world.recover(Remedy(kind, fault.code, device, fault.person, *said))

    def _text(self, fault: Fault, text: str) -> str:
        rule, object = self._rules[fault.id], self.world.activity.object
        return rule.fill(text, name=NAME, object=object, why=fault.why)

    def _asked_about(self, question: Unsure | None) -> Fault | None:
        """Return the fault about which Tangy asks a teacher."""
        if question is None:
            return None
        asked = [
            fault
            for fault in self._there
            if fault.status == OPEN and any(move.kind == "teacher asked" for move in fault.moves)
        ]
        return next((fault for fault in asked if question.fault in ("", fault.id)), None)

    def _answered(self, question: Unsure, move: Move) -> list[Event]:
        fault = self._asked_about(question)
        return self._move(fault, move) if fault is not None else []

    def _leave_open(self) -> list[Event]:
        """Say of the faults that nobody has dealt with that the game ended before."""
        told: list[Event] = []
        for fault in list(self._there):
            if fault.status == OPEN and not any(m.kind == "given up" for m in fault.moves):
                told += self._move(fault, Move("left open", self.seconds))
        return told

    def _move(self, fault: Fault, move: Move) -> list[Event]:
        body: dict[str, Fact | str] = {"game": fault.game, "fault": fault.id, **move.to_json()}
        self._store.append(RECOVERY, body, person=fault.person)
        told = move.called(fault.called)
        fault.add(told)
        if fault.status == OVER:
            self._there.remove(fault)
        return [Moved(fault, told)]
