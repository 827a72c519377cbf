"""Another activity in the setup keeps the choices that it offers, and reports the others."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_tui.app.set_up import SetUp
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.learning.scripted_teacher import ScriptedTeacher

pytestmark = pytest.mark.slow

OTHERS = ("trivia", "team-trivia")


@pytest.fixture(scope="module")
def _each_taught(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("each") / "data"
    for activity in ("bingo", *OTHERS):
        workspace = Workspace(folder, activity=activity)
        teaching = workspace.teaching("scripted", 1)
        teaching.begin()
        list(ScriptedTeacher(teaching).demonstrate())
        learn(workspace)
        workspace.close()
    return folder


@pytest.fixture
def data_folder(_each_taught: Path) -> Path:
    """A folder in which Bingo and two other activities were taught."""
    return _each_taught


@pytest.fixture
def setup(workspace: Workspace) -> SetUp:
    """A setup for Bingo."""
    workspace.change_activity("bingo")
    return SetUp.of(workspace)


def test_seats_and_absences_stay_with_an_activity_of_the_same_people(setup: SetUp) -> None:
    setup.move("user1", 2)
    setup.toggle("user2")
    before = list(setup.seats)
    setup.play("trivia")
    assert setup.seats == before and setup.away == {"user2"}
    assert [person.id for person in setup.workspace.people] == before
    assert setup.dropped == []


def test_teams_take_no_seats_over_and_people_get_them_back(setup: SetUp) -> None:
    setup.move("user1", 2)
    setup.toggle("user2")
    before = list(setup.seats)
    setup.play("team-trivia")
    assert setup.dropped == ["seats"] and not setup.away
    setup.play("bingo")
    assert setup.seats == before and setup.away == {"user2"} and setup.dropped == []


def test_patterns_and_strengths_that_an_activity_lacks_are_dropped(setup: SetUp) -> None:
    rules = setup.workspace.activity.rules
    setup.toggle_pattern(rules.patterns[-1].name)
    setup.choose_strength(rules.strengths[0].name)
    setup.play("trivia")
    kept = [one.name for one in setup.workspace.activity.rules.strengths]
    assert setup.patterns == [] and "patterns" in setup.dropped
    assert (setup.strength in kept) == ("strength" not in setup.dropped)


def test_the_console_tells_what_is_not_kept(setup: SetUp) -> None:
    lines, said = iter(["seat user1 3", "activity team-trivia", "end"]), list[str]()
    SetUpLines(setup, lambda: next(lines, None), said.append).run()
    assert any(line.startswith("Not kept") and "the seats" in line for line in said)
