"""Planning and driving: paths that keep their clearance, and the pursuit of a path."""

from __future__ import annotations

from math import hypot, inf, pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, Pose, Scan, Twist
from tangy_hw.navigation.clearance import free_ahead
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.navigation.occupancy import FREE, map_of_room
from tangy_hw.navigation.planning import (
    BESIDE,
    FOOTPRINT,
    KEEP,
    RADIUS,
    PlanError,
    inflate,
    line_cost,
    nearest_free,
    plan,
    resample,
)
from tangy_hw.navigation.poses import lengths
from tangy_hw.navigation.pursuit import Pursuit
from tangy_profiles.room import load_room
from tests.hw.raycast import driven, look, room_sides, sides

ROOM = load_room()
MAP = map_of_room(ROOM)
COSTS = inflate(MAP)
EMPTY = Scan(-2.0, 0.1, np.full(41, inf), 30.0)
LIMITS = MotionLimits()


class TestPlanning:
    @given(st.floats(0.5, 9.5), st.floats(0.5, 4.4), st.floats(0.5, 9.5), st.floats(0.5, 4.4))
    @settings(max_examples=20, deadline=None)
    def test_a_path_leads_from_start_to_goal_without_contact(
        self, ax: float, ay: float, bx: float, by: float
    ) -> None:
        path = plan(MAP, (ax, ay), (bx, by))
        assert path is not None
        assert path.points[0] == pytest.approx((ax, ay))
        assert path.points[-1] == pytest.approx((bx, by))
        rows, columns = MAP.cells_of(path.points)
        assert (COSTS.distance[rows, columns] >= RADIUS).all()
        assert path.length >= hypot(bx - ax, by - ay) - 1e-6
        assert lengths(np.diff(path.points, axis=0)).max() <= 0.05 + 1e-9

    def test_a_path_leads_round_the_table(self) -> None:
        path = plan(MAP, (5, 4.3), (5, 7.3))
        assert path is not None and path.length > 7
        rows, columns = MAP.cells_of(path.points)
        assert not MAP.keep_out[rows, columns].any()

    def test_a_path_in_free_space_is_straight(self) -> None:
        path = plan(MAP, (2, 2), (8, 3))
        assert path is not None and path.length == pytest.approx(hypot(6, 1), rel=1e-3)

    def test_a_smoothed_path_costs_no_more_than_the_grid_path(self) -> None:
        path = plan(MAP, (1, 1), (9, 7))
        assert path is not None
        spent = sum(line_cost(COSTS, a, b)
                    for a, b in zip(path.points, path.points[1:], strict=False))  # fmt: skip
        assert spent <= path.cost * 1.02

    def test_a_path_keeps_clearance_from_an_obstacle(self) -> None:
        chair = np.array([[5.0, 2.5]])
        path = plan(MAP, (5, 1.2), (5, 4.3), chair)
        assert path is not None and path.length > 3.1
        assert lengths(path.points - chair).min() >= RADIUS

    @pytest.mark.parametrize("at", [(5.0, 2.5), (4.6, 3.0), (5.3, 2.0)])
    def test_paths_keep_more_clearance_from_people(self, at: tuple[float, float]) -> None:
        legs = np.array([(at[0] + x, at[1] + y) for x in (-0.1, 0.1) for y in (-0.06, 0.06)])
        path = plan(MAP, (5, 1.2), (5, 4.3), legs)
        assert path is not None
        assert lengths(path.points - at).min() >= FOOTPRINT + 0.37

    def test_a_path_leads_round_two_people_who_stand_together(self) -> None:
        pair = np.array([[4.4, 2.5], [5.6, 2.5]])
        path = plan(MAP, (5, 1.2), (5, 4.3), pair)
        assert path is not None and path.length > 3.5
        for one in pair:
            assert lengths(path.points - one).min() >= KEEP

    @pytest.mark.parametrize("far", [0.5, 0.6, 0.7, 0.9])
    @pytest.mark.parametrize("side", range(4))
    def test_a_path_to_a_goal_beside_a_person_comes_no_nearer_than_the_goal(
        self, far: float, side: int
    ) -> None:
        goal, angle = (3.0, 2.5), side * pi / 2
        person = np.array([[goal[0] + far * np.cos(angle), goal[1] + far * np.sin(angle)]])
        for ends in (((7.0, 2.5), goal), (goal, (7.0, 2.5))):
            path = plan(MAP, *ends, person)
            assert path is not None
            assert lengths(path.points - person).min() >= min(far, KEEP) - 0.06

    def test_a_goal_in_contact_with_a_person_has_no_path(self) -> None:
        assert plan(MAP, (7, 2.5), (3, 2.5), np.array([[3.0 + BESIDE - 0.05, 2.5]])) is None

    def test_no_path_leads_through_a_row_of_chairs(self) -> None:
        chairs = np.column_stack((np.arange(0, 10.1, 0.2), np.full(51, 2.5)))
        assert plan(MAP, (5, 1.2), (5, 4.3), chairs) is None

    def test_an_occupied_goal_has_no_path(self) -> None:
        assert plan(MAP, (5, 1.2), (5, 4.3), np.array([[5.0, 4.3]])) is None

    @pytest.mark.parametrize(
        ("goal", "told"),
        [
            ((5.0, 5.4), "inside an obstacle; the nearest free point is"),
            ((5.0, 4.8), "within 0.32 m of one"),
            ((50.0, 1.0), "outside the map"),
            ((5.0, -0.3), "inside an obstacle"),
        ],
    )
    def test_an_unreachable_goal_has_a_reason(self, goal: tuple[float, float], told: str) -> None:
        with pytest.raises(PlanError, match=told):
            plan(MAP, (5, 1.2), goal)

    def test_a_path_leads_away_from_a_wall_that_is_too_near(self) -> None:
        path = plan(MAP, (0.15, 2.0), (5.0, 2.0))
        assert path is not None and path.points[0] == pytest.approx((0.15, 2.0))

    def test_the_nearest_free_point_is_free_and_near(self) -> None:
        x, y = nearest_free(COSTS, 5.0, 4.8)
        assert np.isfinite(COSTS.at(x, y)) and hypot(x - 5.0, y - 4.8) < 0.2
        with pytest.raises(PlanError):
            nearest_free(COSTS, 5.0, 5.4, within=0.1)

    def test_costs_fall_with_the_distance_from_obstacles(self) -> None:
        across = [COSTS.at(x, 2.5) for x in (0.2, 0.45, 0.8, 2.0)]
        assert across == sorted(across, reverse=True) and across[0] == inf and across[3] < 1.1


