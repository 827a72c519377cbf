"""The parts of localisation: particles, the likelihood field, scan matching."""

from __future__ import annotations

from math import hypot, inf, pi
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_hw.device_protocols import Pose, Scan, Twist
from tangy_hw.navigation.likelihood import BEAMS, IN_CACHE, NEAREST, LikelihoodField, evenly
from tangy_hw.navigation.localisation import LEAD
from tangy_hw.navigation.occupancy import map_of_room
from tangy_hw.navigation.particles import (
    FEWEST,
    MOST,
    around,
    likeliest,
    move,
    moved,
    needed,
    resample,
)
from tangy_hw.navigation.pose_search import Search
from tangy_hw.navigation.poses import (
    IDENTITY,
    Floats,
    compose,
    endpoints,
    relative_pose,
    wrap,
)
from tangy_hw.navigation.recent_scans import BACK, MANY, Comparison, RecentScans
from tangy_hw.navigation.recent_scans import FEWEST as FEWEST_SCANS
from tangy_hw.navigation.scan_matching import Reference
from tangy_hw.navigation.slip_detection import SlipDetector
from tangy_profiles.room import load_room
from tests.hw.raycast import Wheels, driven, look, room_sides, tour

ROOM = load_room()
MAP = map_of_room(ROOM)
SIDES = room_sides(ROOM)
START = Pose(5.0, 1.2, 0.0)
ROUND = tour([(5, 1.2), (8, 4.2), (5, 1.2)])


def thin(scan: Scan, farthest: float) -> Floats:
    """Return the ends (n, 2), in m, of the beams that the particles are scored with."""
    return evenly(endpoints(scan, farthest, IDENTITY, NEAREST), BEAMS)


class TestParticles:
    @given(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(-1, 1), st.integers(0, 99))
    @settings(max_examples=25, deadline=None)
    def test_particles_follow_the_odometry_exactly_without_noise(
        self, x: float, y: float, turn: float, seed: int
    ) -> None:
        rng, step = np.random.default_rng(seed), Pose(x, y, turn)
        start = around(Pose(1, 2, 3), (1, 1, 1), 20, rng)
        moved = move(start, step, rng, alpha=0.0)
        for before, after in zip(start, moved, strict=True):
            there = compose(Pose(*before), step)
            if hypot(x, y) > 0.01:  # shorter steps are all turn
                assert after[:2] == pytest.approx(there[:2], abs=1e-9)
            assert abs(wrap(float(after[2]) - there.heading)) < 1e-9

    def test_the_likeliest_cluster_is_the_same_on_a_map_of_any_size(self) -> None:
        rng = np.random.default_rng(5)
        one, other = (around(Pose(x, 1, 3), (0.1, 0.1, 0.1), 40, rng) for x in (1, 8))
        weights = np.repeat([0.4, 0.6, 0.0], [40, 40, 1])
        found = [
            likeliest(np.vstack((one, other, [(far, far, 0)])), weights) for far in (9.0, 900.0)
        ]
        assert found[0][0] == found[1][0]
        assert found[0][0].x == pytest.approx(8, abs=0.1)

    @pytest.mark.parametrize("step", [Pose(2.0, 0, 0), Pose(0, 0, 2.0)])
    def test_one_long_step_adds_no_more_uncertainty_than_its_short_steps(self, step: Pose) -> None:
        rng = np.random.default_rng(2)
        many = start = np.zeros((4000, 3))
        for _ in range(20):
            many = move(many, Pose(step.x / 20, 0, step.heading / 20), rng)
        once = move(start, step, rng)
        assert once[:, 2].std() < 1.5 * many[:, 2].std()
        assert once[:, :2].std(axis=0).max() < 1.5 * many[:, :2].std(axis=0).max()

    def test_a_drive_backwards_is_as_certain_as_one_forwards(self) -> None:
        start = np.zeros((4000, 3))
        ahead = move(start, Pose(0.5, 0, 0), np.random.default_rng(1))
        back = move(start, Pose(-0.5, 0, 0), np.random.default_rng(1))
        assert back[:, 0].mean() == pytest.approx(-0.5, abs=0.03)
        assert back.std(axis=0) == pytest.approx(ahead.std(axis=0), rel=0.1)

    def test_a_move_without_noise_is_the_middle_of_those_with_noise(self) -> None:
        start, step = np.array([(1.0, 2.0, 0.5), (2.0, 1.0, -3.0)]), Pose(0.3, -0.1, 0.4)
        noiseless = move(start, step, np.random.default_rng(0), alpha=0.0)
        assert moved(start, step) == pytest.approx(noiseless)

    @given(st.lists(st.floats(0.01, 1), min_size=1, max_size=30), st.integers(1, 200))
    @settings(max_examples=25, deadline=None)
    def test_resampling_draws_particles_in_proportion_to_their_weights(
        self, weights: list[float], count: int
    ) -> None:
        shares = np.array(weights) / sum(weights)
        drawn = resample(np.arange(len(weights) * 3.0).reshape(-1, 3), shares, count,
                         np.random.default_rng(0))  # fmt: skip
        for number, share in enumerate(shares):
            times = int((drawn[:, 0] == number * 3).sum())
            assert abs(times - share * count) < 1 + 1e-6

    def test_a_wider_spread_needs_more_particles(self) -> None:
        rng = np.random.default_rng(0)
        here = needed(around(START, (0.05, 0.05, 0.02), 2000, rng))
        wide = needed(around(START, (2, 2, 2), 2000, rng))
        assert here == FEWEST < wide <= MOST

    def test_the_estimate_is_the_cluster_with_the_most_weight(self) -> None:
        rng = np.random.default_rng(0)
        both = np.vstack((around(Pose(1, 1, pi), (0.1, 0.1, 0.05), 300, rng),
                          around(Pose(8, 3, 0), (0.1, 0.1, 0.05), 200, rng)))  # fmt: skip
        pose, covariance = likeliest(both, np.full(500, 1 / 500))
        assert hypot(pose.x - 1, pose.y - 1) < 0.05 and abs(wrap(pose.heading - pi)) < 0.05
        assert np.sqrt(np.diag(covariance)) == pytest.approx([0.1, 0.1, 0.05], rel=0.3)


