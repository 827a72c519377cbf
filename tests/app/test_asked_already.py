"""Asking for somebody who waits already, and people by their last names."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import AskFor
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.control import noted_words
from tests.app.test_interruption import Robot


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    workspace = Workspace(taught)
    yield Robot(workspace)
    workspace.close()


def asked(robot: Robot, person: str) -> str:
    (note,) = robot.control.apply(AskFor(person))
    assert isinstance(note, StaffNote)
    return noted_words(note, robot.workspace.name)


def test_asking_again_tells_the_place_and_keeps_it(robot: Robot) -> None:
    robot.next(2)
    assert asked(robot, "user3") == "You asked for User 3. Tangy goes there in turn."
    assert asked(robot, "user3") == (
        "User 3 waits for Tangy already, and is the first of those who wait."
    )
    robot.link.time += 5.0
    assert asked(robot, "user2") == "You asked for User 2. Tangy goes there in turn."
    assert asked(robot, "user2") == "User 2 waits for Tangy already, after User 3."
    robot.link.time += 5.0
    asked(robot, "user3")
    assert [*robot.world.requests.all] == ["user3", "user2"]
    assert robot.world.requests.all["user3"] < robot.world.requests.all["user2"]
    done = robot.workspace.store.events(StaffAction)
    assert sum(one.record.did == "asked for" for one in done) == 2


def test_who_put_up_a_sign_keeps_the_place_if_staff_ask_too(robot: Robot) -> None:
    robot.next(2)
    robot.link.sign(4)
    robot.world.observe()
    since = robot.world.requests.all["user4"]
    robot.link.time += 30.0
    assert asked(robot, "user4").startswith("User 4 waits for Tangy already")
    assert robot.world.requests.all["user4"] == since


def test_a_title_and_the_last_name_name_a_person(workspace: Workspace) -> None:
    workspace.rename(workspace.find_person("user1"), "Rosa Berg")
    workspace.rename(workspace.find_person("user2"), "Stein")
    assert workspace.find_person("Mrs Berg").id == workspace.find_person("mrs. berg").id == "user1"
    assert workspace.find_person("Mr Stein").id == "user2"
    with pytest.raises(TangyError, match="There is nobody called 'Berg'"):
        workspace.find_person("Berg")
    workspace.rename(workspace.find_person("user3"), "Otto Berg")
    with pytest.raises(TangyError, match="More than one person"):
        workspace.find_person("Mrs Berg")
