"""Fault detection (III-C): observations compared with expectations.

After each behaviour the state is compared with the learnt effects; all the time the age and state
of what the devices report is looked at. What comes out is evidence; what it means is `diagnosis`.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, Behaviour
from tangy_profiles.effects import CORRECTS
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
from tangy_tui.interaction.refusal import refused
from tangy_tui.learning.effects import Effects, Mismatch, who_waits

OWED_BY_PEOPLE = ("what was asked about", "request")
"""The variables that stay as they were if a person does not do what was asked: an outcome, and
no fault of the robot's."""


LATE = "WAITS"
"""How a robot is while the data of a device is late, and not lost."""
OTHERS: Variable = "others' requests"


class Detector:
    """Turns observations into evidence. One per run of games; `begin` each game."""

    def __init__(self, activity: Activity, robot: Robot, effects: Effects) -> None:
        self.effects = effects
        self.activity = activity
        self._robot = robot
        self._refusals: Counter[str] = Counter()
        self._in_game: Counter[str] = Counter()
        self._unchanged: Counter[str] = Counter()
        self.doubted: set[str] = set()
        """People whose cards Tangy may misread; it no longer judges them in this game."""
        self.withdrew: tuple[str, ...] = ()
        """Who asks no more since the last comparison, although nobody has helped them."""
        self._fruitless = 0
        self._last: ActivityState | None = None
        self._health: Health | None = None
        self._devices: dict[str, Fact] = {}

    def begin(self) -> None:
        """Forget what the last game had."""
        self._refusals.clear()
        self._in_game.clear()
        self._unchanged.clear()
        self.doubted.clear()
        self.withdrew = ()
        self._fruitless = 0
        self._last = None

    def refused(self, person: str) -> int:
        """Count that a person did not do what they were asked; return how often in a row."""
        self._refusals[person] += 1
        self._in_game[person] += 1
        return self._refusals[person]

    @property
    def spent(self) -> bool:
        """Whether anybody has reached the limit of requests in this game."""
        return bool(self.doubted) or any(map(self.spent_for_game, self._in_game))

    def spent_for_game(self, person: str | None) -> bool:
        """Say whether a person was asked in vain as often as the activity allows in a game."""
        return person is not None and self._in_game[person] >= self.activity.asking.game

    def refusals(self, person: str | None) -> dict[str, Fact]:
        """Return the evidence of how often a person did not do what they were asked."""
        if person is None:
            return {}
        times, spent = self._refusals[person], self.spent_for_game(person)
        found: dict[str, Fact] = {"person.refusals": times} if times or spent else {}
        if spent or times >= self.activity.asking.visit:
            found["person.spent"] = True
        return found

    def forgive(self, person: str | None) -> None:
        """Begin anew to count what a person does not do."""
        self._fruitless = 0
        if person is not None:
            self._refusals.pop(person, None)

    @property
    def devices(self) -> tuple[str, ...]:
        """The names of the robot's devices."""
        return tuple(self._robot.devices)

    def state(self, reading: Reading) -> str:
        """Return the state of a device of the robot, as `state_of` does."""
        return state_of(self._robot.devices.get(reading.device), reading)

    def watch(self, health: Health) -> Evidence:
        """Return the evidence that the devices give; the same object for the same readings."""
        if health is not self._health:
            self._health = health
            self._devices = device_evidence(self._robot, health)
        return self._devices

    def worst(self, health: Health) -> tuple[str, str]:
        """Return the worst state of all devices, and which one has it ("": all are well)."""
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

        Where nothing at all is known of a behaviour's effects, nothing can be unexpected.

        Args:
            acted: the behaviour, and what was observed before and after it.
            explained: a fault of a device explains what cannot be seen, so that it says nothing
                of a person.

        Returns:
            The evidence of the execution, and what was not as expected.
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
        if not explained and acted.action.behaviour.effect in CORRECTS:
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
        """Count how often in a row what a person mended looks as before; return that number.

        A person who was seen to refuse leaves the count as it is.
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
        """Say whether a person was asked to mend what could be seen, and then could not be."""
        person, unread = acted.state.attended, self.activity.unread
        if acted.action.behaviour.effect not in CORRECTS or person is None:
            return False
        before, after = acted.state.user(person).activity, acted.after.user(person).activity
        beside = acted.after.place == person == acted.after.attended
        return acted.outcome.completed and beside and before != unread == after

    def take_in(self, now: ActivityState) -> None:
        """Begin anew from a state that staff, or a change of the game's plan, brought about."""
        self._last = now

    def unexpected(
        self, behaviour: Behaviour, before: ActivityState, outcome: Outcome, after: ActivityState
    ) -> list[Mismatch]:
        """Return the features that differ from the expected effect of a behaviour."""
        if behaviour.name not in self.effects.values:
            return []
        followed = outcome.response is None or outcome.response.followed
        return [
            mismatch
            for mismatch in self.effects.mismatches(behaviour.name, before, after, self.activity)
            if followed or mismatch.variable not in OWED_BY_PEOPLE
        ]

    def contradicts(
        self, action: Action, before: ActivityState, outcome: Outcome, after: ActivityState
    ) -> bool:
        """Say whether an observation after an action needs a second look.

        That is what it should not have left so, or what looks as if a person had not done it.
        """
        behaviour = action.behaviour
        if not outcome.completed:
            return False  # it is known already that it came to nothing
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
        """Count requests that a person did not follow, and behaviours that changed nothing."""
        before, after, outcome = acted.state, acted.after, acted.outcome
        if outcome.response is not None:
            person = before.attended or outcome.response.person  # whose place it is
            if outcome.response.followed:
                self._refusals.pop(person, None)
            else:
                self.refused(person)
        elif not explained and (
            refused(acted.action.behaviour, before, outcome, after) or self._went_unseen(acted)
        ):
            self.refused(str(before.attended))
        alike = after._replace(step=before.step, closed=before.closed) == before
        moved_on = before.attended is None and bool(outcome.numbers)  # a number was called
        self._fruitless = self._fruitless + 1 if alike and not moved_on else 0


