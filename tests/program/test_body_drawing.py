"""A robot's body drawn from above: its proportions, and the places of its devices."""

from __future__ import annotations

import pytest

from tangy_profiles.body import BodyProfile, Mount
from tangy_tui.text.body import CAMERA, EDGE, LASER, WHEELS, assumed_words, draw_body

CORNERS = ((0.4, 0.3), (-0.4, 0.3), (-0.4, -0.3), (0.4, -0.3))


def drawn(body: BodyProfile) -> list[str]:
    """Return the rows of the picture alone."""
    lines = draw_body(body)
    return lines[: max(n for n, line in enumerate(lines) if line.strip().startswith(EDGE)) + 1]


def place(rows: list[str], sign: str) -> tuple[int, int]:
    """Return row and column of a character that is drawn once."""
    (found,) = ((n, row.index(sign)) for n, row in enumerate(rows) if sign in row)
    return found


def test_a_device_is_drawn_at_its_mount() -> None:
    eye = {"eye": Mount(0.1, -0.1, 1.3)}
    body = BodyProfile(radius=0.5, corners=CORNERS, laser=Mount(0.25, 0.0), cameras=eye)
    rows = drawn(body)
    (row, column), (ahead, middle), (beside, right) = (
        place(rows, sign) for sign in (WHEELS, LASER, CAMERA)
    )
    assert ahead < beside < row  # ahead is up
    assert middle == column < right


@pytest.mark.parametrize("radius", [0.05, 0.18, 0.25, 0.6, 2.0])
def test_a_round_robot_is_drawn_round_and_fits_on_a_terminal(radius: float) -> None:
    rows = drawn(BodyProfile(radius=radius, laser=Mount(-radius / 2, 0.0)))
    widest = max(len(row.strip()) for row in rows)
    assert len(rows) <= 20 and max(map(len, rows)) < 50
    assert widest == pytest.approx(2 * len(rows), abs=3)


def test_a_robot_wider_than_long_is_drawn_wide() -> None:
    wide = BodyProfile(radius=0.5, corners=((0.2, 0.4), (-0.2, 0.4), (-0.2, -0.4), (0.2, -0.4)))
    rows = drawn(wide)
    assert max(len(row.strip()) for row in rows) > 3 * len(rows)


@pytest.mark.parametrize(("x", "outside"), [(0.25, False), (0.45, True), (-0.45, True)])
def test_a_scanner_outside_the_body_is_told(x: float, outside: bool) -> None:
    body = BodyProfile(radius=0.5, corners=CORNERS, laser=Mount(x, 0.0))
    told = "The laser scanner is outside the body: check where it is, in m."
    assert (told in draw_body(body)) is outside


def test_what_has_to_be_measured_and_is_left_out_is_told() -> None:
    (told,) = assumed_words(BodyProfile(assumed=("radius", "laser")))
    assert told.startswith("The robot's file does not give: radius, laser.")
    assert assumed_words(BodyProfile()) == []
