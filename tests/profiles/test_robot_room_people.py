"""The robot, the room and the people: shipped files are valid, and mistakes are one line."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import pytest

from tangy_profiles.activity import Activity
from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.person import Person, load_people
from tangy_profiles.robot import load_robot
from tangy_profiles.room import Point, load_room
from tangy_profiles.state import FRONT

SHIPPED = Path(str(files("tangy_profiles")))
ROBOT = (SHIPPED / "robots" / "tangy.toml").read_text(encoding="utf-8")
ROOM = (SHIPPED / "rooms" / "common-room.toml").read_text(encoding="utf-8")
PEOPLE = (SHIPPED / "people" / "sample.toml").read_text(encoding="utf-8")


def changed(folder: Path, text: str, old: str, new: str) -> Path:
    assert old in text
    path = folder / "mine.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


# ------------------------------------------------------------------------------ the body


def test_tangy_has_two_six_joint_arms_with_grippers_and_a_six_joint_head() -> None:
    limbs = load_robot().limbs
    assert {name: len(limb.joints) for name, limb in limbs.items()} == {
        "left_arm": 6, "left_gripper": 2, "right_arm": 6, "right_gripper": 2, "head": 6,
    }  # fmt: skip


def test_every_posture_poses_every_joint_within_its_limits() -> None:
    robot = load_robot()
    for posture, angles in robot.postures.items():
        assert set(angles) == set(robot.limbs), posture
        for name, limb in robot.limbs.items():
            for angle, low, high in zip(angles[name], limb.low, limb.high, strict=True):
                assert low <= angle <= high


def test_the_body_knows_every_posture_of_the_activities(
    activity: Activity, lanterns: Activity
) -> None:
    load_robot().check(activity)
    load_robot().check(lanterns)


def test_an_unknown_posture_is_refused_with_a_suggestion(activity: Activity) -> None:
    joke = replace(activity.behaviours["joke"], posture="jesst")
    clumsy = replace(activity, behaviours={**activity.behaviours, "joke": joke})
    with pytest.raises(ProfileError) as caught:
        load_robot().check(clumsy)
    for words in ("bingo.toml", "behaviours[joke].posture = 'jesst'", "did you mean 'jest'?"):
        assert words in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("speed = 0.5", "speed = 50", ("speed = 50", "0.05 to 3 m/s")),
        ("speed = 0.5", "speed = 0,5", ("has a point, as in 0.5",)),
        ("speed = 0.5", "speed = 0.5\n[bodi]\n[more]", ("did you mean 'body'?",)),
        (
            "[gaze]",
            "[body]\nradius = 0.3\ncorners = [1, 1, -1, 1, -1, -1, 1, -1]\n[gaze]",
            ("body.radius", "remove one of the two"),
        ),
        ("[gaze]", "[body]\nlength = 0.7\n[gaze]", ("body.length", "corners")),
        ("[gaze]", "[body]\nturn = 45\n[gaze]", ("body.turn", "rad/s")),
        ("[gaze]", "[body]\nlaser.x = 20\n[gaze]", ("body.laser.x", "-2 to 2 m.")),
        ("speed = 0.5", "sped = 0.5", ("speed", "missing")),
        ("low = [-60,", "low = [-60, 1,", ("limbs[left_arm].low", "list of 6 numbers")),
        ("low = [-60,", "low = [nan,", ("limbs[left_arm].low", "list of 6 numbers")),
        ("low = [-60,", "low = [175,", ("limbs[left_arm].low", "`high`")),
        ("right_arm = [140,", "right_arm = [190,", ("postures.wave.right_arm", "shoulder pitch")),
        ("[postures.rest]", "[postures.rest]\ntail = [1]", ("postures.rest.tail", "not a key")),
        ('looks_at = "cards"\n#', 'looks_at = "card"\n#', ("devices[camera].looks_at", "'cards'")),
        ('looks_at = "cards"\n#', "source = 0\n#", ("devices[camera].source", "text in quotes")),
    ],
)
def test_a_mistake_in_a_body_is_one_line(
    tmp_path: Path, old: str, new: str, said: tuple[str, ...]
) -> None:
    with pytest.raises(ProfileError) as caught:
        load_robot(str(changed(tmp_path, ROBOT, old, new)))
    for words in ("mine.toml: ", *said):
        assert words in str(caught.value)


def test_a_robot_without_limbs_needs_no_postures(tmp_path: Path, activity: Activity) -> None:
    text = load_robot("turtlebot4").file.read_text(encoding="utf-8")
    path = tmp_path / "mine.toml"
    path.write_text(text[: text.index("[postures.rest]")], encoding="utf-8")
    robot = load_robot(str(path))
    robot.check(activity)
    assert not robot.postures


def test_every_robot_has_a_link_with_a_fact_for_freezes(tmp_path: Path) -> None:
    told = """[[devices]]
