"""Pauses: a robot waits for late data, resumes by itself, slowly at first, and counts pauses."""

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
    """A watch over one scanner that sends ten times a second, by the test's clock."""

    def __init__(self, liveness: Liveness | None = None) -> None:
        self.now = 100.0
        self.age = 0.0
        self.watch = PauseWatch(liveness or Liveness(), MotionLimits(), clock=lambda: self.now)
        self.watch.begin()

    @property
    def level(self) -> str:
        return self.watch.level

    def look(self, age: float, step: float = 0.1) -> str:
        """Advance the clock with the scanner's newest data this old; return why the robot waits."""
        self.now += step
        self.watch.look({"laser": age}, {"laser": age} if age > LIMIT else {})
        return self.watch.why

    def pause(self, seconds: float) -> None:
        """Let the scanner send nothing for this long, then as before."""
        age = 0.05
        while age < seconds:
            self.look(age)
            age += 0.1
        for _ in range(4):
            self.look(0.05)


def test_fresh_data_causes_no_pause() -> None:
    one = Watched()
    assert not any(one.look(age) for age in (0.05, 0.15, 0.25, 0.05))
    assert one.watch.count == 0 and one.watch.limited(FAST) == FAST


def test_a_pause_ends_after_three_fresh_readings() -> None:
    one = Watched()
    assert one.look(0.3) == "laser is late"
    assert one.look(0.05) and one.look(0.15, 0.05)  # the second look shows nothing new
    assert one.look(0.05)
    assert one.look(0.05) == "" and one.watch.count == 1


def test_late_data_during_a_pause_restarts_the_count() -> None:
    one = Watched()
    one.look(0.3)
    one.look(0.05)
    one.look(0.05)
    assert one.look(0.3)
    assert one.look(0.05) and one.look(0.05)
    assert one.look(0.05) == ""


def test_a_delayed_control_loop_counts_as_a_pause() -> None:
    one = Watched()
    one.look(0.05)
    assert one.look(0.05, 0.6) == "control is late"
    for _ in range(3):
        one.look(0.05)
    assert one.watch.why == "" and one.watch.count == 1


def test_the_robot_resumes_slowly_before_full_speed() -> None:
    one = Watched()
    one.pause(0.6)
    slow = one.watch.limited(FAST)
    assert 0 < slow.forward <= Liveness().slow_speed
    one.now += Liveness().slow_seconds
    assert one.watch.limited(FAST) == FAST


def test_frequent_pauses_are_reported_with_their_share_of_time() -> None:
    one = Watched()
    one.pause(0.5)
    assert one.level == "seldom"
    for _ in range(8):
        one.pause(0.7)
    assert one.level == "often" and 0.05 < one.watch.lost < 0.5
    one.now += 61
    assert one.level == "seldom" and one.watch.lost == 0.0


def test_the_warning_level_has_hysteresis() -> None:
    one = Watched(Liveness(warn_share=0.05, window_seconds=20))
    one.pause(0.9)
    first = one.now
    for _ in range(40):
        one.look(0.05)
    one.pause(0.9)
    assert one.level == "often"
    one.now = first + 20.5  # the first is out of the window; the second alone is too little
    assert 0.025 < one.watch.lost < 0.05 and one.level == "often"
    one.now += 20
    assert one.level == "seldom"


def test_a_pause_as_long_as_a_fault_is_not_counted() -> None:
    one = Watched()
    one.pause(Liveness().fault_after + 1)
    assert one.watch.count == 0 and one.watch.lost == 0.0


def test_a_watch_before_its_start_holds_nothing_up() -> None:
    watch = PauseWatch(Liveness(), MotionLimits())
    watch.look({"laser": 9.0}, {"laser": 9.0})
    assert watch.why == "" and watch.limited(FAST) == FAST


class TestRecorded:
    """Beats of a robot on the bench, as `python -m tests.bench.jitter record` records them."""

    def test_a_recording_of_a_busy_machine_has_no_faults(self) -> None:
        told = replay(read_beats(BEATS / "busy.csv"), ROBOT)
        assert told.faults == ()

    def test_delays_up_to_a_second_are_pauses_and_longer_ones_are_faults(self) -> None:
        told = replay(read_beats(BEATS / "held-up.csv"), ROBOT)
        assert told.faults.count("link") == 3  # the link was held up for two seconds three times
        assert told.pauses >= 20 and told.longest <= ROBOT.liveness.fault_after + GIVES_UP_SECONDS


@pytest.mark.parametrize("share", [0.0, -1.0, 1.5])
def test_an_invalid_share_is_refused_with_its_key(share: float, tmp_path: Path) -> None:
    from tangy_profiles.errors import ProfileError

    text = ROBOT.file.read_text().replace("warn_share = 0.05", f"warn_share = {share}")
    file = tmp_path / "mine.toml"
    file.write_text(text)
    with pytest.raises(ProfileError, match=r"liveness\.warn_share"):
        load_robot(str(file))