class TestField:
    def test_the_true_pose_has_the_best_score(self) -> None:
        field = LikelihoodField(MAP)
        true = Pose(4.0, 2.0, 0.7)
        points = thin(look(SIDES, true), 20.0)
        rng = np.random.default_rng(0)
        others = around(true, (0.5, 0.5, 0.5), 500, rng)
        others = others[np.abs(others - np.asarray(true)).max(axis=1) > 0.1]
        scores = field.scores(np.vstack((true, others)), points)
        assert scores[0] > 0.9 and scores[0] == scores.max()

    def test_poses_get_the_same_scores_together_and_alone(self) -> None:
        field = LikelihoodField(MAP)
        points = thin(look(SIDES, START), 20.0)
        poses = around(START, (3, 3, 2), IN_CACHE // len(points) + 7, np.random.default_rng(0))
        alone = [field.beams(one[None], points).mean() for one in poses]
        assert field.scores(poses, points) == pytest.approx(np.array(alone), abs=1e-5)

    @pytest.mark.parametrize("part", [1.0, 0.4])
    def test_a_map_tells_of_a_pose_if_it_explains_or_contradicts_enough_beams(
        self, part: float
    ) -> None:
        field, points = LikelihoodField(MAP), thin(look(SIDES, START), 20.0) * part
        poses = [Pose(*one) for one in around(START, (2, 2, 2), 40, np.random.default_rng(0))]
        shares = [field.evidence(pose, points).share for pose in poses]
        for least in (0.1, 0.2, 0.5):
            told = [field.tells(pose, points, least) for pose in poses]
            assert told == [share >= least for share in shares]
        assert min(shares) < 0.5 < max(shares)

    def test_only_beams_through_walls_lower_the_score(self) -> None:
        field, true = LikelihoodField(MAP), Pose(4.0, 2.0, 0.7)
        points = thin(look(SIDES, true), 20.0)
        right = field.evidence(true, points)
        short = field.evidence(true, np.vstack((points[:30], points[30:] * 0.5)))
        through = field.evidence(true, np.vstack((points[:30], points[30:] * 1.5)))
        assert right.score > 0.9 and right.share > 0.9
        assert short.score == pytest.approx(right.score, abs=0.1) and short.share < 0.7
        assert through.score < 0.7 and through.share > 0.9


class TestSearch:
    def test_random_places_cover_the_whole_floor_again_and_again(self) -> None:
        search = Search(MAP, LikelihoodField(MAP), np.random.default_rng(0))
        free = len(MAP.free_points())
        drawn = search.anywhere(2 * free)
        assert len(set(map(complex, *drawn.T[:2]))) == free
        assert drawn[:, 2].min() < -3.1 and drawn[:, 2].max() > 3.1

    @pytest.mark.parametrize("coarse", [2, 3, 4])
    def test_a_coarse_field_scores_poses_nearly_like_a_fine_one(self, coarse: int) -> None:
        poses = Search(MAP, LikelihoodField(MAP), np.random.default_rng(0)).anywhere(500)
        points = thin(look(SIDES, START), 20.0)
        fine = LikelihoodField(MAP, 0.8).scores(poses, points)
        rough = LikelihoodField(MAP, 0.8, coarse).scores(poses, points)
        assert np.abs(fine - rough).mean() < 0.02

    @pytest.mark.parametrize("turn", [-1.4, 1.4, 3.0])
    def test_a_missed_turn_is_found_in_few_tries(self, turn: float) -> None:
        search = Search(MAP, LikelihoodField(MAP), np.random.default_rng(0))
        points, found = thin(look(SIDES, START), 20.0), 0
        last = START._replace(heading=wrap(START.heading + turn))
        for _ in range(12):
            poses, scores = search.places(points, 32, 600, last)
            x, y, heading = poses[scores.argmax()]
            turned = abs(wrap(heading - START.heading))
            found += hypot(x - START.x, y - START.y) < 0.1 and turned < 0.1
        assert found >= 9

    def test_the_true_pose_is_among_the_best_ones_anywhere_in_the_room(self) -> None:
        field, rng = LikelihoodField(MAP), np.random.default_rng(0)
        search, found = Search(MAP, field, rng), 0
        for seed in range(20):
            x, y, heading = np.random.default_rng(seed).uniform((1, 1, -pi), (9, 4, pi))
            points = thin(look(SIDES, Pose(x, y, heading)), 20.0)
            poses, _ = search.places(points, 16, 3000, None)
            off = np.hypot(poses[:, 0] - x, poses[:, 1] - y)
            found += bool(((off < 0.2) & (np.abs(wrap(poses[:, 2] - heading)) < 0.1)).any())
        assert found >= 19


class TestRecentScans:
    OPPOSITE = Pose(ROOM.width, ROOM.depth, pi)  # turned by half, the walls look the same

    def compared(
        self, steps: int, *, swapped: bool = False, elsewhere: float = 0.9, hidden: bool = False
    ) -> tuple[Comparison, Pose, Pose]:
        """Drive; return the comparison, the true pose, and the opposite one.

        A search gives the score `elsewhere` to the place with which the pose is compared. If
        part of the room is `hidden`, one beam of four ends halfway.
        """
        rng = np.random.default_rng(3)
        recent, true, wheels = RecentScans(LikelihoodField(MAP), rng), START, Wheels(rng)
        for number in range(steps):
            points = thin(look(SIDES, true, rng), 20.0)
            points[::4] *= 0.5 if hidden else 1.0
            opposite = compose(self.OPPOSITE, true)
            here, other = (opposite, true) if swapped else (true, opposite)
            recent.note(wheels.pose, points, np.array([other]), np.array([elsewhere]))
            found = recent.compare(here, wheels.pose, points)
            if number < steps - 1:
                true = driven(true, Twist(0.5, 0.1), 1.0)
                wheels.turn(Twist(0.5, 0.1), 1.0)
        return found, true, opposite

    def test_the_scans_of_a_way_support_the_true_pose_more_than_its_mirror_image(self) -> None:
        (lead, rival, _), _, opposite = self.compared(FEWEST_SCANS)
        assert lead > 0.1 and rival is not None
        assert hypot(rival.x - opposite.x, rival.y - opposite.y) < 0.3

    def test_the_mirror_image_loses_and_the_true_pose_is_told(self) -> None:
        (lead, rival, over_rival), true, _ = self.compared(FEWEST_SCANS, swapped=True)
        assert lead < -0.1 and over_rival < -0.1 and rival is not None
        assert hypot(rival.x - true.x, rival.y - true.y) < 0.3

    def test_scans_that_each_fit_better_somewhere_name_no_better_place(self) -> None:
        found, _, _ = self.compared(FEWEST_SCANS, elsewhere=1.0, hidden=True)
        assert found.lead < 0.0 and found.over_rival == inf and found.rival is None

    def test_places_that_the_scans_rule_out_are_followed_no_further(self) -> None:
        scores = LikelihoodField.scores
        with patch.object(LikelihoodField, "scores", autospec=True, side_effect=scores) as every:
            self.compared(FEWEST_SCANS)
            followed, every.call_count = every.call_count, 0
            self.compared(FEWEST_SCANS, elsewhere=1.0, hidden=True)
        assert every.call_count == followed - len(BACK) * (FEWEST_SCANS - 1)

    def test_a_place_where_few_scans_fit_poorly_is_not_believed(self) -> None:
        for steps in (FEWEST_SCANS, MANY - 1):
            found, _, _ = self.compared(steps, elsewhere=0.1, hidden=True)
            assert found.lead == 0.0 and found.over_rival > LEAD
        assert self.compared(MANY, elsewhere=0.1, hidden=True)[0].lead > LEAD

    def test_few_scans_do_not_tell_two_places_apart(self) -> None:
        found, _, _ = self.compared(FEWEST_SCANS - 1)
        assert found.lead == -inf and found.rival is None

    def test_scans_at_one_place_count_as_one(self) -> None:
        rng = np.random.default_rng(3)
        recent = RecentScans(LikelihoodField(MAP), rng)
        for _ in range(2 * FEWEST_SCANS):
            points = thin(look(SIDES, START, rng), 20.0)
            found = recent.compare(START, IDENTITY, points)
        assert found.lead == -inf
        opposite = compose(self.OPPOSITE, START)
        recent.note(IDENTITY, points, np.array([opposite]), np.array([0.9]))
        assert 0.0 < recent.compare(START, IDENTITY, points, fewest=1).lead < inf

    def test_forgotten_scans_do_not_count(self) -> None:
        rng = np.random.default_rng(3)
        recent, true = RecentScans(LikelihoodField(MAP), rng), START
        for number in range(2 * FEWEST_SCANS):
            if number == FEWEST_SCANS + 1:
                recent.forget()
            points = thin(look(SIDES, true, rng), 20.0)
            found = recent.compare(true, true, points)
            true = driven(true, Twist(0.5, 0.1), 1.0)
        assert found.lead == -inf


class TestMatching:
    @given(st.floats(-0.15, 0.15), st.floats(-0.15, 0.15), st.floats(-0.15, 0.15))
    @settings(max_examples=25, deadline=None)
    def test_matching_two_scans_gives_the_motion_between_them(
        self, x: float, y: float, turn: float
    ) -> None:
        step = Pose(x, y, turn)
        first, second = look(SIDES, START), look(SIDES, compose(START, step))
        match = Reference(first).match(second, Pose(0, 0, 0))
        assert match.fits > 0.8
        assert match.pose == pytest.approx(step, abs=0.01)
        assert match.told == pytest.approx(np.eye(2), abs=1e-6)

    def test_matching_in_a_bare_corridor_leaves_the_distance_uncertain(self) -> None:
        corridor = np.array([(-50.0, -1, 50, -1), (-50.0, 1, 50, 1)])
        first = look(corridor, Pose(0, 0, 0))
        second = look(corridor, Pose(0.3, 0.1, 0.0))
        match = Reference(first).match(second, Pose(0.2, 0, 0))
        assert match.pose.y == pytest.approx(0.1, abs=0.01)
        assert match.pose.x == pytest.approx(0.2, abs=0.02)  # as guessed
        assert match.told == pytest.approx(np.diag([0.0, 1.0]), abs=0.01)


class TestSlipDetector:
    def slips(self, grip: float, seed: int = 0) -> list[float]:
        rng = np.random.default_rng(seed)
        true, wheels, detector = Pose(2.0, 2.0, 0.0), Wheels(rng), SlipDetector()
        found = []
        for twist in ROUND[:80]:
            goes = Twist(twist.forward * grip, twist.turn * grip)
            true = driven(true, goes, 0.1)
            scan = look(SIDES, true, rng)
            found.append(detector.update(wheels.turn(twist, 0.1), scan))
        return found

    @pytest.mark.parametrize("seed", [0, 1])
    def test_gripping_wheels_show_no_slip(self, seed: int) -> None:
        assert max(self.slips(1.0, seed)) < 0.15

    @pytest.mark.parametrize("grip", [0.0, 0.5])
    def test_slipping_wheels_show_slip(self, grip: float) -> None:
        assert max(self.slips(grip)) > 0.3

    def test_odometry_with_the_wrong_sign_counts_as_slip(self) -> None:
        true, counted, detector, found = START, Pose(0, 0, 0), SlipDetector(), []
        for _ in range(40):
            true = driven(true, Twist(-0.2, 0.1), 0.1)
            counted = driven(counted, Twist(0.2, 0.1), 0.1)
            found.append(detector.update(counted, look(SIDES, true)))
        assert max(found) > 0.3

    def test_the_slip_estimate_returns_to_zero_at_rest_and_after_a_reset(self) -> None:
        detector, counted = SlipDetector(), Pose(0, 0, 0)
        scan = look(SIDES, START)
        for _ in range(40):
            counted = driven(counted, Twist(0.3, 0), 0.1)
            slipped = detector.update(counted, scan)
        assert slipped > 0.3
        for _ in range(60):
            rested = detector.update(counted, scan)
        assert rested == 0.0
        detector.reset()
        assert detector.metres == 0.0

    def test_a_carried_robot_shows_no_slip(self) -> None:
        detector, counted = SlipDetector(), Pose(0, 0, 0)
        detector.update(counted, look(SIDES, START))
        carried = Pose(1.5, 3.5, 2.0)
        for number in range(20):
            counted = driven(counted, Twist(0.3, 0), 0.1)
            there = driven(carried, Twist(0.3, 0), 0.1 * (number + 1))
            assert detector.update(counted, look(SIDES, there)) < 0.3


def test_a_relative_pose_does_not_depend_on_the_frame() -> None:
    frame = Pose(3, -1, 2)
    one, other = Pose(1, 2, 0.5), Pose(0.5, 3, -2)
    assert relative_pose(compose(frame, one), compose(frame, other)) == pytest.approx(
        relative_pose(one, other)
    )