class TestFreeAhead:
    def test_the_free_distance_straight_ahead_matches_the_geometry(self) -> None:
        points = np.array([[2.0, 0.0], [1.0, 0.5], [-0.5, 0.0]])
        assert free_ahead(points, 0.0, 0.3) == pytest.approx(1.7)

    def test_points_beside_the_path_do_not_block_it(self) -> None:
        assert free_ahead(np.array([[1.0, 0.31], [1.0, -0.31]]), 0.0, 0.3) == inf

    @given(st.floats(0.2, 1.5), st.sampled_from([-1, 1]))
    @settings(max_examples=20, deadline=None)
    def test_the_free_distance_follows_the_arc(self, angle: float, side: int) -> None:
        radius = 2.0
        point = [radius * np.sin(angle), side * radius * (1 - np.cos(angle))]
        free = free_ahead(np.array([point]), side / radius, 0.2)
        assert free == pytest.approx(radius * angle - 0.2, abs=1e-6)

    def test_the_free_distance_without_points_is_infinite(self) -> None:
        assert free_ahead(np.zeros((0, 2)), 0.5, 0.3) == inf


def follow(
    pursuit: Pursuit, pose: Pose, walls: np.ndarray | None = None, seconds: float = 60
) -> tuple[Pose, list[Twist], list[Pose]]:
    """Drive exactly as commanded until it arrives; return the end, the commands and the path."""
    twist, told, way = STILL, [], [pose]
    for _ in range(int(seconds * 10)):
        scan = EMPTY if walls is None else look(walls, pose)
        twist = pursuit.command(pose, twist, scan, 0.1)
        if pursuit.state == "arrived":
            break
        told.append(twist)
        pose = driven(pose, twist, 0.1)
        way.append(pose)
    return pose, told, way


