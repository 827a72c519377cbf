"""Which tracks count as people: legs and walking make a person, furniture does not."""

from __future__ import annotations

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.navigation.leg_detection import LegSighting
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.localisation import Estimate
from tangy_hw.navigation.person_evidence import HOPS, PersonEvidence
from tangy_hw.navigation.poses import IDENTITY
from tangy_hw.navigation.surroundings import Blocker, Surroundings
from tests.bench.people_mistaken import KINDS, Thing
from tests.bench.people_simulation import MAP, TICK, Drive, Person

ROBOT = Pose(5.0, 1.2, pi / 2)
AHEAD = Twist(0.4, 0.0)
PAIR = LegSighting(0.0, 0.0, 0.22, True, 0.12)


def around(person: Person, seconds: float, seed: int = 1) -> Surroundings:
    """Return what a standing robot knows after it has seen somebody or something for a while."""
    drive = Drive(ROBOT, ROBOT, [person], np.random.default_rng(seed))
    surroundings = Surroundings(MAP, IDENTITY, MotionLimits())
    for _ in range(round(seconds / TICK)):
        estimate = Estimate(ROBOT, np.zeros((3, 3)), 0.02, 1.0, 500)
        surroundings.see(estimate, ROBOT, drive.look(), TICK)
        person.step(person, drive)
    return surroundings


def thing(kind: str, far: float, heading: float) -> Thing:
    return Thing(ROBOT.x, ROBOT.y + far, heading, radius=0.4, shape=tuple(KINDS[kind]))


def judged(pair: LegSighting, seconds: float, speed: float = 0.0, off: float = 0.0) -> bool:
    """Return whether a track that shows this is told as a person."""
    evidence = PersonEvidence()
    for tick in range(round(seconds / TICK)):
        evidence.note(tick * TICK, (speed * tick * TICK, 0.0), pair, off)
    return evidence.person


def test_legs_side_by_side_make_a_person_within_two_seconds() -> None:
    assert judged(PAIR, 2.0) and not judged(PAIR, 1.5)


@pytest.mark.parametrize(
    "pair",
    [
        PAIR._replace(width=0.04),
        PAIR._replace(others=2),
        PAIR._replace(legs=False),
        PAIR._replace(width=0.0),
    ],
    ids=["thin", "four legs", "one leg", "far apart"],
)
def test_other_legs_do_not(pair: LegSighting) -> None:
    assert not judged(pair, 20.0)


def test_walking_makes_a_person_whatever_the_legs_look_like() -> None:
    leg = PAIR._replace(legs=False)
    assert judged(leg, 1.5, speed=1.0) and not judged(leg, 20.0, speed=0.3)


def test_a_track_that_hops_from_leg_to_leg_does_not_walk() -> None:
    assert not judged(PAIR._replace(legs=False), 20.0, speed=1.0, off=HOPS + 0.01)


def test_a_track_that_wavers_does_not_walk() -> None:
    evidence = PersonEvidence()
    for tick in range(200):
        place = (0.25 * (tick % 2), 0.045 * tick)  # in 2 s .9 m on, by a path of 5 m
        evidence.note(tick * TICK, place, PAIR._replace(legs=False), 0.0)
    assert not evidence.person


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_person_in_the_way_is_told_from_furniture(seed: int) -> None:
    turned = seed * pi / 5
    assert around(Person(ROBOT.x, ROBOT.y + 0.65, turned), 3.0, seed).held(AHEAD) == "standing"
    for kind in ("chair", "lamp", "box", "armchair"):
        far = 0.85 if kind == "armchair" else 0.7
        blocker = around(thing(kind, far, turned), 3.0, seed).held(AHEAD)
        assert blocker == "object", kind


@pytest.mark.slow
def test_a_person_who_walks_before_the_robot_is_let_pass() -> None:
    def step(person: Person, drive: Drive) -> None:
        person.walk(0.0, 0.6)

    found: set[Blocker] = set()
    for seconds in (1.6, 1.8, 2.0):
        walker = Person(ROBOT.x - 1.0, ROBOT.y + 0.7, 0.0, step)
        found.add(around(walker, seconds).held(AHEAD))
    assert found == {"walking"}


def test_what_stands_aside_blocks_nothing() -> None:
    beside = Person(ROBOT.x + 1.6 * cos(0.2), ROBOT.y + 1.6 * sin(0.2), 0.0)
    assert hypot(beside.x - ROBOT.x, beside.y - ROBOT.y) > 1.5
    assert around(beside, 3.0).held(AHEAD) == ""