def _waiting(last: ActivityState, now: ActivityState) -> list[str]:
    """Return who asked and waited for the robot to come, which then stood with nobody of them."""
    beside = {last.place, now.place, now.attended}
    return [user.id for user in last.users if user.request == "AR" and user.id not in beside]


def _gone_during(acted: Acted) -> list[str]:
    """Return who waited while a behaviour was for somebody else, and asks no more after it."""
    return [
        user.id
        for user in acted.state.users
        if user.request == "AR"
        and user.id != acted.state.attended
        and acted.after.user(user.id).request == "ANR"
    ]


def device_evidence(robot: Robot, health: Health) -> dict[str, Fact]:
    """Return the evidence that the devices of a robot give.

    What a device measured before it fell silent is no evidence any more, and a device of the
    robot's that is not even mentioned is as silent as any. Of others nothing is taken in.
    """
    found: dict[str, Fact] = {f"{name}.state": STALE for name in robot.devices}
    quiet = _link_is_quiet_for(robot, health)
    for reading in health:
        device = robot.devices.get(reading.device)
        if device is None:
            continue  # what the robot has not cannot fail
        state = lasting_state(device, reading)
        if state == STALE and quiet:
            grew_old = device.stale_after < reading.age <= device.lost_after + quiet
            told = OK if reading.state == STALE else reading.state
            state = told if grew_old else state  # as it was: a pause is no sign of anything
        found[f"{reading.device}.state"] = state
        if math.isfinite(reading.age):
            found[f"{reading.device}.age"] = reading.age
        if state != STALE:
            facts = reading.facts.items()
            found |= {f"{reading.device}.{fact}": value for fact, value in facts if value == value}
    return found


def _link_is_quiet_for(robot: Robot, health: Health) -> float:
    """Return since how many s the link has been quiet, or 0 if that is short or it is lost.

    All that is reached by a quiet link grows old with it, and what was older before, as pictures
    are, may count as silent before the link does. It is judged by how old it was when the link was
    heard last, so that staff are not sent to the wrong cable.
    """
    device = robot.devices.get(LINK)
    reading = next((one for one in health if one.device == LINK), None)
    if device is None or reading is None or lasting_state(device, reading) == STALE:
        return 0.0
    return reading.age if reading.age > device.stale_after else 0.0


def symptoms(evidence: Evidence) -> set[str]:
    """Return the keys of evidence that needs an explanation of its own."""
    return {
        key
        for key, value in evidence.items()
        if key.startswith("mismatch.") or (key.endswith(".state") and value in (ERROR, STALE))
    }


def together(*evidence: Mapping[str, Fact]) -> dict[str, Fact]:
    """Join what devices, world state and execution give."""
    return {key: value for one in evidence for key, value in one.items()}


def _response(outcome: Outcome) -> str:
    if outcome.response is None:
        return "none"
    if not outcome.response.followed:
        return "not followed"
    return "complied" if outcome.response.complied else "late"
