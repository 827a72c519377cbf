"""A world on the bench: injects faults into the devices, and scores perception against the truth.

The bench knows the ground truth, the robot does not. Perception is scored after each reading
(`PerceptionScore`).
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import hypot
from random import Random
from typing import Any

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_client.response_watch import PATIENCES
from tangy_hw.robot_client.staff_card_reports import ReportedCard, reported_card
from tangy_profiles.behaviour import Action
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import BENCH, GameWorld
from tangy_profiles.health import OK
from tangy_profiles.past_game import PastGame
from tangy_profiles.state import ActivityState, Outcome
from tangy_sim.device_simulator.tablet import Tablet
from tangy_sim.worlds import injection
from tangy_sim.worlds.injection import KINDS, FaultKind, Injection
from tangy_sim.worlds.injection_log import InjectionLog
from tangy_sim.worlds.pending_injections import ToCome
from tangy_tui.app.device_simulator import BenchError, DeviceSimulator

EXPERT_SECONDS = 60.0  # that an expert's visit takes on the bench
NOTICED_SECONDS = 12.0  # of real time, for devices that show a fault only after real time


@dataclass
class PerceptionScore:
    """Counts of correct and wrong readings, identities and poses."""

    reads: Counter[str] = field(default_factory=Counter)
    identities: Counter[str] = field(default_factory=Counter)
    off: list[float] = field(default_factory=list)
    """Distance in m between believed and true position after each drive, arrived or not."""

    def to_json(self) -> dict[str, Any]:
        """Return the score as `tangy live --json` prints it."""
        off = sorted(self.off)

        def quantile(share: float) -> float | None:
            return round(off[min(len(off) - 1, int(share * len(off)))], 4) if off else None

        return {
            "reads": {name: self.reads[name] for name in ("right", "hidden", "wrong")},
            "identities": {name: self.identities[name] for name in ("right", "unknown", "wrong")},
            "pose_error_m": {"median": quantile(0.5), "p95": quantile(0.95)},
        }


class BenchedWorld(LiveWorld):
    """A live world on simulated devices. All faults are lifted between games."""

    played_in: GameWorld = BENCH
    bench: DeviceSimulator
    injections: Sequence[Injection] = ()

    def on(
        self, bench: DeviceSimulator, injections: Sequence[Injection] = (), seed: int = 1
    ) -> BenchedWorld:
        """Attach the bench, and set the faults to inject in each game."""
        self.bench = bench
        self.injections = tuple(injections)
        self.score = PerceptionScore()
        self.came: list[tuple[int, str]] = []
        self.injection_log = InjectionLog()
        self._chance = Random(f"{seed}/faults").random
        self._to_come = ToCome((), self._chance)
        self._left: tuple[Injection, ...] | None = None
        self.cards.looked = self._check
        if self.eyes is not None:
            self.eyes.answer = self._told_by_staff
        self._heard = 0  # number of spoken requests passed on so far
        self._listens = False
        self._tablet: Tablet | None = None
        self._open_tablet()
        return self

    def _told_by_staff(self, person: str) -> ReportedCard | None:
        """Report a person's card as staff at the table would.

        After a request they wait until the card has changed, or the person has had time.
        """
        there = self.truth()["people"][person]
        numbers = self.numbers_on(there["card"]) or ()
        told = reported_card(self.activity, self.called, numbers, there["marked"])
        assert self.eyes is not None  # noqa: S101 - they ask for it
        waited = self.link.time - self.eyes.began
        waits = told == self.eyes.before and waited < PATIENCES * self.activity.patience
        return None if waits else told

    def _open_tablet(self) -> None:
        """Open the page of the chest screen, again after a restart of the robot process."""
        if self._tablet is not None:
            self._tablet.close()
        screen, code = self.link.screen, self.link.code
        self._tablet = Tablet(screen, code, self._read) if screen else None
        self._switch_tablet()

    def _read(self, text: str) -> None:
        """Let the simulated people read what the tablet shows."""
        with suppress(BenchError):  # it is being closed
            self.bench.do("read", text=text)

    def leave(self) -> None:
        """Close the tablet's page."""
        if self._tablet is not None:
            self._tablet.close()

    def begin(self) -> ActivityState:
        """Begin a game on the bench, with new cards and without faults."""
        self.cards.dealt.deal(self.bench.do("begin")["cards"])
        self.link.do("fail", device="navigator", state="OK")
        self._switch_tablet()
        if any(r.device == "voice" and r.state != OK for r in self.health()):
            self.link.do("restart", device="voice")  # it counts as dead until it has spoken
        self.came = []
        self.injection_log = InjectionLog()
        self._heard, self._listens = 0, False
        self._to_come = ToCome(self.injections, self._chance)
        self._pass_until(lambda: not self.commands.diagnosed(self.health()))
        state = super().begin()
        self.bench.do("rules", away=sorted(self.away), **self._wins)
        return state

    def resume(self, past: PastGame) -> ActivityState:
        """Resume an interrupted game with its cards, and inject the faults still to come."""
        known = {**past.cards.seen, **past.cards.given}
        cards = {person: card for person, card in known.items() if person in self.people}
        called = past.called(self.activity)
        self.bench.do("rules", called=called, cards=cards)  # before the robot looks at a card
        super().resume(past)
        asking = [one for one in past.asked(self.activity) if one not in self.away]
        away = sorted(self.away)
        self.bench.do("rules", called=called, cards=cards, asking=asking, away=away, **self._wins)
        left, self._left = self._left, None
        self._to_come = ToCome(self.injections if left is None else left, self._chance)
        return self.observe()

    def carry_over(self, before: BenchedWorld) -> None:
        """Inject only the faults still to come if the game of a world `before` is resumed here."""
        self._left = before._to_come.left

    @property
    def pending_injections(self) -> list[str]:
        """The injections that have not occurred in this game, except those by chance."""
        return self._to_come.words

    @property
    def present(self) -> list[str]:
        """The kinds of the present faults."""
        return [fault["kind"] for fault in self.truth()["faults"]]

    def truth(self) -> dict[str, Any]:
        """Return the ground truth."""
        told: dict[str, Any] = self.bench.do("truth")["truth"]
        return told

    def observe(self) -> ActivityState:
        """Return the joint state; simulated staff pass on spoken requests for help."""
        if self._listens and not self.over:
            spoken = self.truth()["spoken"]
            for person in spoken[self._heard :]:
                self.requests.ask_for(person)
            self._heard = len(spoken)
        return super().observe()

    # ------------------------------------------------------------------------ faults

    def inject(self, kind: str) -> None:
        """Inject a fault; if devices show it at once, wait until they do.

        Raises:
            KeyError: there is no such kind.
        """
        chosen = KINDS[kind]
        self.bench.do("inject", kind=kind)
        self.came.append((self.tracker.step + 1, kind))
        self.injection_log.came(chosen, self.tracker.step + 1, self.seconds)
        if kind == "navigation-failed":  # the bench has no navigation program
            self.link.do("fail", device="navigator", state="ERROR")
        self._switch_tablet()
        if chosen.shows == injection.AT_ONCE and self.link.setup.stepped:
            self._let_show(chosen)

    def _let_show(self, kind: FaultKind) -> None:
        """Wait until the devices show a fault; needed if the bench is stepped."""
        self._pass_until(lambda: kind.code in self.commands.diagnosed(self.health()))

    def _pass_until(self, holds: Callable[[], bool]) -> None:
        """Let time pass until a condition holds, or the timeout is over."""
        until = time.monotonic() + NOTICED_SECONDS
        while not holds() and time.monotonic() < until:
            if self.link.setup.stepped:
                with suppress(DeviceError):
                    self.link.do("wait", seconds=0.2)
            self.link.beat()

    def lift(self, kind: str) -> None:
        """Lift a fault."""
        self.bench.do("lift", kind=kind)
        if kind == "navigation-failed":
            self.link.do("fail", device="navigator", state="OK")
        self._switch_tablet()

    def _switch_tablet(self) -> None:
        if self._tablet is not None:
            self._tablet.on = "screen-dead" not in self.present

    def can_show(self, kind: FaultKind, action: Action) -> bool:
        """Return whether a fault of this kind would be noticed if it came with an action."""
        tracker, behaviour = self.tracker, action.behaviour
        beside = tracker.place in tracker.queue
        match kind.shows:
            case injection.DRIVING:
                return behaviour.drives
            case injection.LOOKING if self._never_complies(tracker.place):
                return False  # nothing is expected of a card whose owner does not do as asked
            case injection.LOOKING:
                if tracker.seen is None:
                    return beside and behaviour.shows_card
                return behaviour.corrects
            case injection.ASKING:
                return beside and behaviour.about_card and tracker.allows(behaviour)
            case injection.CLOSING | injection.WAITING if "requests-silent" in self.present:
                return False  # no sensor sees whether a sign is up
            case injection.CLOSING:
                if behaviour.closes != "always" or tracker.seen != self._settled:
                    return False
                return beside and tracker.place in self.truth()["asking"]  # its sign is still up
            case injection.WAITING:
                return len(tracker.queue) > 1
            case injection.MOVING_ON:
                return beside and behaviour.corrects
            case _:
                return True

    @property
    def _settled(self) -> str:
        return self.activity.card_states[-1].name

    def _never_complies(self, person: str) -> bool:
        there = {fault["kind"]: fault["person"] for fault in self.truth()["faults"]}
        return there.get("never-complies") in ("", person)

    def execute(self, action: Action) -> Outcome:
        """Inject the faults that are due, and carry out the action."""
        if not self.over:
            self._let_faults_come(action)
            step = self.tracker.step + 1
            self.injection_log.look(
                step, lambda kind: kind.name in self.present and self.can_show(kind, action)
            )
        outcome = super().execute(action)
        if action.behaviour.drives:
            self._note_place()
        return outcome

    def _let_faults_come(self, action: Action) -> None:
        step = self.tracker.step + 1
        for kind in self._to_come.due(step, lambda kind: self.can_show(kind, action)):
            if kind.name not in self.present:
                self.inject(kind.name)

    def recover(self, remedy: Remedy) -> float:
        """Carry out a recovery by the robot, people or an expert; return the s that it took."""
        for kind in self._to_come.due_in_recovery():
            if kind.name not in self.present:
                self.inject(kind.name)
        if remedy.kind == "call expert":
            if self.link.silent or self.link.state.failed:
                super().recover(remedy)
                self._open_tablet()
            return self._expert_comes(remedy)
        if remedy.kind == "other requests":
            self._listens = True
        if remedy.kind == "restart":
            self.bench.do("restart", device=remedy.device)
            self._switch_tablet()
        return super().recover(remedy)

    def change(self, change: GameChange) -> None:
        """Apply a change to the game, and tell the simulated people about it."""
        super().change(change)
        match change.what:
            case "others first":
                self.bench.do("rules", done=change.person)
            case "played on":
                self.bench.do("rules", done=change.person, **self._wins)
            case "left" | "came":
                self.bench.do("rules", away=sorted(self.away))
            case "taken back":
                self.bench.do("rules", taken_back=change.number)
            case _:
                pass  # only concerns staff and the robot

    @property
    def _wins(self) -> dict[str, Any]:
        deck = self.activity.deck
        return {"patterns": list(deck.patterns), "together": deck.together}

    def _expert_comes(self, remedy: Remedy) -> float:
        began = self.link.time
        for kind in self.bench.do("mend", fault=remedy.fault)["lifted"]:
            if kind == "navigation-failed":
                self.link.do("fail", device="navigator", state="OK")
        self._switch_tablet()
        if self.link.setup.stepped:
            with suppress(DeviceError):
                self.link.do("wait", seconds=EXPERT_SECONDS)
            self._pass_until(lambda: remedy.fault not in self.commands.diagnosed(self.health()))
        return max(0.0, self.link.time - began)

    # ------------------------------------------------------------------------ what is counted

    def _check(self, what: str, place: str, seen: Any) -> None:
        """Score something that the robot saw against the ground truth."""
        if what == "face":
            there = self.truth()["place"]
            word = "unknown" if seen is None else "right" if seen == there else "wrong"
            self.score.identities[word] += 1
            return
        truth = self.truth()
        there = truth["people"].get(truth["place"], {"card": None, "marked": 0})
        if seen["card"] is None or seen["state"] == self.activity.unread:
            self.score.reads["hidden"] += 1
            return
        told = ~seen["hidden"]
        same = seen["card"] == there["card"] and not (seen["marked"] ^ there["marked"]) & told
        self.score.reads["right" if same else "wrong"] += 1

    def _note_place(self) -> None:
        """Record the localisation error after a drive, in m."""
        if not self.link.setup.stepped or self.link.silent:
            return
        x, y, _ = self.truth()["pose"]
        pose = self.link.beat().pose
        self.score.off.append(hypot(pose.x - x, pose.y - y))
