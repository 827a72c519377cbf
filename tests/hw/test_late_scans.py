"""Scans and odometry that a network delays: each counts for the time of its measurement."""

from __future__ import annotations

from math import pi
from random import Random

import pytest

from tangy_hw.device_protocols import Odometry, Pose, Stamped, Twist
from tangy_hw.drivers.latest_value import LatestValue
from tangy_hw.drivers.ros_messages import header, stamp_of
from tangy_hw.drivers.source_clock import JUMP, WINDOW, SourceClock
from tangy_hw.navigation.odometry_history import AHEAD_SECONDS, OdometryHistory
from tangy_sim.servers.link_relay import LinkQuality
from tests.bench.late_scans import Kept, LateRobot
from tests.hw.navigated import FRONT, at_seat

AHEAD = 1_000.0  # s by which the device's clock is ahead


class TestSourceClock:
    def test_a_delayed_message_keeps_its_true_age(self) -> None:
        clock, chance = SourceClock(), Random(1)
        for number in range(round(20 * WINDOW)):  # longer than a window
            sent, late = number * 0.1, 0.01 + (chance.random() < 0.2) * chance.random()
            measured = clock.measured(sent + AHEAD, sent + late)
            assert measured == pytest.approx(sent + 0.01) or number == 0

    def test_a_slower_source_clock_is_tracked(self) -> None:
        clock = SourceClock()
        for number in range(6_000):
            sent = number * 0.1
            measured = clock.measured(sent * (1 - 1e-4), sent)
            assert measured is not None
            assert abs(measured - sent) <= (2 * WINDOW + 0.2) * 1e-4

    @pytest.mark.parametrize("by", [-10 * JUMP, 10 * JUMP])
    def test_a_reset_source_clock_is_followed_at_once(self, by: float) -> None:
        clock = SourceClock()
        clock.measured(AHEAD, 0.0)
        assert clock.measured(AHEAD + by + 0.1, 0.1) == pytest.approx(0.1)

    @pytest.mark.parametrize("digits", [0, -3])
    def test_repeated_stamps_give_no_time(self, digits: int) -> None:
        clock = SourceClock()
        told = [clock.measured(round(AHEAD + 0.1 * n, digits), 0.1 * n) for n in range(100)]
        assert not any(told[10:])

    def test_stamps_are_trusted_again_some_time_after_a_repeat(self) -> None:
        clock = SourceClock()
        told = [clock.measured(AHEAD + 0.1 * (n - (n == 5)), 0.1 * n) for n in range(500)]
        doubted = [n for n, measured in enumerate(told) if measured is None]
        assert doubted[0] == 5 and doubted == list(range(5, doubted[-1] + 1))
        assert doubted[-1] == pytest.approx(5 + WINDOW / 0.1, abs=1)

    def test_a_clock_of_another_speed_is_ignored_after_its_second_jump(self) -> None:
        clock = SourceClock()
        told = [clock.measured(0.05 * n, 0.1 * n) for n in range(600)]
        assert not any(told[round(5 * JUMP / 0.1) :])


def test_a_value_carries_the_time_stamp_of_its_source() -> None:
    now = [5.0]
    newest: LatestValue[str] = LatestValue(lambda: now[0])
    newest.take("no stamp")
    assert newest.stamped is not None and newest.stamped.time == 5.0
    newest.take("in time", AHEAD)
    now[0] = 5.5
    newest.take("late", AHEAD + 0.1)
    assert newest.stamped.time == pytest.approx(5.1)
    assert newest.age == 0.0  # watchdogs count from the arrival


@pytest.mark.parametrize("ros", [1, 2])
def test_a_header_without_a_stamp_gives_no_time(ros: int) -> None:
    assert stamp_of({"header": header("odom", ros)}) is None
    assert stamp_of({}) is None
    stamp = {"secs": 3, "nsecs": 500_000_000} if ros == 1 else {"sec": 3, "nanosec": 500_000_000}
    assert stamp_of({"header": {"stamp": stamp}}) == 3.5


class TestOdometryHistory:
    def known(self, *of: tuple[float, Pose, Twist]) -> OdometryHistory:
        history = OdometryHistory()
        for number, (time, pose, twist) in enumerate(of):
            history.note(Stamped(Odometry(pose, twist), 99.0, number, time))
        return history

    def test_a_pose_between_two_samples_is_interpolated(self) -> None:
        history = self.known(
            (1.0, Pose(0.0, 0.0, 3.0), Twist(0.5, 1.0)),
            (1.2, Pose(0.0, 0.2, -3.0), Twist(0.5, 1.0)),
        )
        assert history.at(1.1).y == pytest.approx(0.1)
        assert abs(history.at(1.1).heading) == pytest.approx(pi, abs=1e-6)  # not the long way round
        assert history.at(0.5) == Pose(0.0, 0.0, 3.0)

    def test_a_pose_after_the_last_sample_is_extrapolated_for_a_short_time(self) -> None:
        history = self.known((1.0, Pose(1.0, 2.0, 0.0), Twist(0.5, 0.0)))
        assert history.at(1.1).x == pytest.approx(1.05)
        assert history.at(9.0).x == pytest.approx(1.0 + 0.5 * AHEAD_SECONDS)

    def test_a_reset_clock_clears_the_odometry_history(self) -> None:
        still = Twist(0.0, 0.0)
        history = self.known((50.0, Pose(1.0, 1.0, 0.0), still), (1.0, Pose(3.0, 0.0, 0.0), still))
        assert history.at(1.0) == Pose(3.0, 0.0, 0.0)


@pytest.mark.slow
def test_a_robot_keeps_its_place_on_a_network_that_loses_packets() -> None:
    kept = Kept()
    robot = LateRobot(LinkQuality(0.0, 0.03), 0, matched=True)
    for goal in (at_seat(0), at_seat(1), at_seat(2), FRONT):
        robot.navigator.go(goal)
        robot.go(kept)
    assert (kept.drives, kept.arrived, kept.lost, kept.spins) == (4, 4, 0, 0)
    assert max(kept.metres) < 0.3
