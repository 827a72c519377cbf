"""How fast a path is planned, against A* in plain Python on the same costs in the same run.

Run by hand: `python -m tests.bench.navigation`. Both work on the common room (10 x 8 m at 5 cm),
between the same random places: Tangy inflates the map and plans; A* gets the
inflated costs and only plans. Times are of the processor. On short paths the two are alike, as A*
looks at little of the map; on those round the table it takes ten times as long.
"""

from __future__ import annotations

import argparse
import heapq
import time
from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np

from tangy_hw.navigation.occupancy import OccupancyMap, map_of_room
from tangy_hw.navigation.planning import Costs, cheapest, inflate
from tangy_profiles.room import load_room

NEIGHBOURS = [
    (row, column, hypot(row, column))
    for row in (-1, 0, 1)
    for column in (-1, 0, 1)
    if row or column
]
DIAGONAL = sqrt(2)


def a_star(costs: list[list[float]], start: tuple[int, int], goal: tuple[int, int]) -> float:
    """Return the cost of the cheapest path over a grid, in cells; inf if there is none.

    A step costs its length times the mean of the costs at its ends. The octile distance never
    overestimates, because each cell costs at least 1.
    """
    rows, columns = len(costs), len(costs[0])
    best = {start: 0.0}
    closed = set()
    queue = [(0.0, start)]
    while queue:
        _, here = heapq.heappop(queue)
        if here == goal:
            return best[here]
        if here in closed:
            continue
        closed.add(here)
        row, column = here
        cost, spent = costs[row][column], best[here]
        for down, right, length in NEIGHBOURS:
            r, c = row + down, column + right
            if not (0 <= r < rows and 0 <= c < columns) or costs[r][c] == inf:
                continue
            total = spent + length * (cost + costs[r][c]) / 2
            if total < best.get((r, c), inf):
                best[(r, c)] = total
                dy, dx = abs(r - goal[0]), abs(c - goal[1])
                rest = max(dx, dy) + (DIAGONAL - 1) * min(dx, dy)
                heapq.heappush(queue, (total + rest, (r, c)))
    return inf


@dataclass(frozen=True)
class Race:
    """Seconds and costs (in metres) of both, for the same number of pairs of places."""

    ours: list[float]
    theirs: list[float]
    our_costs: list[float]
    their_costs: list[float]

    @property
    def ratio(self) -> float:
        """Tangy's time for all paths as a share of A*'s."""
        return sum(self.ours) / sum(self.theirs)


def places(costs: Costs, seed: int, count: int) -> list[tuple[int, int]]:
    """Draw cells where the robot can stand."""
    rng = np.random.default_rng(seed)
    rows, columns = np.nonzero(np.isfinite(costs.cost))
    chosen = rng.choice(len(rows), count, replace=False)
    return [(int(rows[i]), int(columns[i])) for i in chosen]


def race(map_: OccupancyMap, seed: int, count: int) -> Race:
    """Let both plan between the same places, one after the other."""
    usual = inflate(map_)
    ends = places(usual, seed, 2 * count)
    found = Race([], [], [], [])
    for start, goal in zip(ends[:count], ends[count:], strict=True):
        begun = time.process_time()
        way = cheapest(inflate(map_), start, goal)
        found.ours.append(time.process_time() - begun)
        found.our_costs.append(inf if way is None else way[1])
        grid = usual.cost.tolist()
        begun = time.process_time()
        cost = a_star(grid, start, goal)
        found.theirs.append(time.process_time() - begun)
        found.their_costs.append(cost * map_.resolution)
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ways", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    found = race(map_of_room(load_room()), options.seed, options.ways)
    for name, seconds in (("inflate and plan", found.ours), ("A* in Python", found.theirs)):
        median, high = np.percentile(seconds, [50, 95])
        print(f"{name:<18} median {median * 1e3:6.1f} ms   p95 {high * 1e3:6.1f} ms")
    worst = np.max(np.abs(np.array(found.our_costs) / np.array(found.their_costs) - 1))
    print(f"ratio over all ways {found.ratio:.2f}; costs differ by {worst:.2%} at most")


if __name__ == "__main__":
    main()
