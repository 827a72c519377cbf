"""Supervision (III-C): runs a game with fault detection and recovery.

`Supervision` wraps a `Facilitation` and has the same interface: screens, the line mode and scripts
begin, step and answer through it. `FaultWatch` diagnoses faults before and after every behaviour,
and `Recovery` handles them; people act through the methods here. While the robot is halted, nothing
is executed until staff clear the fault. Every event is logged before it is reported.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from tangy_profiles.behaviour import Behaviour
from tangy_profiles.contacts import EXPERT
from tangy_profiles.faults import Evidence, FaultBook
from tangy_profiles.past_game import PastGame
from tangy_profiles.process_log import serving
from tangy_profiles.robot import Robot
from tangy_profiles.staff_records import StaffAction, StaffActionKind
from tangy_profiles.store import Store
from tangy_tui.interaction.facilitation import MOST_STEPS, Facilitation
from tangy_tui.interaction.game_events import Taught, Unsure
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.verification import Verifier
from tangy_tui.monitoring import accepted
from tangy_tui.monitoring.calls import FIRST_SECONDS, Calls
from tangy_tui.monitoring.detection import Detector
from tangy_tui.monitoring.fault import OPEN, Fault, RecoveryEvent
from tangy_tui.monitoring.recovery import Event as Event
from tangy_tui.monitoring.recovery import Recovery
from tangy_tui.monitoring.watch import FaultWatch
from tangy_tui.world import World

MOST_CLEARINGS = 5
"""The game ends if a fault comes back after this many clearings."""

MOST_MOVES = 200
"""A game ends after this many consecutive recovery moves without a behaviour."""


class Supervision:
    """Games under execution monitoring: `begin` a game, then `step` until it is `over`.

    While `halted` is a fault, the robot is stopped: `acknowledge` it, `call_expert`, and `clear`
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
        to_come: Sequence[str] = (),
    ) -> None:
        """Prepare to supervise.

        Args:
            game: runs the games.
            book: the fault rules.
            robot: its profile.
            store: the log.
            effects_of: learns the effects from a policy's demonstrations.
            name: returns a person's name.
            to_come: faults that will be injected, for the log.
        """
        game.looked_over = True
        self.game = game
        self.robot = robot
        self._idle = 0
        self._to_come = tuple(to_come)
        self.store = store
        self.effects_of = effects_of
        self.detector = Detector(game.world.activity, robot, effects_of(game.policy))
        game.contradicts = self.detector.contradicts
        game.changes.on_change = self.detector.take_in
        self.recovery = Recovery(game, self.detector, robot, store, name)
        self._interrupted = False
        self.watch = FaultWatch(game, book, self.detector, self.recovery)
        self._clearings: Counter[str] = Counter()
        self._stops = 0
        self.calls: Calls | None = None
        """Calls people when the robot is halted; None in simulated games."""

    @property
    def book(self) -> FaultBook:
        """The fault rules."""
        return self.watch.book

    @property
    def faults(self) -> list[Fault]:
        """The faults of the current game, in the order of diagnosis."""
        return self.recovery.faults

    @property
    def halted(self) -> Fault | None:
        """The fault that halts the robot."""
        return self.recovery.halted

    @property
    def seconds(self) -> float:
        """The time in the current game, in s."""
        return self.recovery.seconds

    # ------------------------------------------------------ the interface of Facilitation

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
        """The beliefs about people, and the choice of strategies."""
        return self.game.persuasion

    @property
    def games(self) -> int:
        """How many games were begun."""
        return self.game.games

    @property
    def steps(self) -> int:
        """How many behaviours were executed in the current game."""
        return self.game.steps

    @property
    def over(self) -> bool:
        """Whether the game is over."""
        return self.game.over

    @property
    def question(self) -> Unsure | None:
        """The open question to a teacher, or None."""
        return self.game.question

    def verifier(self) -> Verifier:
        """Make the verifier of a teacher's answers."""
        return self.game.verifier()

    # ---------------------------------------------------------------------- running games

    def begin(self, past: PastGame | None = None, by: str = "") -> list[Event]:
        """Begin the next game, or continue a past one, without any known fault.

        Raises:
            NotResumable: the world cannot restore the state of the past game.
        """
        told = list[Event](self.game.begin() if past is None else self.game.resume(past, by))
        self.recovery.begin(0.0 if past is None else past.seconds)
        self.watch.begin()
        self._clearings.clear()
        self._idle = 0
        if self._to_come:
            self.note("faults planned", "", detail=", ".join(self._to_come))
        return told

    def step(self) -> list[Event]:
        """Make one move against the most urgent fault, or else carry out one behaviour."""
        with serving():
            return self._step()

    def _step(self) -> list[Event]:
        if self.over or self.halted is not None or self.question is not None:
            return []
        told = self.look()
        if self.halted is not None:
            return told
        fault = next(iter(self.waiting), None)
        if fault is not None:
            self._idle += 1
            if self._idle > MOST_MOVES:
                return told + self._stop(f"{MOST_MOVES} moves against faults led nowhere.")
            told += self.recovery.go_further(fault)
            told += self.watch.refused(fault)
            return told + self._end_if_hopeless()
        self._idle = 0
        if self.steps >= MOST_STEPS:
            return told + self._stop(f"The game did not end within {MOST_STEPS} steps.")
        if not self.game.asks:
            told += self.watch.foresee()
        if spared := self.watch.spare():
            return told + spared
        stops = self._stops
        events = self.game.step()
        told += self.watch.after(events, ordered=self._stops != stops)
        return told + self._end_if_hopeless()

    def stopped_by_staff(self) -> None:
        """Record a STOP: the interrupted behaviour is no fault, and its effects are not checked."""
        self._stops += 1

    def interrupt(self) -> None:
        """Leave the game where it is, so that another supervision can resume it from the log."""
        self.game.over = self._interrupted = True

    def look(self) -> list[Event]:
        """Check the devices without acting, and return the new faults.

        It may be called at any rate, also while the robot is halted or asks.
        """
        told = self.watch.look() + self._end_if_hopeless()
        news = [] if self.calls is None else self.calls.take_news()
        return [*told, *(one for one in news if one.game == self.game.game)]

    @property
    def status(self) -> tuple[str, str]:
        """The worst current state, and its cause.

        HALTED, ASKS or WARN name a fault; STALE or ERROR a device without a fault.
        """
        if self.halted is not None:
            return "HALTED", self.halted.name
        there = [] if self.over else self.recovery.there
        if self.question is not None:
            return "ASKS", there[0].name if there else ""
        if there:
            return "WARN", there[0].name
        return self.detector.worst(self.world.health())

    @property
    def devices(self) -> Evidence:
        """The current evidence of the devices."""
        return self.watch.devices

    @property
    def waiting(self) -> list[Fault]:
        """The open faults, most urgent first."""
        return self.recovery.waiting

    # ------------------------------------------------------------------- actions of people

    def acknowledge(self, by: str, fault: Fault | None = None) -> list[Event]:
        """Acknowledge a fault (default: the one that halts the robot)."""
        fault = fault or self.halted
        if fault is None or fault.acknowledged:
            return []
        return self.recovery.move(fault, RecoveryEvent("acknowledged", self.seconds, by=by))

    def call_expert(self, by: str) -> list[Event]:
        """Log that staff call the expert about the halt, call them, and check the devices again."""
        fault = self.halted
        if fault is None:
            return []
        told = self.acknowledge(by)
        told += self.recovery.move(fault, RecoveryEvent("expert called", self.seconds, by=by))
        if self.calls is not None:
            self.calls.call(EXPERT, fault, FIRST_SECONDS)
        self.recovery.remedy(fault, "call expert")
        return told + self.look()

    def reached(self, by: str) -> bool:
        """Record that staff reached the expert by other means; return whether one is named."""
        fault, calls = self.halted, self.calls
        return fault is not None and calls is not None and calls.reached(EXPERT, fault, by)

    def call_by(self, calls: Calls) -> None:
        """Call people when the robot halts, and when staff ask for the expert."""
        self.calls = calls
        self.recovery.on_halt, self.recovery.on_release = calls.begin, calls.end

    def clear(self, by: str) -> list[Event]:
        """Let the robot move again, if the fault that halted it was acknowledged and is gone.

        Otherwise the fault stays.
        """
        fault = self.halted
        if fault is None or not fault.acknowledged:
            return []
        told = self.look()
        self.recovery.remedy(fault, "look again")
        if not self.recovery.solved(fault):
            return told + self.recovery.move(
                fault, RecoveryEvent("still there", self.seconds, by=by)
            )
        told += self.watch.look_after(fault)
        told += self.recovery.move(fault, RecoveryEvent("cleared", self.seconds, by=by))
        self.recovery.remedy(fault, "resume")
        self.recovery.release()
        self._clearings[fault.code] += 1
        told += self.recovery.halt_if_critical()
        return told + self._end_if_hopeless()

    def note(self, did: StaffActionKind, by: str, **what: Any) -> None:
        """Log an action of staff in a game, or in one that is interrupted (see `StaffAction`)."""
        if not self.over or self._interrupted:
            game, now = self.game, max(self.seconds, self.game.log.seconds)  # after the last step
            self.store.append(StaffAction(game=game.game, did=did, by=by, seconds=now, **what))

    def answer(self, behaviour: Behaviour, target: str | None, teacher: str) -> list[Event]:
        """Carry out a teacher's answer, and go on."""
        with serving():
            return self._answer(behaviour, target, teacher)

    def _answer(self, behaviour: Behaviour, target: str | None, teacher: str) -> list[Event]:
        told = self.look()  # faults that occurred before the answer come first
        question = self.question
        if question is None:
            return told
        stops, chosen = self._stops, question.decision
        wanted = bool(question.fault) and self._asked_about(question) is None
        otherwise = wanted and behaviour.name != chosen.behaviour  # staff's choice, unasked
        said = RecoveryEvent(
            "taught", self.seconds, by=teacher, answer=behaviour.name, target=target or ""
        )
        told += self._answered(question, said)  # at once: the behaviour may take a while
        events = self.game.answer(behaviour, target, teacher)
        self._idle = 0
        taught = any(isinstance(event, Taught) for event in events)
        ordered = otherwise or self._stops != stops
        # compare with the effects expected before the answer was learnt
        found = self.watch.after(events, ordered=ordered)
        if taught:
            self.detector.effects = self.effects_of(self.policy)
        return told + found + self._end_if_hopeless()

    def accept(self, by: str) -> list[Event]:
        """Accept an observed effect: it is expected from now on."""
        told = self.look()
        question, fault = self.question, self._asked_about(self.question)
        if question is None or fault is None or not self.acceptable:
            return told
        with self.store.transaction():
            acted = self.watch.acted[fault.id]
            accepted.accept(self.store, self.world.activity, fault, acted, by)
            told += self._answered(question, RecoveryEvent("accepted", self.seconds, by=by))
        self.game.withdraw()
        self.detector.effects = self.effects_of(self.policy)
        return told

    @property
    def acceptable(self) -> bool:
        """Whether a teacher may accept the observed effect: no rule explains it."""
        fault = self._asked_about(self.question)
        unexplained = fault is not None and fault.code == self.book.fallback.code
        return unexplained and fault is not None and fault.id in self.watch.acted

    def give_up(self) -> list[Event]:
        """End a game in which Tangy asks or is halted, because nobody helps."""
        halted, question = self.halted, self.question
        if self.over or (halted is None and question is None):
            return []
        told: list[Event] = []
        fault = halted or self._asked_about(question)
        if fault is not None:
            told += self.recovery.move(fault, RecoveryEvent("given up", self.seconds))
        if halted is not None:
            return told + self._stop(f"Tangy was halted. {halted.unnamed}")
        if fault is not None and question is not None and question.fault:
            return told + self._stop(f"{fault.unnamed} {question.remedy}")
        return told + self.recovery.leave_open() + list(self.game.give_up())

    def leave(self, *, ends: bool = False) -> list[Event]:
        """End a running game because its operator leaves, or because staff end it (`ends`)."""
        if self.over:
            return []
        return self.recovery.leave_open() + list(self.game.leave(ends=ends))

    def _stop(self, reason: str) -> list[Event]:
        return self.recovery.leave_open() + list(self.game.stop(reason))

    def _end_if_hopeless(self) -> list[Event]:
        """End a game that halts again and again for a cleared fault."""
        fault = self.halted
        if fault is None or self.over or self._clearings[fault.code] < MOST_CLEARINGS:
            return []
        told = self.recovery.move(fault, RecoveryEvent("given up", self.seconds))
        times = f"It was cleared {MOST_CLEARINGS} times and came back."
        return told + self._stop(f"Tangy was halted. {fault.unnamed} {times}")

    # -------------------------------------------------------------------------- the teacher

    def _asked_about(self, question: Unsure | None) -> Fault | None:
        """Return the fault that the question to a teacher is about."""
        if question is None:
            return None
        asked = [
            fault
            for fault in self.recovery.there
            if fault.status == OPEN and any(move.kind == "teacher asked" for move in fault.moves)
        ]
        return next((fault for fault in asked if question.fault in ("", fault.id)), None)

    def _answered(self, question: Unsure, move: RecoveryEvent) -> list[Event]:
        fault = self._asked_about(question)
        if fault is None and move.answer:  # staff took over
            self.note("answered", move.by, person=move.target, detail=move.answer)
        return self.recovery.move(fault, move) if fault is not None else []
