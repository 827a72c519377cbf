"""Letters that people hold up, in the picture of the infrared camera over the bench's table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_hw.perception.requests.answer_signs import find_answer_signs
from tangy_hw.perception.requests.signs import SignWatcher, TableView
from tangy_profiles.room import Room, load_room
from tangy_sim.device_simulator.signs import InfraredCamera, corners_in

ROOM = load_room()
ROOMS = [load_room(path.stem) for path in sorted(ROOM.file.parent.glob("*.toml"))]
LETTERS = "abcd"


def watched(
    count: int, seed: int = 1, room: Room = ROOM
) -> tuple[list[str], InfraredCamera, SignWatcher]:
    people = [f"user{number}" for number in range(1, count + 1)]
    view = TableView(corners_in(room), room, count)
    return people, InfraredCamera(room, people, seed=seed), SignWatcher(view)


def picture(frame: bytes) -> Any:
    return cv2.imdecode(np.frombuffer(frame, np.uint8), cv2.IMREAD_COLOR)


def looked(
    camera: InfraredCamera,
    watcher: SignWatcher,
    asking: Sequence[str],
    shown: Mapping[str, str],
    times: int = 5,
) -> tuple[dict[int, float], dict[int, tuple[str, float]]]:
    for _ in range(times):
        image = picture(camera.frame(asking, shown))
        asks, letters = watcher.look(image), watcher.answers(image)
    return asks, dict(letters)


@pytest.mark.parametrize("room", ROOMS, ids=lambda room: room.source)
@pytest.mark.parametrize("fewer", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_a_held_up_letter_is_read_at_its_seat_while_neighbours_ask_for_help(
    room: Room, fewer: bool, seed: int
) -> None:
    count = min(4, room.places) if fewer else room.places
    people, camera, watcher = watched(count, seed, room)
    for turn in range(4):
        shown = {
            one: LETTERS[(place + turn) % 4]
            for place, one in enumerate(people)
            if (place + turn) % 3
        }
        asking = [one for one in people if one not in shown]
        asks, letters = looked(camera, watcher, asking, shown)
        seats = dict(enumerate(people, 1))
        assert {seats[seat]: letter for seat, (letter, _) in letters.items()} == shown
        assert {seats[seat] for seat in asks} == set(asking)
        assert all(sure >= 0.7 for _, sure in letters.values())


def test_a_letter_counts_from_three_pictures_on_and_is_gone_when_it_is_down() -> None:
    _, camera, watcher = watched(4)
    shown = [{"user2": "c"}] * 4 + [{}] * 5
    found = [looked(camera, watcher, (), letters, 1)[1] for letters in shown]
    assert "".join("-c"[2 in one] for one in found) == "--ccccc--"


def test_confidence_drops_while_a_sign_changes_its_letter() -> None:
    _, camera, watcher = watched(4)
    looked(camera, watcher, (), {"user2": "c"})
    _, letters = looked(camera, watcher, (), {"user2": "d"}, 2)
    assert letters[2][0] == "c" and letters[2][1] < 0.7
    _, letters = looked(camera, watcher, (), {"user2": "d"}, 3)
    assert letters[2][0] == "d" and letters[2][1] >= 0.7


def test_strips_circles_and_radiators_are_not_read_as_signs() -> None:
    image = np.full((240, 320), 30, np.uint8)
    cv2.rectangle(image, (60, 120), (90, 126), 220, -1)  # one strip: an edge of an object
    cv2.circle(image, (160, 120), 9, 220, -1)
    for number in range(7):  # a radiator
        cv2.rectangle(image, (220, 90 + 11 * number), (240, 94 + 11 * number), 220, -1)
    assert find_answer_signs(image) == []
