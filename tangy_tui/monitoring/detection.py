"""Fault detection (III-C): compares observations with expectations.

After each behaviour the new state is compared with the learnt effects. The age and state of the
devices' readings is checked continuously. The result is evidence, which `diagnosis` interprets.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.faults import Evidence
from tangy_profiles.health import (
    ERROR,
    OK,
    STALE,
    STATES,
    Fact,
    Health,
    Reading,
    lasting_state,
    state_of,
)
from tangy_profiles.robot import LINK, Robot
from tangy_profiles.state import ActivityState, Outcome, Variable
from tangy_tui.interaction.game_events import Acted
from tangy_tui.interaction.observation import refused
from tangy_tui.learning.effects import Effects, Mismatch, progress, who_waits

OWED_BY_PEOPLE = ("what was asked about", "request")
"""Variables that stay unchanged if a person does not follow a request, which is no fault."""


LATE = "WAITS"
"""The robot's state while a device's data is late, but not lost."""
OTHERS: Variable = "others' requests"


class Detector:
    """Turns observations into evidence; one per run of games, call `begin` for each game."""

    def __init__(self, activity: Activity, robot: Robot, effects: Effects) -> None:
        self.effects = effects
        self.activity = activity
        self._robot = robot
        self._refusals: Counter[str] = Counter()
        self._in_visit: Counter[str] = Counter()
        """Unsuccessful requests since the robot came, whatever was followed between them."""
        self._place: str | None = None
        self._in_game: Counter[str] = Counter()
        self._refusing: set[str] = set()
        """Who refused in a whole visit, and has followed no request since."""
        self._unchanged: Counter[str] = Counter()
        self.doubted: set[str] = set()
        """People whose cards Tangy may misread; it does not judge them in this game."""
        self.withdrew: tuple[str, ...] = ()
        """Those who stopped asking since the last comparison, although nobody helped them."""
        self._fruitless = 0
        self._last: ActivityState | None = None
        self._health: Health | None = None
        self._devices: dict[str, Fact] = {}

    def begin(self) -> None:
        """Reset for a new game."""
        self._refusals.clear()
        self._in_visit.clear()
        self._in_game.clear()
        self._refusing.clear()
        self._unchanged.clear()
        self.doubted.clear()
        self.withdrew = ()
        self._fruitless = 0
        self._last = None

    def refused(self, person: str) -> int:
        """Count that a person did not follow a request; return how often in a row."""
        self._refusals[person] += 1
        self._in_visit[person] += 1
        self._in_game[person] += 1
        if self._refusals[person] >= self.activity.asking.visit:
            self._refusing.add(person)
        return self._refusals[person]

    @property
    def spent(self) -> bool:
        """Whether any person has reached the limit of requests in this game."""
        return bool(self.doubted) or any(map(self.spent_for_game, self._in_game))

    def spent_for_game(self, person: str | None) -> bool:
        """Return whether a person has reached the limit of unsuccessful requests in a game."""
        return person is not None and self._in_game[person] >= self.activity.asking.game

    def refusals(self, person: str | None) -> dict[str, Fact]:
        """Return the evidence of a person's unsuccessful requests."""
        if person is None:
            return {}
        times, spent = self._refusals[person], self.spent_for_game(person)
        found: dict[str, Fact] = {"person.refusals": times} if times or spent else {}
        if spent or max(times, self._in_visit[person]) >= self.activity.asking.visit:
            found["person.spent"] = True
        return found

    def forgive(self, person: str | None) -> None:
        """Reset the count of a person's unsuccessful requests in a row.

        Those of the visit still count, unless the person was just left in peace for them.
        """
        self._fruitless = 0
        if person is not None:
            self._refusals.pop(person, None)
            if self._in_visit[person] >= self.activity.asking.visit:
                self._in_visit.pop(person)

    @property
    def devices(self) -> tuple[str, ...]:
        """The names of the robot's devices."""
        return tuple(self._robot.devices)

    def state(self, reading: Reading) -> str:
        """Return the state of a device of the robot (see `state_of`)."""
        return state_of(self._robot.devices.get(reading.device), reading)

    def watch(self, health: Health) -> Evidence:
        """Return the evidence of the devices; cached for the same readings."""
        if health is not self._health:
            self._health = health
            self._devices = device_evidence(self._robot, health)
        return self._devices

    def worst(self, health: Health) -> tuple[str, str]:
        """Return the worst state of all devices and the label of that device ("" if all are OK)."""
        seen = self.watch(health)
        states = [(str(seen[f"{d.name}.state"]), d.label) for d in self._robot.devices.values()]
        state, label = max(states, key=lambda one: STATES.index(one[0]), default=(OK, ""))
        late = next((self._robot.devices[r.device].label for r in health if self._is_late(r)), "")
        if state == OK and late:
            return LATE, late
        return state, label if state != OK else ""

    def _is_late(self, reading: Reading) -> bool:
        device = self._robot.devices.get(reading.device)
        return state_of(device, reading) == STALE != lasting_state(device, reading)

    def compare(
        self, acted: Acted, *, explained: bool = False
    ) -> tuple[dict[str, Fact], list[Mismatch]]:
        """Compare the state after a behaviour with its learnt effects.

        A behaviour without learnt effects has no unexpected ones.

        Args:
            acted: the behaviour, with the states before and after it.
            explained: whether a device fault explains an unseen effect, so that it does not count
                against a person.

        Returns:
            The evidence of the execution, and the mismatches.
        """
        behaviour, outcome = acted.action.behaviour, acted.outcome
        found = self.unexpected(behaviour, acted.state, outcome, acted.after)
        waiting = [] if self._last is None else _waiting(self._last, acted.state)
        gone = [id for id in waiting if acted.state.user(id).request == "ANR"]
        self.withdrew = tuple(dict.fromkeys((*gone, *_gone_during(acted))))
        if gone and not any(one.variable == OTHERS for one in found):
            found += self._between(behaviour.name, waiting, len(gone))
        self._last = acted.after
        evidence: dict[str, Fact] = {f"mismatch.{one.variable}": one.seen for one in found}
        self._count(acted, explained)
        if self._refusals[str(acted.state.attended)]:
            evidence |= self.refusals(acted.state.attended)
        if not explained and acted.action.behaviour.corrects:
            unchanged = self._count_unchanged(acted, found)
            evidence |= {"person.unchanged": unchanged} if unchanged else {}
        if self._fruitless:
            evidence["visit.fruitless"] = self._fruitless
        if evidence:
            evidence["behaviour.name"] = behaviour.name
            evidence["behaviour.effect"] = behaviour.effect
            evidence["behaviour.completed"] = outcome.completed
            evidence["behaviour.response"] = _response(outcome)
        return evidence, found

    def _count_unchanged(self, acted: Acted, found: Sequence[Mismatch]) -> int:
        """Count how often in a row a person's correction changed nothing; return the count.

        A person who was seen to refuse does not change the count.
        """
        person, response = str(acted.state.attended), acted.outcome.response
        if response is not None and not response.followed:
            return 0
        if any(one.variable == OWED_BY_PEOPLE[0] for one in found):
            self._unchanged[person] += 1
        else:
            self._unchanged.pop(person, None)
        return self._unchanged[person]

    def _went_unseen(self, acted: Acted) -> bool:
        """Return whether a person's visible card went out of view during a correction."""
        person, unread = acted.state.attended, self.activity.unread
        if not acted.action.behaviour.corrects or person is None:
            return False
        before, after = acted.state.user(person).activity, acted.after.user(person).activity
        beside = acted.after.place == person == acted.after.attended
        return acted.outcome.completed and beside and before != unread == after

    def take_in(self, now: ActivityState) -> None:
        """Start from a new state, after an action of staff or a change of the plan."""
        self._last = now
        self._arrive(now.place)

    def _arrive(self, place: str) -> None:
        """Begin a visit if the robot has left its place."""
        if place != self._place:
            self._in_visit.clear()
        self._place = place

    def unexpected(
        self, behaviour: Behaviour, before: ActivityState, outcome: Outcome, after: ActivityState
    ) -> list[Mismatch]:
        """Return the variables that differ from the expected effect of a behaviour.

        If a card stays out of view whose owner refused in a whole visit, that is a refusal, too.
        """
        if behaviour.name not in self.effects.values:
            return []
        if outcome.response is not None:
            followed = outcome.response.followed
        else:
            refuses = before.attended in self._refusing
            followed = not (refuses and behaviour.shows_card)
        return [
            mismatch
            for mismatch in self.effects.mismatches(behaviour.name, before, after, self.activity)
            if followed or mismatch.variable not in OWED_BY_PEOPLE
        ]

    def contradicts(
        self, action: Action, before: ActivityState, outcome: Outcome, after: ActivityState
    ) -> bool:
        """Return whether an observation after an action needs a second look.

        That is so if it is unexpected, or looks like a refusal.
        """
        behaviour = action.behaviour
        if not outcome.completed:
            return False  # known to have failed
        unexpected = self.unexpected(behaviour, before, outcome, after)
        return bool(unexpected) or refused(behaviour, before, outcome, after)

    def _between(self, behaviour: str, waiting: Sequence[str], gone: int) -> list[Mismatch]:
        """Return the mismatch of requests that ended between two behaviours."""
        if behaviour not in self.effects.values:
            return []
        expected = self.effects.values[behaviour].get(OTHERS, frozenset())
        seen = who_waits(gone, len(waiting))
        mismatch = Mismatch(behaviour, OTHERS, tuple(sorted(expected)), seen)
        return [] if seen in expected else [mismatch]

    def _count(self, acted: Acted, explained: bool) -> None:
        """Count refused requests, and behaviours that changed nothing."""
        before, after, outcome = acted.state, acted.after, acted.outcome
        self._arrive(after.place)
        if outcome.response is not None:
            person = before.attended or outcome.response.person  # the person at this place
            if outcome.response.followed:
                self._refusals.pop(person, None)
                self._refusing.discard(person)
            else:
                self.refused(person)
        elif not explained and (
            refused(acted.action.behaviour, before, outcome, after) or self._went_unseen(acted)
        ):
            self.refused(str(before.attended))
        led = progress(before, outcome, after)
        if led != "waits":  # a step that waits for a timer leaves the count as it is
            self._fruitless = 0 if led == "on" else self._fruitless + 1