class TestPursuit:
    @given(st.floats(-pi, pi), st.floats(-pi, pi), st.floats(0.3, 4.0), st.floats(-pi, pi))
    @settings(max_examples=25, deadline=None)
    def test_the_robot_reaches_position_and_heading_from_any_start(
        self, heading: float, final: float, far: float, way: float
    ) -> None:
        goal = np.array([far * np.cos(way), far * np.sin(way)])
        pursuit = Pursuit(resample(np.array([[0.0, 0.0], goal])), final)
        pose, _, _ = follow(pursuit, Pose(0.0, 0.0, heading))
        assert pursuit.state == "arrived"
        assert hypot(pose.x - goal[0], pose.y - goal[1]) < 0.08
        assert abs((pose.heading - final + pi) % (2 * pi) - pi) < 0.05

    def test_the_robot_follows_a_path_with_corners(self) -> None:
        corners = resample(np.array([[0, 0], [2, 0], [2, 2], [4, 2]], dtype=float))
        _, _, way = follow(Pursuit(corners, 0.0), Pose(0, 0, 0))
        off = [lengths(corners - (pose.x, pose.y)).min() for pose in way]
        assert max(off) < 0.25

    def test_speeds_and_their_changes_stay_within_limits(self) -> None:
        path = resample(np.array([[0, 0], [3, 0], [3, 3]], dtype=float))
        _, told, _ = follow(Pursuit(path, pi), Pose(0, 0, pi / 2))
        forward, turn = np.array(told).T
        assert forward.min() >= 0 and forward.max() <= LIMITS.max_speed + 1e-9
        assert abs(turn).max() <= LIMITS.max_turn + 1e-9
        assert np.diff(forward).max() <= LIMITS.acceleration * 0.1 + 1e-9
        assert forward.max() > 0.9 * LIMITS.max_speed

    def test_the_robot_turns_on_the_spot_if_the_path_lies_behind(self) -> None:
        pursuit = Pursuit(resample(np.array([[0.0, 0.0], [-2.0, 0.0]])))
        twist = pursuit.command(Pose(0, 0, 0), STILL, EMPTY, 0.1)
        assert pursuit.state == "turning" and twist.forward == 0 and twist.turn != 0

    @pytest.mark.parametrize("ahead", [0.8, 1.5, 2.5])
    def test_the_robot_stops_before_an_obstacle_on_the_path(self, ahead: float) -> None:
        pursuit = Pursuit(resample(np.array([[0.0, 0.0], [4.0, 0.0]])))
        box = sides((ahead, -0.2, ahead + 0.3, 0.2))
        pose, _, _ = follow(pursuit, Pose(0, 0, 0), box, seconds=15)
        assert pursuit.state == "waiting"
        assert LIMITS.radius < ahead - pose.x < LIMITS.radius + 0.35

    def test_the_robot_continues_when_the_path_is_free(self) -> None:
        pursuit = Pursuit(resample(np.array([[0.0, 0.0], [4.0, 0.0]])))
        pose, _, _ = follow(pursuit, Pose(0, 0, 0), sides((1.5, -0.2, 1.8, 0.2)), seconds=10)
        assert pursuit.state == "waiting"
        follow(pursuit, pose)
        assert pursuit.state == "arrived"  # type: ignore[comparison-overlap]

    def test_an_obstacle_behind_the_goal_does_not_block_arrival(self) -> None:
        pursuit = Pursuit(resample(np.array([[0.0, 0.0], [2.0, 0.0]])), 0.0)
        pose, _, _ = follow(pursuit, Pose(0, 0, 0), sides((2.45, -2, 2.6, 2)))
        assert pursuit.state == "arrived" and abs(pose.x - 2.0) < 0.1

    def test_the_robot_drives_slowly_near_people(self) -> None:
        path = resample(np.array([[0.0, 0.0], [6.0, 0.0]]))
        pursuit, pose, twist = Pursuit(path, 0.0), Pose(0, 0, 0), STILL
        person = np.array([[3.0, 0.8]])
        for _ in range(300):
            twist = pursuit.command(pose, twist, EMPTY, 0.1, person)
            near = hypot(pose.x - 3.0, pose.y - 0.8) < LIMITS.people_range
            assert not near or twist.forward <= LIMITS.people_speed
            pose = driven(pose, twist, 0.1)
        assert pursuit.state == "arrived"

    def test_the_robot_passes_the_table_without_contact(self) -> None:
        path = plan(MAP, (5, 1.2), (8, 4.3))
        assert path is not None
        _, _, way = follow(Pursuit(path.points, pi / 2), Pose(5, 1.2, pi / 2), room_sides(ROOM))
        rows, columns = MAP.cells_of(np.array(way)[:, :2])
        assert (MAP.cells[rows, columns] == FREE).all()
        assert COSTS.distance[rows, columns].min() > LIMITS.radius