name = "link"
label = "link to the robot"
stale_after = 0.25
"""
    without = load_robot(str(changed(tmp_path, ROBOT, told, "")))
    assert without.devices["link"] == load_robot().devices["link"]
    assert "frozen" in without.devices["link"].facts
    assert load_faults(without).rule("control-frozen").critical


def test_an_unknown_robot_or_room_is_refused_with_a_suggestion() -> None:
    with pytest.raises(ProfileError, match="did you mean 'tangy'"):
        load_robot("tangi")
    with pytest.raises(ProfileError, match="did you mean 'common-room'"):
        load_room("commonroom")


# ------------------------------------------------------------------------------ the room


def test_the_common_room_is_ten_by_eight_metres_with_four_seats() -> None:
    room = load_room()
    assert (room.width, room.depth, len(room.seats)) == (10, 8, 4)
    assert room.seated(4) == room.seats


@pytest.mark.parametrize("count", range(1, 9))
def test_everybody_has_a_seat_behind_the_table_and_the_robot_a_place_before_it(count: int) -> None:
    room = load_room()
    people = [f"user{n}" for n in range(1, count + 1)]
    left, near, right, far = room.table
    seats = room.seated(count)
    assert len(set(seats)) == count
    assert list(seats) == sorted(seats, key=lambda seat: seat.x)
    for person, seat in zip(people, seats, strict=True):
        assert left <= seat.x <= right
        assert far < seat.y <= room.depth
        stand = room.stand(person, people)
        assert stand == Point(seat.x, near - room.reach)
    assert room.stand(FRONT, people) == room.front
    assert room.front.y < near


def test_points_measure_and_divide_the_way_between_them() -> None:
    start, end = Point(1, 1), Point(4, 5)
    assert start.distance(end) == end.distance(start) == 5
    assert start.towards(end, 0) == start
    assert start.towards(end, 1) == end
    assert start.towards(end, 0.5) == Point(2.5, 3)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("width = 10.0", "width = 1", ("width = 1", "2 to 100")),
        ("table = [1.2,", "table = [9.2,", ("table", "left, near, right, far")),
        ("front = [5.0, 1.2]", "front = [5.0, 4.9]", ("front", "front wall and the table")),
        ("x = 2.0", "x = 20", ("seats[1].x = 20", "0 to 10")),
        ("reach = 0.7", "reach = 'far'", ("reach = 'far'",)),
        ("[[seats]]\nx = 2.0", "[[seat]]\nx = 2.0", ("seat",)),
        ('seat_word = "seat"', 'seat_word = "Seat 2"', ("seat_word = 'Seat 2'", "as they are")),
        ("x = 2.0", 'name = "a\\tb"\nx = 2.0', ("seats[", "cannot be shown")),
        (
            "x = 2.0\ny = 6.5\n\n[[seats]]\nx = 4.0",
            'name = "door"\nx = 2.0\ny = 6.5\n\n[[seats]]\nname = "door"\nx = 4.0',
            ("seats", "same name"),
        ),
    ],
)
def test_a_mistake_in_a_room_is_one_line(
    tmp_path: Path, old: str, new: str, said: tuple[str, ...]
) -> None:
    with pytest.raises(ProfileError) as caught:
        load_room(str(changed(tmp_path, ROOM, old, new)))
    for words in ("mine.toml: ", *said):
        assert words in str(caught.value)


# ---------------------------------------------------------------------------- the people


@pytest.mark.parametrize("count", range(1, 9))
def test_one_to_eight_people_take_part_each_with_an_id(count: int) -> None:
    people = load_people(count)
    assert people == tuple(Person(f"user{n}", f"User {n}") for n in range(1, count + 1))


@pytest.mark.parametrize("count", [-1, 0, 25, 10_000_000])
def test_other_numbers_of_people_are_refused(count: int) -> None:
    with pytest.raises(ProfileError, match="from 1 to 24"):
        load_people(count)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('id = "user2"', 'id = "user1"', ("people", "same id")),
        ('id = "user2"', 'id = "front"', ("people", "'front'")),
        ('more_id = "user{n}"', 'more_id = "user{x}"', ("people", "same id")),
        ('name = "User 2"', 'name = "User\\t2"', ("people[User�2].name", "cannot be shown")),
        ('name = "User 2"', 'nick = "Bo"', ("people[2].name", "missing")),
        ('id = "user2"', "id = 2", ("people[User 2].id = 2", "text in quotes")),
    ],
)
def test_a_mistake_about_people_is_one_line(
    tmp_path: Path, old: str, new: str, said: tuple[str, ...]
) -> None:
    with pytest.raises(ProfileError) as caught:
        load_people(8, changed(tmp_path, PEOPLE, old, new))
    for words in ("mine.toml: ", *said):
        assert words in str(caught.value)
