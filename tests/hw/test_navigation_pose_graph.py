"""A pose graph closes loops that drift opened, and refuses maps from slipping wheels."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_hw.device_protocols import Pose, Scan
from tangy_hw.navigation.alignment import aligned
from tangy_hw.navigation.mapping import PlacedScan
from tangy_hw.navigation.matched_map import JudgedMap, judged, with_loops_closed
from tangy_hw.navigation.pose_graph import close_loops
from tangy_hw.navigation.poses import compose, relative_pose
from tangy_hw.navigation.revisits import LoopClosure
from tests.hw.corridors import Slip, cluttered, driven_log, logged, ring

NOTHING = Scan(0.0, 0.01, np.zeros(0), 10.0)


def circle(number: int, radius: float) -> list[Pose]:
    """Return poses once around a circle, with the last at the first."""
    turns = np.linspace(0.0, 2 * pi, number)
    return [Pose(radius * np.sin(t), radius * (1 - np.cos(t)), float(t)) for t in turns]


def drifting(poses: list[Pose], turn: float, scale: float) -> list[PlacedScan]:
    """Return scans at poses by odometry with this drift per step."""
    counted = [poses[0]]
    for start, end in pairwise(poses):
        step = relative_pose(start, end)
        counted.append(
            compose(counted[-1], Pose(step.x * scale, step.y * scale, step.heading + turn))
        )
    return [PlacedScan(NOTHING, pose) for pose in counted]


@settings(max_examples=30, deadline=None)
@given(st.floats(-0.004, 0.004), st.floats(0.97, 1.03), st.integers(40, 120))
def test_closing_a_drifted_loop_restores_its_shape(turn: float, scale: float, number: int) -> None:
    true = circle(number, 4.0)
    scans = drifting(true, turn, scale)
    found = close_loops(scans, [LoopClosure(0, number - 1, relative_pose(true[0], true[-1]), 0.0)])
    assert found[0].pose == scans[0].pose
    apart = relative_pose(found[0].pose, found[-1].pose)
    assert hypot(apart.x, apart.y) < 0.1
    off = [hypot(f.pose.x - t.x, f.pose.y - t.y) for f, t in zip(found, true, strict=True)]
    before = [hypot(s.pose.x - t.x, s.pose.y - t.y) for s, t in zip(scans, true, strict=True)]
    assert max(off) <= max(before) + 0.1


def test_a_false_loop_closure_is_rejected() -> None:
    true = circle(80, 4.0)
    scans = drifting(true, 0.001, 1.0)
    right = [LoopClosure(n, 79 - n, relative_pose(true[n], true[79 - n]), 0.0) for n in range(4)]
    alike = LoopClosure(10, 45, Pose(0.0, 0.0, 0.0), 6.0)
    found = close_loops(scans, [*right, alike])
    off = [hypot(f.pose.x - t.x, f.pose.y - t.y) for f, t in zip(found, true, strict=True)]
    assert max(off) < 0.5


def test_poses_stay_unchanged_without_loop_closures() -> None:
    scans = drifting(circle(5, 1.0), 0.1, 1.0)
    assert close_loops(scans, []) == scans
    assert close_loops(scans[:1], [LoopClosure(0, 0, Pose(0, 0, 0), 0.0)]) == scans[:1]
    assert close_loops([], []) == []


def matched(scans: list[PlacedScan]) -> tuple[JudgedMap, JudgedMap]:
    drawn = judged(aligned(scans), 0.1)
    return drawn, with_loops_closed(drawn, 0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "scale", "noise"), [(51, 1.03, 0.06), (52, 1.05, 0.1)])
def test_a_map_torn_by_drift_is_closed(seed: int, scale: float, noise: float) -> None:
    walls, way = cluttered(32.0, 2.4, seed)
    log = driven_log(walls, way, seed, scale=scale, noise=noise)
    before, after = matched([one for one, _ in log])
    assert before.closes != "closed" and not before.by_graph
    assert after.closes == "closed" and after.by_graph
    true = [pose for _, pose in log]
    assert best_fit(after.scans, true) < best_fit(before.scans, true)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [61, 62, 63, 64])
def test_a_closed_map_has_correct_poses(seed: int) -> None:
    walls, way = cluttered(32.0, 2.4, seed)
    log = driven_log(walls, way, seed, scale=1.04, noise=0.08)
    before, after = matched([one for one, _ in log])
    assert after.by_graph == (after.closes != before.closes)
    if after.closes == "closed":
        assert best_fit(after.scans, [pose for _, pose in log]) < 0.5


@pytest.mark.slow
@pytest.mark.parametrize("seed", [71, 72])
def test_a_map_from_slipping_wheels_is_refused(seed: int) -> None:
    walls, way = ring(14.0, 2.0, 4.0)
    before, after = matched(logged(walls, way, seed, Slip(0.4, 0.06)))
    assert before.closes == after.closes == "torn" and not after.by_graph


def best_fit(scans: Sequence[PlacedScan], true: list[Pose]) -> float:
    """Return the error of poses, in m (root mean square, best fit)."""
    found = np.array([one.pose[:2] for one in scans])
    wanted = np.array([pose[:2] for pose in true])
    found, wanted = found - found.mean(axis=0), wanted - wanted.mean(axis=0)
    left, _, right = np.linalg.svd(found.T @ wanted)
    turned = found @ left @ np.diag([1, np.sign(np.linalg.det(left @ right))]) @ right
    return float(np.sqrt(((turned - wanted) ** 2).sum(axis=1).mean()))
