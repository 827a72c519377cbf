"""People in scans: legs are paired, people are tracked with their speed, mapped points are not."""

from __future__ import annotations

from math import cos, hypot, inf, pi, sin

import numpy as np
import pytest

from tangy_hw.device_protocols import Pose, Scan, Twist
from tangy_hw.navigation.leg_detection import sightings
from tangy_hw.navigation.obstacles import Obstacles
from tangy_hw.navigation.people_tracker import PeopleTracker, Track
from tests.bench.people_simulation import CHAIR, MAP, TICK, Drive, Person
from tests.hw.raycast import driven

STANDS = Pose(5.0, 1.2, pi / 2)


def walks(heading: float, speed: float) -> Person:
    """Return a person who walks straight on."""

    def step(person: Person, drive: Drive) -> None:
        person.walk(heading, speed)

    return Person(0, 0, heading, step)


def drive(people: list[Person], seed: int = 1, pose: Pose = STANDS) -> Drive:
    return Drive(pose, pose, people, np.random.default_rng(seed))


class Watching:
    """A tracker on a drive with exact odometry and a known pose."""

    def __init__(self, drive: Drive, *, knows_map: bool = True) -> None:
        self.drive, self.tracker = drive, PeopleTracker()
        self.obstacles = Obstacles(MAP) if knows_map else None

    def watch(self, seconds: float, twist: Twist | None = None) -> list[tuple[Track, ...]]:
        seen = []
        for _ in range(round(seconds / TICK)):
            if twist is not None:
                self.drive.pose = driven(self.drive.pose, twist, TICK)
            scan, pose = self.drive.look(), self.drive.pose
            mask = None if self.obstacles is None else self.obstacles.unmapped(pose, scan)
            seen.append(self.tracker.update(pose, scan, TICK, mask))
            for person in self.drive.people:
                person.step(person, self.drive)
        return seen


def nearest(tracks: tuple[Track, ...], person: Person) -> tuple[float, Track]:
    return min(((hypot(one.x - person.x, one.y - person.y), one) for one in tracks),
               key=lambda found: found[0])  # fmt: skip


class TestSightings:
    def test_two_legs_make_one_person_between_them(self) -> None:
        person = Person(5.0, 2.7, pi / 2)
        scene = drive([person])
        scan = scene.look()
        people = [
            one
            for one in sightings(scan, unmapped=Obstacles(MAP).unmapped(STANDS, scan))
            if one.legs
        ]
        assert len(people) == 1
        assert hypot(people[0].x - 1.5, people[0].y) < 0.1

    def test_walls_and_mapped_objects_are_no_people(self) -> None:
        scan = drive([]).look()
        assert sightings(scan, unmapped=Obstacles(MAP).unmapped(STANDS, scan)) == []

    @pytest.mark.parametrize("far", [1.0, 2.5, 4.0])
    def test_an_object_as_wide_as_a_wheelchair_keeps_its_width(self, far: float) -> None:
        ranges = np.full(360, inf)
        beams = np.arange(360)
        wide = np.abs((beams - 180) * 0.75 * pi / 180) < 0.3 / far
        ranges[wide] = far
        found = sightings(Scan(-135 * pi / 180, 0.75 * pi / 180, ranges, 30.0))
        assert len(found) == 1 and found[0].half == pytest.approx(0.3, abs=0.06)

    def test_sightings_account_for_the_place_of_the_scanner(self) -> None:
        ranges = np.full(360, inf)
        ranges[178:183] = 1.0
        (one,) = sightings(Scan(-3.14, 0.0175, ranges, 30.0), Pose(0.25, 0.1, 0.0))
        assert one.x == pytest.approx(0.25 + 1.06, abs=0.02)
        assert one.y == pytest.approx(0.1, abs=0.03)


