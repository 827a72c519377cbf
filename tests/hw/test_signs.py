"""Signs in infrared pictures: found, at the right seat, accepted when they stay."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from tangy_hw.perception.requests.help_request_source import RequestError
from tangy_hw.perception.requests.signs import Hysteresis, SignWatcher, TableView
from tangy_hw.perception.requests.triangles import find_triangles
from tangy_profiles.room import load_room
from tests.hw.signs import CORNERS, OTHERS, SEATS, Things, in_picture, sequence

VIEW = TableView(CORNERS, load_room(), len(SEATS))


class TestTriangles:
    @pytest.mark.parametrize("size", [14, 20, 35, 50])
    def test_a_triangle_is_found_at_its_place(self, size: int) -> None:
        rng = np.random.default_rng(size)
        image = np.full((240, 320), 20, np.uint8)
        corners = Things(rng).sign((150.0, 110.0), size)
        cv2.fillPoly(image, [np.round(corners * 16).astype(np.int32)], 220, cv2.LINE_AA, 4)
        blurred = cv2.GaussianBlur(image, (0, 0), 1.2)
        (found,) = find_triangles(np.asarray(blurred, np.uint8))
        assert np.hypot(found.x - 150, found.y - 110) < 1.5
        assert 0.6 * size < found.size < 1.3 * size
        assert found.sure > 0.5

    @pytest.mark.parametrize("kind", OTHERS)
    def test_other_shapes_are_not_taken_for_triangles(self, kind: str) -> None:
        rng = np.random.default_rng(5)
        for size in (12, 18, 30, 60):
            image = np.full((240, 320), 20, np.uint8)
            Things(rng).other(image, kind, (150.0, 110.0), size, 220)
            blurred = cv2.GaussianBlur(image, (0, 0), 1.2)
            assert find_triangles(np.asarray(blurred, np.uint8)) == []

    @pytest.mark.parametrize("value", [0, 128, 255])
    def test_an_even_picture_has_no_triangle(self, value: int) -> None:
        for shape in ((1, 1), (480, 640), (480, 640, 3)):
            assert find_triangles(np.full(shape, value, np.uint8)) == []

    def test_noise_has_no_triangle(self) -> None:
        noise = np.random.default_rng(1).integers(0, 256, (240, 320), np.uint8)
        assert find_triangles(noise) == []


class TestTable:
    @pytest.mark.parametrize("seat", range(len(SEATS)))
    def test_a_sign_belongs_to_the_nearest_seat(self, seat: int) -> None:
        for aside, across in ((0.0, 5.7), (0.5, 5.5), (-0.5, 5.6)):
            x, y = in_picture((SEATS[seat] + aside, across))
            assert VIEW.seat(x, y) == seat + 1

    def test_a_sign_off_the_table_belongs_to_no_seat(self) -> None:
        for x, y in ((320.0, 100.0), (20.0, 240.0), (320.0, -4000.0), (630.0, 300.0)):
            assert VIEW.seat(x, y) == 0

    def test_positions_on_the_table_are_in_metres(self) -> None:
        place = VIEW.place(*in_picture((3.0, 5.4)))
        assert place is not None
        assert (place.x, place.y) == pytest.approx((3.0, 5.4))

    @pytest.mark.parametrize(
        "corners",
        [
            ((0, 0), (0, 0), (0, 0), (0, 0)),
            ((0, 0), (10, 0), (20, 0), (30, 0)),
            ((0, 0), (10, 10), (10, 0), (0, 10)),
        ],
    )
    def test_impossible_table_corners_are_refused(self, corners: tuple[object, ...]) -> None:
        with pytest.raises(RequestError, match="go round"):
            TableView(corners, load_room(), 4)  # type: ignore[arg-type]


class TestPersistence:
    @staticmethod
    def believed(shown: str) -> str:
        persistence = Hysteresis()
        return "".join(
            "x" if 1 in persistence.take({1: 0.9} if one == "x" else {}) else "." for one in shown
        )

    @pytest.mark.parametrize(
        ("shown", "believed"),
        [
            ("xxxxx", "..xxx"),
            ("x.x.x", "....x"),
            ("xx...xx..", "........."),
            ("xxx......", "..xxxx..."),
            ("xxxxxx.xx.xx", "..xxxxxxxxxx"),
        ],
    )
    def test_a_sign_needs_three_of_five_pictures(self, shown: str, believed: str) -> None:
        assert self.believed(shown)[: len(shown)] == believed

    def test_confidence_grows_with_each_sighting(self) -> None:
        persistence = Hysteresis()
        grown = [persistence.take({2: 1.0}).get(2, 0.0) for _ in range(6)]
        assert grown == sorted(grown) and grown[-1] == 1.0


@pytest.mark.slow
def test_requests_are_detected_with_few_false_alarms() -> None:
    """A small part of `tests/bench/requests.py`, with other seeds."""
    asked = seen = false = pictures = 0
    for seed in range(700_000, 700_016):
        watcher = SignWatcher(VIEW)
        for scene in sequence(seed, 6):
            asks = set(watcher.look(scene.image))
            true = {seat + 1 for seat in scene.asking}
            pictures += 1
            false += bool(asks - true)
            if scene.since >= 4:
                asked += len(true)
                seen += len(asks & true)
    assert asked > 40
    assert seen / asked >= 0.97
    assert false / pictures <= 0.01
