"""Pauses: a robot waits for late data, goes on by itself, slowly at first, and counts that."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_hw.device_protocols import Twist
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.robot_process.pause_watch import GIVES_UP_SECONDS, PauseWatch
from tangy_profiles.liveness import Liveness
from tangy_profiles.robot import load_robot
from tests.bench.jitter import read_beats, replay

ROBOT = load_robot()
LIMIT = ROBOT.devices["laser"].stale_after
BEATS = Path(__file__).parent / "beats"
FAST = Twist(0.5, 0.0)


class Watched:
    """A watch over one scanner that sends ten times a second, by a clock of its own."""

    def __init__(self, liveness: Liveness | None = None) -> None:
        self.now = 100.0
        self.age = 0.0
        self.watch = PauseWatch(liveness or Liveness(), MotionLimits(), clock=lambda: self.now)
        self.watch.begin()

    @property
    def level(self) -> str:
        return self.watch.level

    def look(self, age: float, step: float = 0.1) -> str:
        """Let time pass and the scanner's newest data be so old; return why the robot waits."""
        self.now += step
        self.watch.look({"laser": age}, {"laser": age} if age > LIMIT else {})
        return self.watch.why

    def pause(self, seconds: float) -> None:
        """Let the scanner send nothing for so long, and again as before."""
        age = 0.05
        while age < seconds:
            self.look(age)
            age += 0.1
        for _ in range(4):
            self.look(0.05)


def test_data_that_is_young_enough_holds_nothing_up() -> None:
    one = Watched()
    assert not any(one.look(age) for age in (0.05, 0.15, 0.25, 0.05))
    assert one.watch.count == 0 and one.watch.limited(FAST) == FAST


def test_it_waits_until_three_fresh_readings_have_come() -> None:
    one = Watched()
    assert one.look(0.3) == "laser is late"
    assert one.look(0.05) and one.look(0.15, 0.05)  # the second look shows nothing new
    assert one.look(0.05)
    assert one.look(0.05) == "" and one.watch.count == 1


def test_late_data_in_between_begins_anew() -> None:
    one = Watched()
    one.look(0.3)
    one.look(0.05)
    one.look(0.05)
    assert one.look(0.3)
    assert one.look(0.05) and one.look(0.05)
    assert one.look(0.05) == ""


def test_a_control_that_was_held_up_is_a_pause_too() -> None:
    one = Watched()
    one.look(0.05)
    assert one.look(0.05, 0.6) == "control is late"
    for _ in range(3):
        one.look(0.05)
    assert one.watch.why == "" and one.watch.count == 1


def test_it_goes_on_slowly_at_first_and_then_as_before() -> None:
    one = Watched()
    one.pause(0.6)
    slow = one.watch.limited(FAST)
    assert 0 < slow.forward <= Liveness().slow_speed
    one.now += Liveness().slow_seconds
    assert one.watch.limited(FAST) == FAST


def test_pauses_that_come_often_are_told_with_the_share_of_time_and_rare_ones_are_not() -> None:
    one = Watched()
    one.pause(0.5)
    assert one.level == "seldom"
    for _ in range(8):
        one.pause(0.7)
    assert one.level == "often" and 0.05 < one.watch.lost < 0.5
    one.now += 61
    assert one.level == "seldom" and one.watch.lost == 0.0


def test_a_level_is_not_left_before_half_of_what_led_there_is_over() -> None:
    one = Watched(Liveness(warn_share=0.05, window_seconds=20))
    one.pause(0.9)
    first = one.now
    for _ in range(40):
        one.look(0.05)
    one.pause(0.9)
    assert one.level == "often"
    one.now = first + 20.5  # the first is out of sight; the second alone would not have been told
    assert 0.025 < one.watch.lost < 0.05 and one.level == "often"
    one.now += 20
    assert one.level == "seldom"


def test_what_lasted_so_long_that_it_was_a_fault_is_no_pause() -> None:
    one = Watched()
    one.pause(Liveness().fault_after + 1)
    assert one.watch.count == 0 and one.watch.lost == 0.0


def test_before_it_is_begun_it_waits_for_nothing() -> None:
    watch = PauseWatch(Liveness(), MotionLimits())
    watch.look({"laser": 9.0}, {"laser": 9.0})
    assert watch.why == "" and watch.limited(FAST) == FAST


class TestRecorded:
    """Beats of a robot on the bench, as `python -m tests.bench.jitter record` keeps them."""

    def test_a_busy_machine_is_no_fault(self) -> None:
        told = replay(read_beats(BEATS / "busy.csv"), ROBOT)
        assert told.faults == ()

    def test_hold_ups_of_up_to_a_second_are_pauses_and_longer_ones_are_faults(self) -> None:
        told = replay(read_beats(BEATS / "held-up.csv"), ROBOT)
        assert told.faults.count("link") == 3  # it was held up for two seconds three times
        assert told.pauses >= 20 and told.longest <= ROBOT.liveness.fault_after + GIVES_UP_SECONDS


@pytest.mark.parametrize("share", [0.0, -1.0, 1.5])
def test_a_share_that_is_none_is_refused_by_name(share: float, tmp_path: Path) -> None:
    from tangy_profiles.errors import ProfileError

    text = ROBOT.file.read_text().replace("warn_share = 0.05", f"warn_share = {share}")
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises(ProfileError, match=r"liveness\.warn_share"):
        load_robot(str(file))
