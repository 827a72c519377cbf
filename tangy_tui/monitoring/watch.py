"""Fault watch of a game (III-C): compares observations with expectations, and explains them.

It runs detection and diagnosis after each behaviour, and whenever a device's reading changes. A new
diagnosis becomes a fault, which `Recovery` handles.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from tangy_profiles.errors import TangyError
from tangy_profiles.faults import LEAVE_TO_STAFF, Evidence, FaultBook
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted, GameEvent, Unsure
from tangy_tui.learning.effects import Mismatch
from tangy_tui.monitoring.detection import OTHERS, Detector, together
from tangy_tui.monitoring.diagnosis import Diagnosis, diagnose
from tangy_tui.monitoring.fault import BORNE, Fault, RecoveryEvent
from tangy_tui.monitoring.recovery import Event, Recovery
from tangy_tui.monitoring.secondary_symptoms import SecondarySymptoms

NOT_SHOWN: Evidence = {"situation.shown": False}
"""The evidence that a situation was never demonstrated."""

MOST_CUT_SHORT = 5
"""Behaviours in a row that the program's own silence may cut short before that is a fault."""

HIDING = frozenset(("mismatch.card", "mismatch.what was asked about"))
"""Symptoms explained by a device fault that hides cards: an unseen response is no refusal then."""


