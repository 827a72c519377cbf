"""Reading and writing the ROS messages of bridges for ROS 1 and ROS 2."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import Pose, Twist
from tangy_hw.drivers.ros_messages import (
    changed_share,
    heading_of,
    joined_names,
    joints_of,
    near_share,
    odometry_of,
    pose_message,
    pose_of,
    quaternion_message,
    scan_of,
    seen_from,
    statuses_of,
    time_message,
    trajectory_message,
    twist_message,
    twist_of,
    within,
)
from tangy_hw.watchdogs import BLIND

METRES = st.floats(-50, 50)
HEADINGS = st.floats(-3.1, 3.1)
POSES = st.builds(Pose, METRES, METRES, HEADINGS)


@given(st.floats(0, 1e9), st.sampled_from([1, 2]))
def test_times_are_read_back_unchanged(seconds: float, ros: int) -> None:
    message = time_message(seconds, ros)
    assert set(message) == ({"secs", "nsecs"} if ros == 1 else {"sec", "nanosec"})
    assert 0 <= list(message.values())[1] < 1_000_000_000
    whole, rest = message.values()
    assert whole + rest / 1e9 == pytest.approx(seconds, abs=2e-7)


@given(POSES)
def test_poses_are_read_back_unchanged(pose: Pose) -> None:
    assert pose_of(json.loads(json.dumps(pose_message(pose)))) == pytest.approx(pose)


@given(POSES, POSES)
def test_a_pose_survives_the_trip_to_the_map_frame_and_back(pose: Pose, origin: Pose) -> None:
    there = within(pose, origin)
    back = seen_from(there, origin)
    assert back[:2] == pytest.approx(pose[:2], abs=1e-6)
    assert math.cos(back.heading - pose.heading) == pytest.approx(1)
    assert math.dist(there[:2], origin[:2]) == pytest.approx(math.hypot(*pose[:2]), abs=1e-6)


def test_a_room_turned_by_a_quarter_in_the_map() -> None:
    assert within(Pose(1, 0, 0), Pose(10, 20, math.pi / 2)) == pytest.approx((10, 21, math.pi / 2))


@given(HEADINGS, st.floats(-0.3, 0.3), st.floats(0.5, 2))
def test_a_heading_ignores_tilt_and_rounding(heading: float, lean: float, length: float) -> None:
    """A quaternion tilted about the robot's own axis, and not of length one."""
    turn = quaternion_message(heading)
    z, w, s, c = turn["z"], turn["w"], math.sin(lean / 2), math.cos(lean / 2)
    leaning = {"x": -z * s, "y": w * s, "z": z * c, "w": w * c}
    assert heading_of({axis: length * part for axis, part in leaning.items()}) == pytest.approx(
        heading, abs=1e-6
    )


def test_twist_and_odometry() -> None:
    twist = Twist(0.3, -0.5)
    assert twist_of(twist_message(twist)) == twist
    pose = Pose(1.0, 2.0, 0.5)
    message = {"pose": {"pose": pose_message(pose)}, "twist": {"twist": twist_message(twist)}}
    assert odometry_of(message).pose == pytest.approx(pose)
    assert odometry_of(message).twist == twist
    message["pose"]["pose"]["position"]["x"] = math.nan
    with pytest.raises(ValueError, match="no finite number"):
        odometry_of(message)


SCAN: dict[str, Any] = {
    "angle_min": -2.0, "angle_increment": 0.5, "range_min": 0.1, "range_max": 5.0,
}  # fmt: skip


class TestScans:
    def test_beams_without_a_valid_echo_are_infinite(self) -> None:
        ranges = [1.0, None, math.nan, math.inf, 0.05, 0.0, 5.0, 5.01, -1.0]
        scan, raw = scan_of({**SCAN, "ranges": ranges}, 0.25)
        assert scan.ranges.tolist() == [1.0] + [math.inf] * 5 + [5.0] + [math.inf] * 2
        assert (scan.first, scan.step, scan.farthest) == (-1.75, 0.5, 5.0)
        assert near_share(raw, 0.15) == pytest.approx(1 / 9)

    @pytest.mark.parametrize(
        "wrong",
        [
            {"ranges": []},
            {"ranges": [[1]]},
            {"ranges": "x"},
            {"angle_increment": 0},
            {"range_max": None},
        ],
    )
    def test_an_invalid_scan_is_refused(self, wrong: dict[str, Any]) -> None:
        with pytest.raises((ValueError, TypeError)):
            scan_of({**SCAN, "ranges": [1.0], **wrong})

    def test_a_scan_of_nothing_but_null_shows_nothing_near_and_nothing_new(self) -> None:
        scans = [scan_of({**SCAN, "ranges": [None] * 20}) for _ in range(3)]
        assert np.isinf(scans[0][0].ranges).all()
        assert near_share(scans[0][1], 0.15) == 0
        assert changed_share([raw for _, raw in scans]) < BLIND

    def test_identical_beams_count_as_unchanged(self) -> None:
        first = np.array([1.0, 2.0, math.nan, math.inf])
        assert changed_share([first, first.copy()]) == 0
        assert changed_share([first, np.array([1.0, 2.1, 3.0, math.inf]), first]) == 0.5


class TestJoints:
    def test_a_trajectory_says_where_and_when_in_either_spelling(self) -> None:
        for ros, when in (
            (1, {"secs": 1, "nsecs": 500_000_000}),
            (2, {"sec": 1, "nanosec": 500_000_000}),
        ):
            message = trajectory_message({"head/neck nod": 0.3, "head/mouth": 0.0}, 1.5, ros)
            assert message["joint_names"] == ["head/neck nod", "head/mouth"]
            assert message["points"][0]["positions"] == [0.3, 0.0]
            assert message["points"][0]["time_from_start"] == when

    def test_states_of_joints_may_lack_positions_but_not_some_of_them(self) -> None:
        assert joints_of({"name": ["a", "b"], "position": [1, 2.5]}) == {"a": 1.0, "b": 2.5}
        assert joints_of({"name": ["a", "b"], "position": []}) == {}
        with pytest.raises(ValueError):
            joints_of({"name": ["a", "b"], "position": [1]})
        with pytest.raises(ValueError):
            joints_of({"name": ["a"], "position": [None]})

    def test_a_profile_maps_other_joint_names(self) -> None:
        text = "head/neck nod = head_tilt, head/neck shake=head_pan,"
        assert joined_names(text) == {"head/neck nod": "head_tilt", "head/neck shake": "head_pan"}
        for wrong in ("head", "=x", "a=", "a=b, a=c"):
            with pytest.raises(ValueError):
                joined_names(wrong)


class TestDiagnoses:
    def test_levels_are_numbers_or_the_bytes_that_some_write(self) -> None:
        statuses = [
            {
                "level": level,
                "name": str(place),
                "message": "m",
                "values": [{"key": "a", "value": 1}],
            }
            for place, level in enumerate([0, 1, 2, 3, "\x02", "3"])
        ]
        found = statuses_of({"status": statuses})
        assert [state for _, state, _, _ in found] == [
            "OK",
            "WARN",
            "ERROR",
            "STALE",
            "ERROR",
            "STALE",
        ]
        assert found[0][2:] == ("m", {"a": "1"})

    @pytest.mark.parametrize("level", [4, -1, True, None, "x", "12", 1.5])
    def test_an_unknown_level_is_refused(self, level: Any) -> None:
        with pytest.raises(ValueError):
            statuses_of({"status": [{"level": level, "name": "a"}]})