def _waiting(last: ActivityState, now: ActivityState) -> list[str]:
    """Return those who asked before, and whom the robot was not with."""
    beside = {last.place, now.place, now.attended}
    return [user.id for user in last.users if user.request == "AR" and user.id not in beside]


def _gone_during(acted: Acted) -> list[str]:
    """Return those who asked during a behaviour for somebody else, and no longer ask after it."""
    return [
        user.id
        for user in acted.state.users
        if user.request == "AR"
        and user.id != acted.state.attended
        and acted.after.user(user.id).request == "ANR"
    ]


def device_evidence(robot: Robot, health: Health) -> dict[str, Fact]:
    """Return the evidence of the robot's devices.

    Facts that a device measured before it fell silent are ignored. A device without any reading is
    STALE. Devices that the robot does not have are ignored.
    """
    found: dict[str, Fact] = {f"{name}.state": STALE for name in robot.devices}
    quiet = _link_is_quiet_for(robot, health)
    for reading in health:
        device = robot.devices.get(reading.device)
        if device is None:
            continue  # not a device of this robot
        state = lasting_state(device, reading)
        if state == STALE and quiet:
            grew_old = device.stale_after < reading.age <= device.lost_after + quiet
            told = OK if reading.state == STALE else reading.state
            state = told if grew_old else state  # unchanged: a short pause is no symptom
        found[f"{reading.device}.state"] = state
        if math.isfinite(reading.age):
            found[f"{reading.device}.age"] = reading.age
        if state != STALE:
            facts = reading.facts.items()
            found |= {f"{reading.device}.{fact}": value for fact, value in facts if value == value}
    return found


def _link_is_quiet_for(robot: Robot, health: Health) -> float:
    """Return for how many s the link has been quiet; 0 if only briefly, or if it is lost.

    All data behind a quiet link ages with it, and slower data, such as pictures, may become stale
    before the link does. It is judged by its age when the link was last heard, so that staff do not
    check the wrong cable.
    """
    device = robot.devices.get(LINK)
    reading = next((one for one in health if one.device == LINK), None)
    if device is None or reading is None or lasting_state(device, reading) == STALE:
        return 0.0
    return reading.age if reading.age > device.stale_after else 0.0


def symptoms(evidence: Evidence) -> set[str]:
    """Return the keys of evidence that needs an explanation."""
    return {
        key
        for key, value in evidence.items()
        if key.startswith("mismatch.") or (key.endswith(".state") and value in (ERROR, STALE))
    }


def together(*evidence: Mapping[str, Fact]) -> dict[str, Fact]:
    """Merge the evidence of devices, world state and execution."""
    return {key: value for one in evidence for key, value in one.items()}


def _response(outcome: Outcome) -> str:
    if outcome.response is None:
        return "none"
    if not outcome.response.followed:
        return "not followed"
    return "complied" if outcome.response.complied else "late"