class TestTracks:
    @pytest.mark.parametrize("speed", [0.4, 0.8, 1.3])
    def test_a_walker_is_tracked_with_the_right_speed(self, speed: float) -> None:
        person = walks(0.0, speed)
        person.x, person.y = 3.5, 2.9
        watching = Watching(drive([person]))
        for tracks in watching.watch(3.0)[12:]:
            assert tracks
        off, track = nearest(watching.tracker.tracks, person)
        assert off < 0.3 + 0.1 * speed and track.person
        assert abs(track.vx - speed) < 0.35 and abs(track.vy) < 0.35

    def test_a_standing_person_has_no_speed(self) -> None:
        person = Person(5.2, 2.6, 0.4)
        watching = Watching(drive([person]))
        watching.watch(2.5)
        off, track = nearest(watching.tracker.tracks, person)
        assert off < 0.1 and track.speed == 0.0 and track.stood > 1.0 and track.person

    @pytest.mark.parametrize("seed", [1, 2, 3, 4])
    def test_who_sets_off_counts_as_walking_within_two_scans(self, seed: int) -> None:
        person = Person(5.2, 2.6, 0.4)
        watching = Watching(drive([person], seed))
        watching.watch(2.5)
        person.step = walks(-pi / 2, 0.7).step
        watching.watch(3 * TICK)  # where they stood, and two steps further
        track = nearest(watching.tracker.tracks, person)[1]
        assert track.stood == 0.0 and track.vy < -0.2 and track.pace > 0.2

    def test_the_motion_of_the_robot_gives_people_no_speed(self) -> None:
        person = Person(5.3, 3.4, 0.4)
        watching = Watching(drive([person]))
        watching.watch(3.0, Twist(0.4, 0.15))
        off, track = nearest(watching.tracker.tracks, person)
        assert off < 0.15 and track.speed == 0.0

    @pytest.mark.parametrize("seed", [1, 2, 3])
    def test_an_empty_room_has_no_person_tracks(self, seed: int) -> None:
        watching = Watching(drive([], seed))
        seen = watching.watch(12.0, Twist(0.1, 0.5))
        assert not any(track.person for tracks in seen for track in tracks)

    def test_a_person_hidden_behind_another_is_remembered(self) -> None:
        person = walks(0.0, 0.8)
        person.x, person.y = 4.0, 3.3
        stands = Person(5.0, 2.2, 0.0)
        watching = Watching(drive([person, stands]))
        for _ in range(25):
            watching.watch(TICK)
            if person.x > 4.5:
                assert nearest(watching.tracker.tracks, person)[0] < 0.6

    @pytest.mark.parametrize("apart", [0.25, 0.35])
    @pytest.mark.parametrize("seed", [1, 2, 3, 4])
    def test_two_walkers_who_pass_each_other_stay_the_same_people(
        self, apart: float, seed: int
    ) -> None:
        right, left = walks(0.0, 1.2), walks(pi, 1.0)
        right.x, right.y = 3.2, 2.4
        left.x, left.y = 6.5, 2.4 + apart  # the other one hides them as they meet
        watching = Watching(drive([right, left], seed))
        watching.watch(0.8)
        for _ in range(16):
            watching.watch(TICK)
            for person, speed in ((right, 1.2), (left, -1.0)):
                off, track = nearest(watching.tracker.tracks, person)
                assert off < 0.25 and abs(track.vx - speed) < 0.4 and track.age > 0.7
        tracks = [nearest(watching.tracker.tracks, one)[1] for one in (right, left)]
        assert all(track.age > 2.3 for track in tracks) and len(watching.tracker.tracks) == 2

    def test_a_walker_who_leaves_the_view_is_forgotten_after_a_moment(self) -> None:
        person = walks(-pi / 2, 1.0)
        person.x, person.y = 5.8, 2.6  # past the robot, and out of sight behind it
        watching = Watching(drive([person], pose=Pose(5.0, 2.6, pi / 2)))
        seen = watching.watch(1.6)
        assert any(track.hidden for track in seen[-1])
        watching.watch(1.2)
        assert watching.tracker.tracks == ()

    def test_legs_far_apart_in_a_stride_stay_one_person(self) -> None:
        person = walks(0.0, 1.3)
        person.x, person.y = 3.5, 2.7
        watching = Watching(drive([person]))
        watching.watch(0.6)
        for _ in range(16):
            watching.watch(TICK)
            off, track = nearest(watching.tracker.tracks, person)
            assert off < 0.3 and track.age > 0.3

    def test_a_walker_who_turns_back_stays_tracked_as_walking(self) -> None:
        speeds = [0.0, pi]

        def step(person: Person, drive: Drive) -> None:
            person.walk(speeds[0] if person.gone < 1.5 else speeds[1], 1.2)

        person = Person(4.2, 2.8, 0.0, step)
        watching = Watching(drive([person]))
        watching.watch(0.8)
        for _ in range(14):
            watching.watch(TICK)
            _, track = nearest(watching.tracker.tracks, person)
            assert track.stood == 0.0 and track.age > 0.3 and track.pace > 0.25

    def test_a_slowing_walker_keeps_the_recent_pace(self) -> None:
        def step(person: Person, drive: Drive) -> None:
            person.walk(0.0, 1.2 if person.gone < 1.5 else 0.4)

        person = Person(4.2, 2.8, 0.0, step)
        watching = Watching(drive([person]))
        watching.watch(2.4)
        _, track = nearest(watching.tracker.tracks, person)
        assert track.speed < 0.7 and track.pace > 0.9
        watching.watch(3.0)
        _, track = nearest(watching.tracker.tracks, person)
        assert track.pace < 0.8  # not for ever

    def test_a_walker_keeps_the_pace_until_they_have_stood_for_a_while(self) -> None:
        def step(person: Person, drive: Drive) -> None:
            if person.gone < 1.0:
                person.walk(0.0, 1.0)

        person = Person(4.2, 2.8, 0.0, step)
        watching = Watching(drive([person]))
        watching.watch(1.0)
        while not (track := nearest(watching.tracker.tracks, person)[1]).stood:
            watching.watch(TICK)
        assert track.speed == 0.0 and track.pace > 0.6
        watching.watch(0.7)
        assert nearest(watching.tracker.tracks, person)[1].pace == 0.0

    def test_a_person_who_left_is_forgotten(self) -> None:
        person = Person(5.2, 2.6, 0.4)
        watching = Watching(drive([person]))
        watching.watch(1.5)
        watching.drive.people.clear()
        watching.watch(2.0)
        assert watching.tracker.tracks == ()

    def test_a_wheelchair_is_tracked_near_its_middle(self) -> None:
        chair = walks(0.0, 0.5)
        chair.x, chair.y, chair.radius = 4.2, 2.8, CHAIR
        watching = Watching(drive([chair]))
        watching.watch(2.0)
        near = [
            one for one in watching.tracker.tracks
            if hypot(one.x - chair.x, one.y - chair.y) < CHAIR + 0.15
        ]  # fmt: skip
        assert near and max(one.speed for one in near) > 0.2

    def test_a_track_is_seen_from_where_the_robot_is(self) -> None:
        track = Track(1.0, 2.0, 0.5, 0.0, 0.22, 1.0, 0.0, True, False)
        seen = track.seen_from(Pose(1.0, 1.0, pi / 2))
        assert (seen.x, seen.y) == pytest.approx((1.0, 0.0))
        assert (seen.vx, seen.vy) == pytest.approx((0.5 * cos(-pi / 2), 0.5 * sin(-pi / 2)))
