"""The pictures of the bench's cameras, read by the perception of the hardware floor."""

from __future__ import annotations

from itertools import combinations, pairwise
from time import process_time
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera_look import measure
from tangy_hw.perception.cards.reader import CardReader
from tangy_hw.perception.faces.gallery import Gallery
from tangy_hw.perception.faces.reader import HaarReader
from tangy_hw.perception.requests.signs import SignWatcher, TableView
from tangy_profiles.room import load_room
from tangy_sim.device_simulator.camera_views import HeadCamera
from tangy_sim.device_simulator.people import HIDES
from tangy_sim.device_simulator.signs import CORNERS, InfraredCamera, corners_in
from tangy_sim.device_simulator.world import HeadScene
from tangy_sim.rendering.faces import drawn_face
from tests.sim.bench_game import ACTIVITY, ROOM, bench, drive_to

PEOPLE = ("user1", "user2", "user3", "user4")
FACES = {person: number for number, person in enumerate(PEOPLE, 1)}


def camera(seed: int = 1) -> HeadCamera:
    return HeadCamera(ACTIVITY, PEOPLE, FACES, seed=seed)


def picture(jpeg: bytes) -> Any:
    """Unpack a frame."""
    return cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)


class TestCards:
    @pytest.mark.slow
    def test_the_card_reader_reads_the_drawn_cards(self) -> None:
        reader, random, read = CardReader(ACTIVITY.deck), np.random.default_rng(7), 0
        head = camera(3)
        for visit in range(6):
            marked = int(sum(1 << cell for cell in range(25) if random.random() < 0.3))
            card = int(random.integers(1, 250))
            scene = HeadScene("card", PEOPLE[visit % 4], 1, visit, card, marked)
            reading = reader.read(picture(head.frame(scene)))
            assert reading.card == card
            assert not (reading.marked ^ marked) & ~reading.hidden
            read += not reading.hidden
        assert read >= 5

    @pytest.mark.slow
    @pytest.mark.parametrize("hides", HIDES)
    def test_a_card_out_of_view_is_not_read(self, hides: str) -> None:
        reader, head = CardReader(ACTIVITY.deck), camera(4)
        for visit in range(2):
            scene = HeadScene("card", PEOPLE[visit], 1, visit, 7, 0b11111, hides)
            frame = picture(head.frame(scene))
            sharp = measure(frame, 1, 0.0).sharpness
            assert sharp is not None and sharp > 0.2  # the camera itself is not at fault
            reading = reader.read(frame)
            called = set(reader.deck.numbers)
            assert reader.state(reading, ACTIVITY.user_states, called) == ACTIVITY.unread

    @pytest.mark.slow
    def test_chips_stay_in_place_when_another_is_added(self) -> None:
        reader, head = CardReader(ACTIVITY.deck), camera(5)
        for marked in (0b1, 0b11):
            frame = picture(head.frame(HeadScene("card", "user1", 1, 1, 9, marked)))
            assert reader.read(frame).marked == marked


class TestFaces:
    @pytest.mark.slow
    def test_every_face_is_recognised_from_other_pictures(self) -> None:
        reader, head = HaarReader(), camera()
        enrolled = {
            person: np.array(
                [reader.read(drawn_face(number, now))[0].vector for now in range(5)], np.float32
            )
            for person, number in FACES.items()
        }
        gallery = Gallery(enrolled)
        for person in PEOPLE:
            (seen,) = reader.read(picture(head.frame(HeadScene("face", person))))
            assert seen.problem == "" and seen.vector is not None
            assert seen.box[2] >= 100
            assert gallery.compare(seen.vector).person == person


class TestFrames:
    def test_frames_differ_by_noise_unless_the_camera_is_frozen(self) -> None:
        head = camera()
        for scene in (HeadScene("room", heading=40), HeadScene("dark")):
            frames = [head.frame(scene) for _ in range(9)]
            assert all(one != other for one, other in pairwise(frames))
        last = head.frame(HeadScene("room"))
        assert {head.frame(HeadScene("frozen")) for _ in range(3)} == {last}

    @pytest.mark.slow
    def test_only_an_uncovered_camera_is_bright_and_sharp(self) -> None:
        head = camera()
        for heading in range(-180, 180, 60):
            look = measure(picture(head.frame(HeadScene("room", heading=heading))), 1, 0.0)
            assert look.brightness > 0.2 and look.contrast > 0.05
            assert look.sharpness is not None and look.sharpness > 0.25
        look = measure(picture(head.frame(HeadScene("dark"))), 1, 0.0)
        assert look.brightness < 0.08 and look.contrast < 0.03

    def test_a_repeated_scene_costs_a_fraction_of_a_new_one(self) -> None:
        head = camera()
        scene = HeadScene("card", "user1", 1, 1, 9, 0b1011)
        began = process_time()
        head.frame(scene)
        first, began = process_time() - began, process_time()
        for _ in range(20):
            head.frame(scene)
        assert (process_time() - began) / 20 < first / 5

    def test_the_scene_depends_on_the_robots_place_and_head_pose(self) -> None:
        world = bench(2)
        world.begin()
        assert world.head_scene().kind == "room"
        world.people.sitters["user2"].player.marked = 0b101
        assert drive_to(world, "user2")
        assert world.head_scene() == HeadScene("face", "user2")
        world.joints.move(["head/neck nod"], [-0.35], 0.5)
        world.step(1.0)
        scene, sitter = world.head_scene(), world.people.sitters["user2"]
        assert scene == HeadScene(
            "card", "user2", 1, sitter.moved, sitter.card, 0b101, sitter.hides
        )
        world.wheels.pose = world.wheels.pose._replace(heading=0.8)
        assert world.head_scene().kind == "room"


class TestSigns:
    @pytest.mark.slow
    @pytest.mark.parametrize("count", [1, 4, 8])
    def test_signs_are_detected_only_at_the_seats_that_ask(self, count: int) -> None:
        people = [f"user{number}" for number in range(1, count + 1)]
        infrared = InfraredCamera(ROOM, people, seed=count)
        groups = [g for size in (0, 1, 2, count) for g in combinations(range(count), size)]
        for group in groups[:: max(1, len(groups) // 12)]:
            watcher = SignWatcher(TableView(CORNERS, ROOM, count))
            for _ in range(6):
                seen = watcher.look(picture(infrared.frame([people[seat] for seat in group])))
            assert set(seen) == {seat + 1 for seat in group}

    @pytest.mark.slow
    @pytest.mark.parametrize("count", [9, 12, 24])
    def test_signs_in_a_hall_are_separated(self, count: int) -> None:
        hall = load_room("hall")
        people = [f"user{number}" for number in range(1, count + 1)]
        infrared = InfraredCamera(hall, people, seed=count)
        for group in ([0], [1, 2], [count - 1], [0, count // 2], list(range(count))):
            watcher = SignWatcher(TableView(corners_in(hall), hall, count))
            for _ in range(6):
                seen = watcher.look(picture(infrared.frame([people[seat] for seat in group])))
            assert set(seen) == {seat + 1 for seat in group}

    def test_each_frame_has_its_own_noise(self) -> None:
        infrared = InfraredCamera(ROOM, PEOPLE, seed=1)
        frames = [infrared.frame(("user1",)) for _ in range(8)]
        assert all(one != other for one, other in pairwise(frames))
