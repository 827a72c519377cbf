"""The navigator: goes where it is told, round what is in the way, and says how it stands."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, pi

import numpy as np
import pytest

from tangy_hw.devices import STILL, Odometry, Pose, Twist
from tangy_hw.navigation.navigator import Navigator, State
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.navigation.poses import wrap
from tangy_profiles.room import load_room
from tests.hw.raycast import Wheels, driven, look, room_sides

ROOM = load_room()
MAP = map_of_room(ROOM)
FRONT = Pose(ROOM.front.x, ROOM.front.y, pi / 2)
PEOPLE = [f"user-{number}" for number in range(len(ROOM.seats))]
Box = tuple[float, float, float, float]
TABLE: Box = ROOM.table
CHAIR: Box = (6.2, 2.5, 6.6, 2.9)
ROW: Box = (0.05, 2.7, 9.95, 3.0)


def at_seat(place: int) -> Pose:
    """Return where the robot stands to help somebody."""
    stand = ROOM.stand(PEOPLE[place], PEOPLE)
    return Pose(stand.x, stand.y, pi / 2)


class Driven:
    """A robot in the room, in a time of its own."""

    def __init__(self, *boxes: Box, seed: int = 0) -> None:
        self.rng = np.random.default_rng(seed)
        self.true, self.wheels = FRONT, Wheels(self.rng)
        self.boxes = list(boxes)
        self.grip = 1.0
        self.stuck = self.blind = False
        self.twist, self.time = STILL, 0.0
        self.seen: list[tuple[State, str]] = []
        self.touched = False
        self.navigator = Navigator(MAP, np.random.default_rng(seed + 1), FRONT)

    def run(self, seconds: float, until: Callable[[], bool] = lambda: False) -> bool:
        """Let time pass; say whether it came to what was waited for."""
        for _ in range(round(seconds * 10)):
            scan = None if self.blind else look(room_sides(ROOM, *self.boxes), self.true, self.rng)
            odometry = Odometry(self.wheels.pose, self.twist)
            told = self.navigator.tick(odometry, scan, 0.1)
            seen = (self.navigator.state, str(self.navigator.facts()["path"]))
            if not self.seen or self.seen[-1] != seen:
                self.seen.append(seen)
            if until():
                return True
            self.twist = STILL if self.stuck else told
            self.wheels.turn(self.twist, 0.1)
            goes = Twist(self.twist.forward * self.grip, self.twist.turn * self.grip)
            self.true = driven(self.true, goes, 0.1)
            self.touched |= any(self._away(box) < 0.25 for box in (*self.boxes, TABLE))
            self.time += 0.1
        return False

    def _away(self, box: Box) -> float:
        left, near, right, far = box
        x, y = self.true.x, self.true.y
        return hypot(max(left - x, 0, x - right), max(near - y, 0, y - far))

    def arrives(self, seconds: float = 60) -> bool:
        return self.run(seconds, lambda: self.navigator.state == "arrived")

    def off(self, goal: Pose) -> tuple[float, float]:
        turned = abs(wrap(self.true.heading - goal.heading))
        return hypot(self.true.x - goal.x, self.true.y - goal.y), turned


class TestGoing:
    def test_it_goes_to_every_seat_and_back_to_the_front(self) -> None:
        robot = Driven()
        for goal in (at_seat(0), at_seat(3), FRONT, at_seat(1)):
            robot.navigator.go(goal)
            assert robot.arrives()
            metres, radians = robot.off(goal)
            assert metres < 0.1 and radians < 0.08
        assert {path for _, path in robot.seen} == {"clear"}
        assert {state for state, _ in robot.seen} == {"driving", "arrived"}
        assert not robot.touched

    def test_it_knows_nothing_to_complain_of(self) -> None:
        robot = Driven(seed=5)
        robot.navigator.go(at_seat(2))
        worst = {"fit": 1.0, "spread": 0.0, "slip": 0.0, "still": 0.0}

        def note() -> bool:
            facts = robot.navigator.facts()
            worst["fit"] = min(worst["fit"], float(facts["fit"]))
            for name in ("spread", "slip", "still"):
                worst[name] = max(worst[name], float(facts[name]))
            return robot.navigator.state == "arrived"

        assert robot.run(60, note)
        assert worst["fit"] > 0.9 and worst["spread"] < 0.4
        assert worst["slip"] < 0.2 and worst["still"] < 0.5

    def test_another_goal_takes_the_place_of_the_first(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.navigator.go(at_seat(3))
        assert robot.arrives() and robot.off(at_seat(3))[0] < 0.1

    def test_it_stands_when_it_is_called_off(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        assert robot.twist != STILL
        robot.navigator.cancel()
        robot.run(0.2)
        assert robot.twist == STILL and robot.navigator.state == "idle"
        assert robot.navigator.goal is None

    def test_it_stands_while_it_does_not_see(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.blind = True
        robot.run(0.2)
        assert robot.twist == STILL
        robot.blind = False
        assert robot.arrives()

    @pytest.mark.parametrize("goal", [Pose(5, 5.4, 0), Pose(-3, 1, 0)])
    def test_a_goal_that_cannot_be_says_so_at_once(self, goal: Pose) -> None:
        robot = Driven()
        robot.navigator.go(goal)
        robot.run(1)
        assert robot.navigator.state == "failed" and robot.navigator.why.startswith("The goal")
        assert robot.twist == STILL

    def test_the_readings_are_those_that_the_diagnosis_knows(self) -> None:
        robot = Driven()
        robot.run(0.5)
        localisation, navigator = robot.navigator.readings(0.25)
        assert localisation.device == "localisation" and set(localisation.facts) == {
            "fit",
            "spread",
        }
        assert navigator.device == "navigator" and navigator.facts == {"path": "clear"}
        assert navigator.age == 0.25


class TestObstacles:
    def test_it_goes_round_a_chair_that_is_put_in_its_way(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(3))
        robot.run(3)
        robot.boxes.append(CHAIR)
        assert robot.arrives() and robot.off(at_seat(3))[0] < 0.1
        assert ("replanned", "replanned") in robot.seen
        assert robot.seen[-1] == ("arrived", "clear")
        assert not robot.touched

    def test_it_waits_where_there_is_no_way_and_goes_on_when_there_is(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(3))
        robot.run(2)
        robot.boxes.append(ROW)
        assert robot.run(30, lambda: robot.navigator.state == "blocked")
        assert robot.navigator.facts()["path"] == "none" and robot.navigator.why
        robot.run(3)
        assert robot.twist == STILL
        robot.boxes.clear()
        assert robot.arrives() and not robot.touched

    def test_within_a_ring_of_chairs_it_says_that_there_is_no_way(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        x, y = robot.true.x, robot.true.y
        robot.boxes += [(x - 1, y + side, x + 1, y + side + 0.1) for side in (-1, 0.9)]
        robot.boxes += [(x + side, y - 1, x + side + 0.1, y + 1) for side in (-1, 0.9)]
        assert robot.run(15, lambda: robot.navigator.facts()["path"] == "none")
        assert not any(state == "spinning" for state, _ in robot.seen)
        robot.boxes.clear()
        assert robot.arrives() and not robot.touched

    def test_somebody_who_walks_by_is_let_pass(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        ahead = Pose(robot.true.x + 0.8 * np.cos(robot.true.heading),
                     robot.true.y + 0.8 * np.sin(robot.true.heading), 0)  # fmt: skip
        robot.boxes.append((ahead.x - 0.1, ahead.y - 0.1, ahead.x + 0.1, ahead.y + 0.1))
        robot.run(0.7)
        robot.boxes.clear()
        assert robot.arrives()
        assert {path for _, path in robot.seen} == {"clear"} and not robot.touched

    def test_what_it_saw_is_shown_and_forgotten_when_it_has_gone(self) -> None:
        robot = Driven(CHAIR)
        robot.run(1)
        points = robot.navigator.obstacles
        assert len(points) > 3
        assert np.abs(points - (6.4, 2.7)).max() < 0.4
        robot.boxes.clear()
        robot.run(3)
        assert len(robot.navigator.obstacles) == 0


class TestFaults:
    def test_wheels_that_do_not_turn_are_counted_in_seconds(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.stuck = True
        robot.run(3)
        assert 2.5 < float(robot.navigator.facts()["still"]) <= 3.2
        assert robot.navigator.facts()["path"] == "clear"
        robot.stuck = False
        robot.run(0.5)
        assert robot.navigator.facts()["still"] == 0.0

    def test_wheels_that_slip_are_counted_in_metres(self) -> None:
        robot = Driven()
        robot.navigator.go(at_seat(0))
        robot.run(4)
        robot.grip = 0.0
        assert robot.run(5, lambda: float(robot.navigator.facts()["slip"]) > 0.3)
        assert robot.navigator.facts()["path"] == "clear"

    @pytest.mark.parametrize("seed", [1, 2, 3])
    def test_carried_off_it_turns_finds_itself_and_goes_on(self, seed: int) -> None:
        robot = Driven(seed=seed)
        robot.navigator.go(at_seat(0))
        robot.run(5)
        robot.true = Pose(8.5, 2.0, -2.0)
        assert robot.run(20, lambda: robot.navigator.state == "spinning")
        facts = robot.navigator.facts()
        assert float(facts["fit"]) < 0.85 and float(facts["spread"]) > 0.5
        assert robot.arrives(120) and robot.off(at_seat(0))[0] < 0.15

    def test_told_to_it_turns_once_and_stands(self) -> None:
        robot = Driven()
        robot.navigator.spin()
        turned = []

        def done() -> bool:
            turned.append(robot.twist.turn * 0.1)
            return robot.navigator.state == "idle"

        assert robot.run(30, done)
        assert sum(turned) == pytest.approx(2 * pi, abs=0.2)
