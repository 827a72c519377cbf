"""A drawing of a robot's body from above."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

from tangy_profiles.body import BodyProfile, Mount

FINEST, ROWS = 0.05, 16  # smallest height of a row in m, and most rows of a body
EDGE, INSIDE, WHEELS = "#", "·", "+"
LASER, CAMERA = "L", "C"
LASER_NAME = "laser scanner"
NEAR = 1e-9  # tolerance of the edge in m^2


def draw_body(body: BodyProfile) -> list[str]:
    """Return the drawing of a body from above, front at the top, and its dimensions in words."""
    high = max(FINEST, 2 * body.radius / ROWS)  # height of a row in m
    wide = high / 2  # width of a column in m: characters are twice as high as wide
    half = ceil(body.radius / high)  # rows from the centre to the edge, rounded up
    rows, columns = 2 * half + 1, 4 * half + 1
    picture = [
        [
            _sign(body, (half - row) * high, (2 * half - column) * wide, high)
            for column in range(columns)
        ]
        for row in range(rows)
    ]

    def put(sign: str, x: float, y: float) -> None:
        row, column = half - round(x / high), 2 * half - round(y / wide)
        if 0 <= row < rows and 0 <= column < columns:
            picture[row][column] = sign

    put(WHEELS, 0.0, 0.0)
    for mount in body.cameras.values():
        put(CAMERA, mount.x, mount.y)
    put(LASER, body.laser.x, body.laser.y)
    lines = ["".join(row).rstrip() for row in picture]
    return [line for line in lines if line] + _words(body)


def _sign(body: BodyProfile, x: float, y: float, high: float) -> str:
    """Return the character for a point on the floor (m); a row is `high` m high."""
    if not _within(body, x, y):
        return " "
    beside = ((x + high, y), (x - high, y), (x, y + high / 2), (x, y - high / 2))
    return INSIDE if all(_within(body, *point) for point in beside) else EDGE


def _within(body: BodyProfile, x: float, y: float) -> bool:
    if not body.corners:
        return x * x + y * y <= body.radius**2 + NEAR
    ends: Sequence[tuple[float, float]] = (*body.corners[1:], body.corners[0])
    turns = [
        (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        for (ax, ay), (bx, by) in zip(body.corners, ends, strict=True)
    ]
    return min(turns) >= -NEAR


def _words(body: BodyProfile) -> list[str]:
    """Tell the size of the body, and the positions of its devices."""
    if body.corners:
        xs, ys = zip(*body.corners, strict=True)
        size = f"{max(xs) - min(xs):.2f} m long and {max(ys) - min(ys):.2f} m wide"
    else:
        size = f"round, {2 * body.radius:.2f} m across"
    lines = [
        f"The robot from above, front at the top: {size}.",
        f"{WHEELS} the middle between its wheels; {LASER} the laser scanner, {_place(body.laser)}.",
    ]
    lines += [f"{CAMERA} {name}, {_place(mount)}." for name, mount in body.cameras.items()]
    outside = [LASER_NAME] * (not _within(body, body.laser.x, body.laser.y)) + [
        name for name, mount in body.cameras.items() if not _within(body, mount.x, mount.y)
    ]
    lines += [f"The {name} is outside the body: check where it is, in m." for name in outside]
    if body.arms:
        lines.append(f"Its arms reach {body.arms:.2f} m out from the middle.")
    lines.append(f"It brakes at {body.braking:.1f} m/s²: measure that with nobody near.")
    return lines


def assumed_words(body: BodyProfile) -> list[str]:
    """Tell what the robot's file leaves out, though it has to be measured; [] if nothing."""
    if not body.assumed:
        return []
    return [
        f"The robot's file does not give: {', '.join(body.assumed)}. It drives with Tangy's values "
        "until you measure them and write them under [body]."
    ]


def _place(mount: Mount) -> str:
    """Tell the position of a device, and its heading unless that is straight ahead."""
    aside = f"{abs(mount.y):.2f} m to the {'left' if mount.y > 0 else 'right'}, " * bool(mount.y)
    along = f"{abs(mount.x):.2f} m {'ahead' if mount.x > 0 else 'behind'}, " * bool(mount.x)
    turned = ""
    if mount.yaw:
        turned = f", turned {abs(mount.yaw):.0f}° to the {'left' if mount.yaw > 0 else 'right'}"
    high = f"{mount.height:.2f} m high" if mount.height else "height unknown"
    return f"{along}{aside}{high}{turned}"
