"""Path planning on a map: costs near obstacles, and the cheapest path.

Obstacles are inflated by Euclidean distance. Dijkstra's algorithm in its geometric form
(`skimage.graph.MCP_Geometric`: a step costs its length times the mean of the costs at its ends)
finds the cheapest path over the grid, which is then straightened where that costs nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, hypot, inf

import cv2
import numpy as np
from numpy.typing import NDArray
from skimage.graph import MCP_Geometric

from tangy_hw.navigation.occupancy import OccupancyMap
from tangy_hw.navigation.poses import Floats, lengths
from tangy_profiles.errors import TangyError

FOOTPRINT = 0.25  # metres from the robot's centre to its edge
RADIUS = FOOTPRINT + 0.07  # metres that the robot's centre keeps from obstacles on the map
KEEP = FOOTPRINT + 0.42
"""Metres that the robot's centre keeps from obstacles that are not on the map and may be people:
the torso extends up to .17 m beyond the visible legs, with .25 m to spare."""
BESIDE = FOOTPRINT + 0.2
"""Metres kept from a person beside an end of the path. The end does not move, and the robot still
does not touch the torso."""
COMFORT = 0.25  # metres in which the extra cost near an obstacle falls to 1/e
DISLIKE = 4.0  # extra cost factor right beside an obstacle
SQUEEZE = 12.0  # extra cost factor nearer to people than `keep`
YIELD, YIELD_WITHIN = 6.0, 0.45
"""Extra cost factor at a walking person, and the m in which it falls to 1/e."""
STEP = 0.05  # metres between the points of a path
OUT = 0.5  # metres that a robot too near to an obstacle may move to get free
AS_CHEAP = 1.01  # cost of a straight line, as a share of the points' that it may replace
SLACK = 0.1  # metres (two cells) of tolerance around an end of a path


class PlanError(TangyError):
    """A goal that can never be reached; one sentence that says why."""


@dataclass(frozen=True, eq=False)
class Costs:
    """Cost factor of each cell (rows, columns); inf where the robot would touch an obstacle.

    `distance` is the distance to the nearest obstacle, in m.
    """

    map: OccupancyMap
    cost: Floats
    distance: Floats

    def at(self, x: float, y: float) -> float:
        """Return the cost factor (ratio to the path length) at a point in m; inf off the map."""
        row, column = self.map.cell(x, y)
        return float(self.cost[row, column]) if self.map.inside(row, column) else inf


@dataclass(frozen=True, eq=False)
class Path:
    """A path: points (n, 2) some centimetres apart, its length in m, and its cost."""

    points: Floats
    length: float
    cost: float


def inflate(
    map_: OccupancyMap,
    blocked: Floats | None = None,
    radius: float = RADIUS,
    keep: float = KEEP,
    ends: Sequence[tuple[float, float]] = (),
    walking: Floats | None = None,
) -> Costs:
    """Return the cost of each cell, with additional obstacles at `blocked` (n, 2).

    Args:
        map_: the map.
        blocked: additional obstacles, which may be people.
        radius: minimum distance of the robot's centre from obstacles on the map, in m.
        keep: minimum distance from `blocked`, in m.
        ends: ends of the path, where it may come nearer to obstacles.
        walking: current and predicted positions of walkers (n, 2), which paths avoid if possible.
    """
    distance = _distance(map_, ~map_.obstacles)
    spare = distance - radius
    closed, squeezed = distance < radius, np.zeros(map_.shape, dtype=np.bool_)
    if blocked is not None and len(blocked):
        beside = near_ends(blocked, ends, keep)
        nearer = min(radius + BESIDE - RADIUS, keep)
        for points, hard in ((blocked[~beside], keep), (blocked[beside], nearer)):
            if len(points):
                free = np.ones(map_.shape, dtype=np.bool_)
                free[map_.cells_of(points)] = False
                away = _distance(map_, free)
                closed |= away < hard
                squeezed |= away < keep
                spare = np.minimum(spare, away - keep)
                distance = np.minimum(distance, away)
    cost = 1.0 + DISLIKE * np.exp(-spare / COMFORT) + SQUEEZE * squeezed
    if walking is not None and len(walking):
        free = np.ones(map_.shape, dtype=np.bool_)
        free[map_.cells_of(walking)] = False
        cost += YIELD * np.exp(-_distance(map_, free) / YIELD_WITHIN)
    cost[closed] = inf
    return Costs(map_, cost, distance)


def near_ends(
    blocked: Floats, ends: Sequence[tuple[float, float]], keep: float = KEEP
) -> NDArray[np.bool_]:
    """Return which points (n, 2) are within `keep` m of an end of the path."""
    near = np.zeros(len(blocked), dtype=np.bool_)
    for end in ends:
        near |= lengths(blocked - end) < keep + SLACK
    return near


def _distance(map_: OccupancyMap, free: NDArray[np.bool_]) -> Floats:
    """Return the distance of each cell to the nearest cell that is not free, in m."""
    if free.all():
        return np.full(map_.shape, max(map_.size))
    # exact, as scipy's version, in a sixth of the time
    cells = cv2.distanceTransform(free.astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return np.asarray(cells, dtype=np.float64) * map_.resolution


def nearest_free(costs: Costs, x: float, y: float, within: float = inf) -> tuple[float, float]:
    """Return the nearest point to (x, y) at which the robot can stand; all in m.

    Raises:
        PlanError: there is none within `within` m.
    """
    rows, columns = np.nonzero(np.isfinite(costs.cost))
    if len(rows):
        map_ = costs.map
        xs = map_.origin[0] + (columns + 0.5) * map_.resolution
        ys = map_.origin[1] + (rows + 0.5) * map_.resolution
        off = np.hypot(xs - x, ys - y)
        best = int(np.argmin(off))
        if off[best] <= within:
            return float(xs[best]), float(ys[best])
    raise PlanError(f"There is no room for the robot near ({x:.2f}, {y:.2f}).")


def plan(
    map_: OccupancyMap,
    start: tuple[float, float],
    goal: tuple[float, float],
    blocked: Floats | None = None,
    radius: float = RADIUS,
    keep: float = KEEP,
    walking: Floats | None = None,
) -> Path | None:
    """Find the cheapest path from one point to another; return None if there is none.

    A robot that is too near to an obstacle moves away from it first. A goal that is free on the map
    but covered by `blocked` (n, 2) is no error: there is no path just now. The path keeps `keep` m
    from `blocked`, except beside its ends, and avoids `walking` (m, 2) if possible.

    Raises:
        PlanError: the goal lies outside the map, or too near to an obstacle on it.
    """
    costs = inflate(map_, None, radius)
    _check(costs, goal, radius)
    if any(points is not None and len(points) for points in (blocked, walking)):
        costs = inflate(map_, blocked, radius, keep, (start, goal), walking)
    if not np.isfinite(costs.at(*goal)):
        return None
    try:
        begin = nearest_free(costs, *start, within=OUT)
    except PlanError:
        return None
    found = cheapest(costs, map_.cell(*begin), map_.cell(*goal))
    if found is None:
        return None
    cells, cost = found
    middles = (cells[:, ::-1] + 0.5) * map_.resolution + map_.origin
    points = np.asarray(middles, dtype=np.float64)
    points[-1] = goal
    if np.isfinite(costs.at(*start)):
        points[0] = start
    else:
        points = np.vstack((start, points))
    points = resample(straighten(costs, points))
    return Path(points, float(lengths(np.diff(points, axis=0)).sum()), cost)


def check_goal(map_: OccupancyMap, goal: tuple[float, float], radius: float = RADIUS) -> None:
    """Check that the map has room for the robot (its radius in m) at a goal.

    Raises:
        PlanError: there is not enough room.
    """
    _check(inflate(map_, None, radius), goal, radius)


def _check(costs: Costs, goal: tuple[float, float], radius: float) -> None:
    map_ = costs.map
    row, column = map_.cell(*goal)
    told = f"({goal[0]:.2f}, {goal[1]:.2f})"
    if not map_.inside(row, column):
        raise PlanError(f"The goal {told} lies outside the map.")
    if np.isfinite(costs.cost[row, column]):
        return
    near = nearest_free(costs, *goal)
    how = "inside an obstacle" if map_.obstacles[row, column] else f"within {radius:.2f} m of one"
    free = f"({near[0]:.2f}, {near[1]:.2f})"
    raise PlanError(f"The goal {told} lies {how}; the nearest free point is {free}.")


def cheapest(
    costs: Costs, start: tuple[int, int], goal: tuple[int, int]
) -> tuple[NDArray[np.intp], float] | None:
    """Return the cells (n, 2: row, column) of the cheapest path over the grid, and its cost."""
    passable = np.isfinite(costs.cost)
    if not passable[start] or not passable[goal]:
        return None
    rows, columns = np.flatnonzero(passable.any(axis=1)), np.flatnonzero(passable.any(axis=0))
    corner = np.array([rows[0], columns[0]])  # everything outside this part is impassable
    part = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    search = MCP_Geometric(np.where(passable[part], costs.cost[part], -1.0))
    begin, end = (tuple(np.array(cell) - corner) for cell in (start, goal))
    total, _ = search.find_costs([begin], [end])
    cost = float(total[end])
    if not np.isfinite(cost):
        return None
    return np.asarray(search.traceback(end), dtype=np.intp) + corner, cost * costs.map.resolution


def line_cost(costs: Costs, start: Floats, end: Floats) -> float:
    """Return the cost in m of the line between two points (2,); inf if it touches an obstacle."""
    length = hypot(*(end - start))
    count = max(2, ceil(length / (costs.map.resolution / 2)) + 1)
    points = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
    rows, columns = costs.map.cells_of(points)
    return float(costs.cost[rows, columns].mean()) * length if len(rows) == count else inf


def straighten(costs: Costs, points: Floats) -> Floats:
    """Drop points of a path (n, 2) that a straight line can replace."""
    steps = np.array([line_cost(costs, a, b) for a, b in pairwise(points)])
    spent = np.concatenate(([0.0], np.cumsum(np.where(np.isfinite(steps), steps, 1e6))))
    kept, here, last = [0], 0, len(points) - 1
    while here < last:
        far, reach = last - here, here + 1
        while far > 1:
            there = here + far
            if (
                line_cost(costs, points[here], points[there])
                <= (spent[there] - spent[here]) * AS_CHEAP
            ):
                reach = there
                break
            far = far * 2 // 3
        kept.append(reach)
        here = reach
    return points[kept]


def resample(points: Floats, step: float = STEP) -> Floats:
    """Return points (n, 2) every `step` m along a path, with both its ends."""
    along = np.concatenate(([0.0], np.cumsum(lengths(np.diff(points, axis=0)))))
    if along[-1] < 1e-9:
        return points[[0, -1]]
    at = np.linspace(0.0, along[-1], max(2, ceil(along[-1] / step) + 1))
    return np.column_stack((np.interp(at, along, points[:, 0]), np.interp(at, along, points[:, 1])))
