"""Draws a map as lines of text, with two cells above each other in a character."""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from tangy_hw.navigation.occupancy import FREE, OCCUPIED, OccupancyMap

ROBOT, ROBOT_ASCII = "●", "o"
NOTHING, UNSEEN, KEPT_OUT, WALL = range(4)


def map_lines(
    map_: OccupancyMap,
    columns: int = 100,
    rows: int = 0,
    *,
    robot: tuple[float, float] | None = None,
    ascii_only: bool = False,
) -> list[str]:
    """Return lines of limited length, with the highest y at the top.

    Walls are full blocks, free floor is blank, keep-out areas and unknown cells are shaded; in
    ASCII they are `#`, blank, `+` and `.`.

    Args:
        map_: the map.
        columns: maximum length of a line.
        rows: maximum number of lines; 0: no limit.
        robot: position of the robot to mark (x, y in m).
        ascii_only: draw with ASCII characters.
    """
    by = ceil(map_.shape[1] / columns)
    if rows:
        by = max(by, ceil(map_.shape[0] / (2 * rows)))
    kinds = _shrunk(_kinds(map_), by)[::-1]
    at = None if robot is None else _cell(map_, robot, by, len(kinds))
    if len(kinds) % 2:
        kinds = np.vstack((kinds, np.full((1, kinds.shape[1]), UNSEEN)))
    upper, lower = kinds[::2], kinds[1::2]
    signs = " .+#" if ascii_only else " ░▒█"
    lines: list[str] = []
    for above, below in zip(upper, lower, strict=True):
        line = ""
        for top, bottom in zip(above, below, strict=True):
            if ascii_only or top == bottom or WALL not in (top, bottom):
                line += signs[max(top, bottom)]
            else:
                line += "▀" if top == WALL else "▄"
        if at is not None and len(lines) == at[0] and 0 <= at[1] < len(line):
            line = line[: at[1]] + (ROBOT_ASCII if ascii_only else ROBOT) + line[at[1] + 1 :]
        lines.append(line.rstrip())
    return lines


def _cell(map_: OccupancyMap, robot: tuple[float, float], by: int, count: int) -> tuple[int, int]:
    """Return the line and column of a point in a drawing of `count` rows of cells."""
    column, row = (
        int((at - corner) / map_.resolution / by)
        for at, corner in zip(robot, map_.origin, strict=True)
    )
    return (count - 1 - row) // 2, column


def _kinds(map_: OccupancyMap) -> NDArray[np.int64]:
    kinds = np.full(map_.shape, UNSEEN)
    kinds[map_.cells == FREE] = NOTHING
    kinds[map_.keep_out] = KEPT_OUT
    kinds[map_.cells == OCCUPIED] = WALL
    return kinds


def _shrunk(kinds: NDArray[np.int64], by: int) -> NDArray[np.int64]:
    """Join squares of cells: a wall in a square makes it a wall, and free beats unknown."""
    rows, columns = (ceil(n / by) for n in kinds.shape)
    whole = np.full((rows * by, columns * by), UNSEEN)
    whole[: kinds.shape[0], : kinds.shape[1]] = kinds
    squares = whole.reshape(rows, by, columns, by).transpose(0, 2, 1, 3).reshape(rows, columns, -1)
    joined = np.full((rows, columns), UNSEEN)
    for kind in (NOTHING, KEPT_OUT, WALL):
        joined[(squares == kind).any(axis=2)] = kind
    return joined
