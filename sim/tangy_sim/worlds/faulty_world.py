"""A simulated world with injected faults.

Faults use their own random stream, so that without faults the games equal those of
`SimulatedWorld`, behaviour for behaviour.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.faults import Remedy
from tangy_profiles.health import Health
from tangy_profiles.robot import Robot
from tangy_profiles.state import FRONT, ActivityState, Outcome, Response
from tangy_sim.worlds import injection
from tangy_sim.worlds.compliance import Preferences
from tangy_sim.worlds.devices import readings
from tangy_sim.worlds.fault_occasions import OccasionWorld, PresentFault
from tangy_sim.worlds.injection import KINDS, FaultKind, Injection, silencing
from tangy_sim.worlds.injection_log import InjectionLog
from tangy_sim.worlds.pending_injections import ToCome
from tangy_sim.worlds.users import SimulatedUser, UserModel

HELPS = 0.8
"""P(somebody at the table does what Tangy asks for when it needs help)."""
FINDS_ITSELF = 0.9
"""P(the robot is localised after one turn on the spot)."""
STARTS_AGAIN = 0.5
"""P(a device works again after a restart)."""

OUT_OF_SIGHT = "card-out-of-sight"
SECONDS = {"ask": 25.0, "call expert": 300.0, "spin": 10.0, "restart": 5.0, "other requests": 5.0}
"""Duration of remedies in s; others take no time."""

NOTICED = 2.0
"""Time in s after which a fault that devices show at once is noticed: its data is stale by then,
and a robot that stops by itself has stopped. A manually injected fault starts that long ago."""


class FaultyWorld(OccasionWorld):
    """A simulated world with faults, which end with each game."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        users: UserModel | None = None,
        preferences: Preferences | None = None,
        injections: Sequence[Injection] = (),
        robot: Robot | None = None,
    ) -> None:
        self.injections = tuple(injections)
        self._chance = Random(f"{seed}/faults").random
        super().__init__(
            activity, people, seed=seed, users=users, preferences=preferences, robot=robot
        )

    def begin(self) -> ActivityState:
        """Begin a game without active faults."""
        state = super().begin()
        self.present = {}
        self.came: list[tuple[int, str]] = []
        """Faults that have started, with their steps."""
        self.injection_log = InjectionLog()
        self._to_come = ToCome(self.injections, self._chance)
        self._unheard: list[SimulatedUser] = []
        self._by_word = False  # whether requests are taken by voice and keys
        self._refused = False
        self._health: tuple[float, tuple[str, ...], Health] | None = None
        return state

    @property
    def pending_injections(self) -> list[str]:
        """Injections that have not occurred in this game, except random ones."""
        return self._to_come.words

    # ------------------------------------------------------------------- faults come and go

    def inject(self, kind: str) -> None:
        """Inject a fault manually: now if a device shows it, otherwise as soon as it can show.

        Raises:
            KeyError: there is no such kind.
        """
        chosen = KINDS[kind]
        if chosen.shows in (injection.AT_ONCE, injection.DRIVING):
            self._set_in(chosen, self.seconds - NOTICED)
        else:
            self._to_come.add(chosen)

    def lift(self, kind: str) -> None:
        """End a fault, active or pending."""
        self.present.pop(kind, None)
        self._to_come.drop(kind)
        if kind == "requests-silent":
            self._hear()

    def _set_in(self, kind: FaultKind, since: float) -> None:
        self.present[kind.name] = PresentFault(kind, since, self._whom(kind))
        self.came.append((self.tracker.step + 1, kind.name))
        self.injection_log.came(kind, self.tracker.step + 1, self.seconds)

    def _whom(self, kind: FaultKind) -> str | None:
        if kind.shows in (injection.LOOKING, injection.ASKING, injection.CLOSING):
            return self.tracker.state().attended
        return None

    def _let_faults_come(self, action: Action) -> None:
        for kind in self._to_come.due(
            self.tracker.step + 1, lambda kind: self.can_show(kind, action)
        ):
            if kind.name not in self.present:
                self._set_in(kind, self.seconds)

    # --------------------------------------------------------------------- remedies meanwhile

    def execute(self, action: Action) -> Outcome:
        """Let the robot try to execute an action."""
        if self.over:
            return super().execute(action)
        known = set(self.present)
        self._let_faults_come(action)
        present = self.present
        self.injection_log.look(
            self.tracker.step + 1,
            lambda kind: kind.name in present and self.can_show(kind, action),
        )
        before, waited = self.tracker.state(), tuple(self.tracker.queue)
        self._refused = False
        mute = {"voice-dead", "screen-dead"} <= present.keys() or "link-lost" in present
        vain = present.get("no-effect")
        if any(fault.kind.stops for name, fault in present.items() if name not in known):
            outcome = self._in_vain(action, completed=False, seconds=NOTICED)
        elif mute and not action.behaviour.drives:
            outcome = self._in_vain(action, completed=False)
        elif vain is not None and self.can_show(vain.kind, action):
            outcome = self._in_vain(action, completed=True)
            self.lift("no-effect")
        else:
            outcome = super().execute(action)
        if "carried-off" in present and not present["carried-off"].shown:
            self._carry_off()
        if "request-withdrawn" in present and before.attended is not None:
            self._withdraw(before.attended, waited)
        return outcome

    def _in_vain(self, action: Action, *, completed: bool, seconds: float | None = None) -> Outcome:
        """Let time pass (by default the action's duration) with an action that has no effect."""
        calls = self.users.away_calls if self.tracker.place != FRONT else 1.0
        if seconds is not None:
            calls = seconds / self.users.call_seconds
        self.tracker.executed(action.behaviour, succeeded=False)
        self._pass(calls)
        return Outcome(completed, calls * self.users.call_seconds, (), None)

    def _pass(self, calls: float) -> None:
        self._now += calls
        if self._now >= self._next_ask:
            self._let_people_ask()

    def _carry_off(self) -> None:
        """Move the robot to another place."""
        elsewhere = [place for place in (FRONT, *self.people) if place != self.tracker.place]
        self.tracker.arrive(elsewhere[int(self._chance() * len(elsewhere))])
        self._in_view = False
        self.present["carried-off"].shown = True

    def _withdraw(self, attended: str, waited: Sequence[str]) -> None:
        """Let a waiting person withdraw their request unseen."""
        queue = self.tracker.queue
        others = [person for person in waited if person != attended and person in queue]
        if others:
            queue.remove(others[int(self._chance() * len(others))])
            self.lift("request-withdrawn")

    def _drives(self) -> bool:
        """Return whether the robot can drive now."""
        for fault in self.present.values():
            if fault.kind.shows == injection.DRIVING:
                fault.shown = True
        return not any(fault.kind.holds for fault in self.present.values())

    def _go_to_user(self, action: Action) -> tuple[int, ...] | None:
        return super()._go_to_user(action) if self._drives() else None

    def _go_to_front(self, action: Action) -> tuple[int, ...] | None:
        return super()._go_to_front(action) if self._drives() else None

    def read_card(self) -> None:
        """Take one look at the card beside the robot, which a fault may hide."""
        hidden = self.present.get(OUT_OF_SIGHT)
        if hidden is not None and hidden.person is None:
            hidden.person = self.tracker.place
        mine = hidden is not None and hidden.person == self.tracker.place
        if mine or any(fault.kind.blinds for fault in self.present.values()):
            self._in_view = False
            self.tracker.seen = None
        else:
            super().read_card()

    def _refuses(self) -> bool:
        fault = self.present.get("never-complies")
        if fault is None:
            return False
        if fault.person is None and self.tracker.place in self.tracker.queue:
            fault.person = self.tracker.place
        self._refused = fault.person == self.tracker.place
        return self._refused

    def _bring_card_closer(self, action: Action) -> tuple[int, ...] | None:
        return () if self._refuses() else super()._bring_card_closer(action)

    def _correct(self, errors: Callable[[SimulatedUser], int], verb: str) -> tuple[int, ...] | None:
        if self.tracker.seen is None or not self._refuses():
            return super()._correct(errors, verb)
        player = self.players[self.tracker.place]
        return player.cells(errors(player)) or None

    def _respond(self, beside: str, action: Action) -> Response | None:
        response = super()._respond(beside, action)
        if response is not None and self._refused:
            late = 2 * self.activity.patience
            return response._replace(followed=False, complied=False, seconds=late)
        if self.tracker.seen is None and action.behaviour.about_card:
            return None  # the person's response cannot be seen
        return response

    def _ask(self, player: SimulatedUser) -> bool:
        if "requests-silent" in self.present and not self._by_word:
            if player not in self._unheard:
                self._unheard.append(player)
            return False
        return super()._ask(player)

    def _hear(self) -> None:
        """Process the requests that were made while they could not be seen."""
        unheard, self._unheard = self._unheard, []
        for player in unheard:
            self.tracker.ask(player.id)

    def _count(self, behaviour: Behaviour, succeeded: bool) -> None:
        tracker = self.tracker
        seen = tracker.seen
        super()._count(behaviour, succeeded)
        stuck = self.present.get("request-stuck")
        if stuck is not None and tracker.closed is not None:
            if stuck.person is None:
                stuck.person = tracker.closed
            if stuck.person == tracker.closed:
                tracker.queue.insert(0, tracker.closed)
                tracker.closed, tracker.seen = None, seen
                stuck.shown = True

    # ---------------------------------------------------------------------- health and recovery

    def health(self) -> Health:
        """Return the readings of the devices, with the symptoms of visible faults."""
        showing = [
            (fault.kind.symptom, fault)
            for fault in self.present.values()
            if fault.kind.symptom and (fault.shown or fault.kind.shows != injection.DRIVING)
        ]
        if not showing:
            return super().health()
        key = tuple(fault.kind.name for _, fault in showing)
        if self._health is None or self._health[:2] != (self._now, key):
            told = [(symptom, self.seconds - fault.since) for symptom, fault in showing]
            self._health = (self._now, key, readings(told, self._well))
        return self._health[2]

    def recover(self, remedy: Remedy) -> float:
        """Let the robot, a user or an expert handle a fault; return the duration in s."""
        seconds = SECONDS.get(remedy.kind, 0.0)
        if seconds and not self.over:
            self._pass(seconds / self.users.call_seconds)
        lost = "link-lost" in self.present
        for kind in self._to_come.due_in_recovery():
            if kind.name not in self.present:
                self._set_in(kind, self.seconds - NOTICED)
        found = [f.kind.name for f in self.present.values() if f.kind.code == remedy.fault]
        match remedy.kind:
            case "ask":
                for name in found:
                    if KINDS[name].helped and self._chance() < HELPS:
                        self._is_helped(name, remedy.person)
                if remedy.fault == OUT_OF_SIGHT and self.tracker.place in self.tracker.queue:
                    self.read_card()  # it may have been there while Tangy could not see
            case "call expert":
                if lost:
                    self.lift("link-lost")  # first, as with a live robot
                found = list(_MUTE) if remedy.fault == "mute" and not found else found
                for name in [*found, *silencing(remedy.fault, list(self.present))]:
                    self._is_helped(name, remedy.person)
            case "spin":
                if "carried-off" in found and self._chance() < FINDS_ITSELF:
                    self.lift("carried-off")
            case "restart":
                for name in found:
                    if self._chance() < STARTS_AGAIN:
                        self.lift(name)
            case "replan":
                self.lift("path-detour")
            case "other requests":
                self._by_word = True
                self._hear()
            case "set aside" | "leave to staff" if remedy.person in self.tracker.queue:
                self._set_aside(remedy.person)
        return seconds

    def _is_helped(self, kind: str, person: str | None) -> None:
        self.lift(kind)
        tracker = self.tracker
        if kind == OUT_OF_SIGHT and tracker.place in tracker.queue:
            self.read_card()
        elif kind == "request-stuck" and person in tracker.queue:
            self._set_aside(person)

    def _set_aside(self, person: str) -> None:
        self.tracker.queue.remove(person)
        self.lift("request-stuck")
        if person == self.tracker.place:
            self.tracker.seen = None


_MUTE = ("voice-dead", "screen-dead")
