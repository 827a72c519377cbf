"""Occupancy grids: free, occupied and unknown cells of the floor."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_erosion, distance_transform_edt

from tangy_hw.navigation.poses import Floats
from tangy_profiles.room import Point, Room

Cells: TypeAlias = NDArray[np.int8]
Mask: TypeAlias = NDArray[np.bool_]
Value = TypeVar("Value", bound=np.generic)

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Cell values, as in nav_msgs/OccupancyGrid."""

MARGIN = 0.5  # metres of unknown cells around a room, so that beams through doors end on the map
LEG_INSET = 0.1  # metres from the edge of the table to the centre of a leg
CHAIR, FEET = 0.42, 0.3  # metres: between chair legs; from a chair's centre to a person's feet
SEAT = 0.3  # metres of keep-out area around a seat
FIDGET = 0.2  # metres that the feet of a seated person may be off the drawn ones


@dataclass(frozen=True, eq=False)
class OccupancyMap:
    """An occupancy grid of the floor.

    `cells` (rows, columns) holds what a laser sees: FREE, OCCUPIED or UNKNOWN; row 0 has the lowest
    y, column 0 the lowest x. `origin` is the outer corner of the first cell, in m. `keep_out`
    (rows, columns) marks areas that look free to a laser and that the robot must avoid: at laser
    height a table is four legs, at robot height a table top. `feet` (rows, columns) marks where
    seated people move their feet.
    """

    cells: Cells
    resolution: float
    origin: tuple[float, float]
    keep_out: Mask = field(default_factory=lambda: np.zeros((0, 0), dtype=np.bool_))
    feet: Mask = field(default_factory=lambda: np.zeros((0, 0), dtype=np.bool_))

    def __post_init__(self) -> None:
        for name in ("keep_out", "feet"):
            if getattr(self, name).size == 0:
                object.__setattr__(self, name, np.zeros(self.cells.shape, dtype=np.bool_))

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.cells.shape[0], self.cells.shape[1]

    @property
    def size(self) -> tuple[float, float]:
        """Width and depth in m."""
        return self.shape[1] * self.resolution, self.shape[0] * self.resolution

    @cached_property
    def obstacles(self) -> Mask:
        """Cells that the robot must not touch: walls, keep-out areas, and unknown cells."""
        return np.asarray((self.cells != FREE) | self.keep_out)

    @cached_property
    def keep_out_edge(self) -> Floats:
        """Centres of the outermost keep-out cells (n, 2), in m."""
        inner = binary_erosion(self.keep_out)
        rows, columns = np.nonzero(self.keep_out & ~inner)
        return np.column_stack((columns + 0.5, rows + 0.5)) * self.resolution + self.origin

    @cached_property
    def seen_distance(self) -> NDArray[np.float32]:
        """Distance (rows, columns), in m, to the nearest cell that a laser sees as occupied."""
        occupied = self.cells == OCCUPIED
        if not occupied.any():
            return np.full(self.shape, np.float32(max(self.size)))
        distance = distance_transform_edt(~occupied, sampling=self.resolution)
        return np.asarray(distance, dtype=np.float32)

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """Return the row and column of a point in m, which may lie outside the map."""
        column = int(np.floor((x - self.origin[0]) / self.resolution))
        return int(np.floor((y - self.origin[1]) / self.resolution)), column

    def point(self, row: int, column: int) -> tuple[float, float]:
        """Return the centre of a cell in m."""
        return (
            self.origin[0] + (column + 0.5) * self.resolution,
            self.origin[1] + (row + 0.5) * self.resolution,
        )

    def inside(self, row: int, column: int) -> bool:
        """Return whether a cell is on the map."""
        return 0 <= row < self.shape[0] and 0 <= column < self.shape[1]

    def cells_of(self, points: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return the rows and columns of the points (n, 2) that lie on the map."""
        rows, columns, on = self._cells(points)
        return rows[on], columns[on]

    def values_at(self, points: Floats, grid: NDArray[Value], outside: float) -> NDArray[Value]:
        """Return the values of a grid (rows, columns) at points (..., 2); `outside` off the map."""
        rows, columns, on = self._cells(points)
        found = np.full(on.shape, outside, dtype=grid.dtype)
        found[on] = grid[rows[on], columns[on]]
        return found

    def _cells(self, points: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp], Mask]:
        """Return the rows and columns of points (..., 2), and whether they lie on the map."""
        cells = np.floor((points - self.origin) / self.resolution).astype(np.intp)
        rows, columns = cells[..., 1], cells[..., 0]
        on = (rows >= 0) & (columns >= 0) & (rows < self.shape[0]) & (columns < self.shape[1])
        return rows, columns, on

    def free_points(self) -> Floats:
        """Return the centres of all free cells (n, 2)."""
        rows, columns = np.nonzero((self.cells == FREE) & ~self.keep_out)
        return np.column_stack((columns + 0.5, rows + 0.5)) * self.resolution + self.origin


def table_legs(room: Room) -> list[Point]:
    """Return the positions of the legs of a room's table, near its corners."""
    left, near, right, far = room.table
    return [
        Point(x, y)
        for x in (left + LEG_INSET, right - LEG_INSET)
        for y in (near + LEG_INSET, far - LEG_INSET)
    ]


def chair_legs(seat: Point) -> list[Point]:
    """Return the positions of the legs of the chair at a seat."""
    half = CHAIR / 2
    return [Point(seat.x + x, seat.y + y) for x in (-half, half) for y in (-half, half)]


def seat_feet(room: Room, seat: Point) -> list[Point]:
    """Return the positions of the feet of a person at a seat who faces the table."""
    towards = FEET if room.table[1] > seat.y else -FEET
    return [Point(seat.x + x, seat.y + towards) for x in (-0.13, 0.13)]


def map_of_room(room: Room, resolution: float = 0.05, people: int | None = None) -> OccupancyMap:
    """Draw the map of a room from its profile.

    A laser sees the walls, the legs of the table and chairs, and people's feet, which are near
    their drawn positions; without them, a bare room looks the same from both ends. The table top
    and .3 m around each seat are keep-out areas.

    Args:
        room: the room.
        resolution: metres per cell.
        people: number of seats; None: the room's own.
    """
    side = max(1, round(MARGIN / resolution))
    columns, rows = round(room.width / resolution) + 1, round(room.depth / resolution) + 1
    cells = np.full((rows + 2 * side, columns + 2 * side), UNKNOWN, dtype=np.int8)
    cells[side : side + rows, side : side + columns] = OCCUPIED
    cells[side + 1 : side + rows - 1, side + 1 : side + columns - 1] = FREE
    corner = -(side + 0.5) * resolution  # so that a wall runs through the centres of its cells
    drawn = OccupancyMap(cells, resolution, (corner, corner))
    seats = room.seats if people is None else room.seated(people)
    feet = [foot for seat in seats for foot in seat_feet(room, seat)]
    legs = [*table_legs(room), *(leg for seat in seats for leg in chair_legs(seat)), *feet]
    rows_of, columns_of = drawn.cells_of(np.array([(leg.x, leg.y) for leg in legs]))
    cells[rows_of, columns_of] = OCCUPIED
    xs = corner + (np.arange(cells.shape[1]) + 0.5) * resolution
    ys = corner + (np.arange(cells.shape[0]) + 0.5) * resolution
    left, near, right, far = room.table
    drawn.keep_out[np.ix_((ys >= near) & (ys <= far), (xs >= left) & (xs <= right))] = True
    for seat in seats:
        drawn.keep_out[np.hypot(xs[None, :] - seat.x, ys[:, None] - seat.y) <= SEAT] = True
    return with_feet(drawn, room, people)


def with_feet(map_: OccupancyMap, room: Room, people: int | None = None) -> OccupancyMap:
    """Return a map with the areas marked where seated people move their feet.

    Args:
        map_: the map in the room's frame, drawn or recorded.
        room: the room.
        people: number of seated people; None: all seats of the room.
    """
    xs = map_.origin[0] + (np.arange(map_.shape[1]) + 0.5) * map_.resolution
    ys = map_.origin[1] + (np.arange(map_.shape[0]) + 0.5) * map_.resolution
    marked = np.zeros(map_.shape, dtype=np.bool_)
    for seat in room.seats if people is None else room.seated(people):
        for foot in seat_feet(room, seat):
            marked |= np.hypot(xs[None, :] - foot.x, ys[:, None] - foot.y) <= FIDGET
    return replace(map_, feet=marked)