class FaultWatch:
    """Finds the faults of a game; call `begin` for each game."""

    def __init__(
        self, game: Facilitation, book: FaultBook, detector: Detector, recovery: Recovery
    ) -> None:
        self.book = book
        self.acted: dict[str, Acted] = {}
        """The behaviour after which a fault was detected, by fault id."""
        self.awake: Callable[[], bool] = lambda: True
        """Returns False after the program was frozen; then no device is judged."""
        self._game = game
        self._detector = detector
        self._recovery = recovery
        self._seen: Evidence | None = None
        self._cut_short = 0
        self._secondary = SecondarySymptoms(book, detector.devices)
        recovery.hides_cards = self._hides_cards

    def begin(self) -> None:
        """Reset for a new game."""
        self.acted.clear()
        self._seen = None
        self._cut_short = 0
        self._secondary.begin()
        self._detector.begin()

    @property
    def devices(self) -> Evidence:
        """The current evidence of the devices."""
        return self._detector.watch(self._game.world.health())

    def look(self) -> list[Event]:
        """Check the devices without acting, and return the new faults."""
        if self._game.over or not self.awake():
            return []
        evidence = self.devices
        if evidence is self._seen:
            return []
        self._seen = evidence
        told: list[Event] = []
        for fault in self._recovery.there:
            reported = fault.status == BORNE and fault.evidence.keys() & evidence.keys()
            if reported and self._recovery.rule(fault).matched(evidence) is None:
                told += self._recovery.move(fault, RecoveryEvent("ended", self._recovery.seconds))
        return told + self._take(self._diagnose(evidence), None)

    def look_after(self, fault: Fault) -> list[Event]:
        """Check the symptoms that a fault had explained, now that staff cleared it."""
        if self._secondary.end(fault.code):
            self._seen = None
        return self.look()

    def after(self, events: Sequence[GameEvent], *, ordered: bool = False) -> list[Event]:
        """Check a behaviour against its expected effects; end a finished game.

        If it was `ordered` by staff (a STOP, or staff took over), the program's own silence cut it
        short, or it was obsolete, its effects are neither a fault nor a refusal.
        """
        told: list[Event] = []
        for event in events:
            told.append(event)
            if isinstance(event, Acted):
                no_fault = self._was_cut_short(event) or event.outcome.obsolete or ordered
                told += self._take_in(event) if no_fault else self._compare(event)
            elif isinstance(event, Unsure) and not event.fault:
                told += self._take(diagnose(self.book, NOT_SHOWN), None)
                for fault in self._recovery.waiting[:1]:
                    told += self._recovery.move(
                        fault, RecoveryEvent("teacher asked", self._recovery.seconds)
                    )
        if not self._game.over and self._game.world.over:
            told += self._recovery.leave_open() + list(self._game.finish())
        return told

    def _was_cut_short(self, acted: Acted) -> bool:
        """Return whether the program's own silence cut a behaviour short, and it is tried again."""
        self._cut_short = self._cut_short + 1 if acted.outcome.cut_short else 0
        return 0 < self._cut_short <= MOST_CUT_SHORT

    def refused(self, fault: Fault) -> list[Event]:
        """Check, after a request, whether a person has reached the limit of requests."""
        person = fault.person
        asked = any(move.kind == "asked" for move in fault.moves)
        if person is None or self._game.over or not asked:
            return []
        return self._take(diagnose(self.book, self._detector.refusals(person)), None, person)

    def spare(self) -> list[Event]:
        """Leave a person alone who has reached the limit of requests."""
        if not self._detector.spent:
            return []
        state = self._game.world.observe()
        person = state.attended
        doubted = person in self._detector.doubted
        if person is None or not (doubted or self._detector.spent_for_game(person)):
            return []
        behaviours = self._game.world.activity.behaviours
        behaviour = behaviours.get(self._game.policy.decide(state.situation).behaviour)
        asks = behaviour is not None and behaviour.persuades and not behaviour.only_talks
        if not asks or state.place != person:
            return []
        if doubted:
            self._recovery.leave_to_staff(person)
            return []
        return self._take(diagnose(self.book, self._detector.refusals(person)), None, person)

    def foresee(self) -> list[Event]:
        """Without a teacher, explain why the game is about to end: the situation is unknown."""
        decision = self._game.policy.decide(self._game.look().situation)
        if decision.sure:
            return []
        return self._take(diagnose(self.book, NOT_SHOWN), None) + self._recovery.leave_open()

    def _take_in(self, acted: Acted) -> list[Event]:
        """Record the state after an action that staff ordered; only devices are judged."""
        self._recovery.pass_time(acted.outcome.seconds)
        self._detector.take_in(acted.after)
        return self.look()

    def _compare(self, acted: Acted) -> list[Event]:
        self._recovery.pass_time(acted.outcome.seconds)
        known, self._seen = self._seen, self.devices
        execution, mismatches = self._detector.compare(acted, explained=self._hides_cards())
        if not execution and self._seen is known:
            return []
        evidence = together(self._seen, execution)
        return self._take(self._diagnose(evidence, mismatches), acted)

    def _hides_cards(self) -> bool:
        """Return whether a device fault explains why a card cannot be seen."""
        faults = diagnose(self.book, self.devices)
        return any(not HIDING.isdisjoint(one.rule.also) for one in faults)

    def _diagnose(self, evidence: Evidence, mismatches: Sequence[Mismatch] = ()) -> list[Diagnosis]:
        """Diagnose the symptoms that no earlier fault explains."""
        unexplained = self._secondary.without(evidence, lambda: self._game.world.seconds)
        found = diagnose(self.book, unexplained, mismatches)
        self._secondary.take(found, unexplained)
        return found

    def _take(
        self, found: Sequence[Diagnosis], acted: Acted | None, whose: str | None = None
    ) -> list[Event]:
        """Record new diagnoses; halt at once if one is critical.

        Args:
            found: the diagnoses.
            acted: the behaviour after which they were detected.
            whose: the person concerned, if not the one the behaviour attended.
        """
        told: list[Event] = []
        attended = acted.state.attended if acted is not None else whose
        for diagnosis in found:
            person = None if diagnosis.rule.device else self._whose(diagnosis, attended)
            if self._recovery.knows(diagnosis, person):
                continue
            try:
                told += self._recovery.keep(diagnosis, acted, person)
            except TangyError:
                self._seen = None  # so that the next check finds it again
                raise
            fault = self._recovery.faults[-1]
            if diagnosis.rule.quiet:
                told += self._recovery.go_further(fault)
            told += self._recovery.supersede(fault)
            if diagnosis.rule.remedy == LEAVE_TO_STAFF and person is not None:
                self._detector.doubted.add(person)
            if acted is not None and diagnosis.mismatches:
                self.acted[fault.id] = acted
        if told and not self._recovery.ended:
            told += self._recovery.halt_if_critical()
            for fault in self._recovery.waiting[1:]:
                if not any(move.kind == "kept" for move in fault.moves):
                    told += self._recovery.move(
                        fault, RecoveryEvent("kept", self._recovery.seconds)
                    )
        return told

    def _whose(self, diagnosis: Diagnosis, attended: str | None) -> str | None:
        """Return the one person a diagnosis is about, or None."""
        if not diagnosis.mismatches or any(m.variable != OTHERS for m in diagnosis.mismatches):
            return attended
        withdrew = self._detector.withdrew
        return withdrew[0] if len(withdrew) == 1 else None
