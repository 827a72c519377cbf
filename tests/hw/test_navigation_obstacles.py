"""The navigator: goes round what is in the way, and waits where there is no way."""

from __future__ import annotations

import numpy as np

from tangy_hw.devices import STILL, Pose
from tests.hw.navigated import CHAIR, ROW, DrivenRobot, at_seat


class TestObstacles:
    def test_it_goes_round_a_chair_that_is_put_in_its_way(self) -> None:
        robot = DrivenRobot()
        robot.navigator.go(at_seat(3))
        robot.run(3)
        robot.boxes.append(CHAIR)
        assert robot.arrives() and robot.off(at_seat(3))[0] < 0.1
        assert ("replanned", "replanned") in robot.seen
        assert robot.seen[-1] == ("arrived", "clear")
        assert not robot.touched

    def test_it_waits_where_there_is_no_way_and_goes_on_when_there_is(self) -> None:
        robot = DrivenRobot()
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
        robot = DrivenRobot()
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
        robot = DrivenRobot()
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
        robot = DrivenRobot(CHAIR)
        robot.run(1)
        points = robot.navigator.obstacles
        assert len(points) > 3
        assert np.abs(points - (6.4, 2.7)).max() < 0.4
        robot.boxes.clear()
        robot.run(3)
        assert len(robot.navigator.obstacles) == 0
