"""The source of requests that a robot's file names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_hw.perception.requests.help_request_source import RequestError
from tangy_hw.perception.requests.source_names import read_corners, requests_named
from tangy_hw.robot_process.self_test import try_robot
from tangy_profiles.activity import load_activity
from tangy_profiles.robot import Robot, load_robot

TABLE = "10,400, 600,400, 500,100, 110,100"
CORNERS = ((10.0, 400.0), (600.0, 400.0), (500.0, 100.0), (110.0, 100.0))


def robot_with(folder: Path, driver: str) -> Robot:
    text = load_robot().file.read_text(encoding="utf-8")
    named = f"\n[drivers]\nrequests = {driver}\n" if driver else ""
    (folder / "ours.toml").write_text(text + named, encoding="utf-8")
    return load_robot(str(folder / "ours.toml"))


@pytest.mark.parametrize(
    ("driver", "name", "corners"),
    [
        ("", "", ()),
        ('{ kind = "buttons" }', "buttons", ()),
        ('{ kind = "buttons", at = "/dev/input/event5" }', "buttons:/dev/input/event5", ()),
        ('{ kind = "mqtt", at = "mqtt://house/asks" }', "mqtt://house/asks", ()),
        (f'{{ kind = "signs", at = "0", table = "{TABLE}" }}', "signs:0", CORNERS),
        ('{ kind = "signs", at = 0 }', "signs:0", ()),
        ('{ kind = "buttons", at = "buttons:box" }', "buttons:box", ()),
        ('{ kind = "signs", at = "/dev/video2" }', "signs:/dev/video2", ()),
    ],
)
def test_the_file_names_a_source_like_the_command_line(
    driver: str, name: str, corners: object, tmp_path: Path
) -> None:
    assert requests_named(robot_with(tmp_path, driver)) == (name, corners)


def test_the_path_of_a_film_is_relative_to_the_file(tmp_path: Path) -> None:
    robot = robot_with(tmp_path, '{ kind = "signs", at = "signs.avi" }')
    assert requests_named(robot) == (f"signs:{tmp_path / 'signs.avi'}", ())


@pytest.mark.parametrize(
    ("driver", "problem"),
    [
        ('{ kind = "mqt", at = "mqtt://house/asks" }', "'mqt' tells no requests"),
        ('{ kind = "mqtt" }', "(mqtt): at is missing"),
        ('{ kind = "mqtt", at = "house/asks" }', "(mqtt): at = 'house/asks' must be"),
        (
            '{ kind = "mqtt", at = "mqtt://a/b", table = "1" }',
            "(mqtt): there is no setting 'table'",
        ),
        ('{ kind = "buttons", baud = 9600 }', "(buttons): there is no setting 'baud'"),
        ('{ kind = "signs", at = "0", table = "1,2,3" }', "table must be eight numbers"),
    ],
)
def test_a_wrong_source_is_refused_with_its_key(driver: str, problem: str, tmp_path: Path) -> None:
    with pytest.raises(RequestError) as refused:
        requests_named(robot_with(tmp_path, driver))
    assert str(refused.value).startswith("ours.toml: drivers.requests")
    assert problem in str(refused.value)


@pytest.mark.parametrize(
    "text", ["1,2,3", "a,b,c,d,e,f,g,h", "1,2,3,4,5,6,7,nan", "1,2,3,4,5,6,7,1e9"]
)
def test_corners_are_eight_numbers(text: str) -> None:
    with pytest.raises(RequestError, match="--table must be eight numbers"):
        read_corners(text)


@pytest.mark.parametrize(
    ("driver", "absent", "told"),
    [
        ("", True, "nothing tells who asks"),
        ('{ kind = "mqt" }', False, "tells no requests"),
        ('{ kind = "mqtt", at = "mqtt://127.0.0.1:1/x" }', False, "cannot be reached"),
    ],
)
async def test_a_trial_reports_whether_the_source_works(
    driver: str, absent: bool, told: str, tmp_path: Path
) -> None:
    found = await try_robot(robot_with(tmp_path, driver), load_activity("bingo"), {}, seconds=0.2)
    own = next(one for one in found if one.device == "requests")
    assert not own.ok and own.absent == absent
    assert told in own.text
