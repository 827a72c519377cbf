"""The set-up offers what staff chose for their last game."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tangy_profiles.game_rules import USUAL_PACE, GamePlan
from tangy_tui.app.game_commands import (
    ChoosePatterns,
    ComesIn,
    EndGame,
    GoesAway,
    GoOn,
    LetWin,
    SetPace,
)
from tangy_tui.app.last_plan import last_plan
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.set_up import as_before_words
from tests.app.test_interruption import Robot

PLAN = GamePlan(("two lines", "line"), True, True, "", ("user3",), 20.0, 40)


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


def test_without_a_game_the_set_up_offers_its_usual_choices(workspace: Workspace) -> None:
    setup = SetUp.of(workspace)
    before = setup.plan
    assert not setup.offer_last_plan()
    assert setup.plan == before


def test_the_set_up_offers_the_last_plan_with_its_changes(workspace: Workspace) -> None:
    robot = Robot(workspace)
    robot.control.abandon()
    robot.control.apply(GoOn())
    robot.world.choose(PLAN)
    robot.control.begin()
    for command in (SetPace(15.0), GoesAway("user1"), ComesIn("user3")):
        robot.control.apply(command)
    setup = SetUp.of(workspace)
    assert setup.offer_last_plan()
    assert setup.plan == replace(PLAN, absent=("user1",), pace=15.0)
    told = as_before_words(setup)
    away = workspace.name("user1")
    assert told.startswith(f"As you left your last game. Not here: {away}. Played for: two lines")
    assert "15 s" in told and "40 minutes" in told
    given = SetUp.of(workspace, 45.0)  # on the command line
    given.offer_last_plan()
    assert given.pace == 45.0
    usual = SetUp.of(workspace, USUAL_PACE)  # on the command line as well
    usual.offer_last_plan()
    assert usual.pace == USUAL_PACE


def test_who_was_away_on_another_day_is_expected_again(workspace: Workspace) -> None:
    robot = Robot(workspace)
    robot.control.abandon()
    robot.control.apply(GoOn())
    robot.world.choose(PLAN)
    robot.control.begin()
    name = workspace.activity.name
    today, tomorrow = datetime.now(UTC), datetime.now(UTC) + timedelta(days=1)
    assert last_plan(workspace.store, name, today) == PLAN
    assert last_plan(workspace.store, name, tomorrow) == replace(PLAN, absent=())
    assert last_plan(workspace.store, "another") is None


def test_what_staff_choose_between_two_games_holds_in_the_next(workspace: Workspace) -> None:
    robot = Robot(workspace)
    control, world = robot.control, robot.world
    robot.next(2)
    control.apply(EndGame())
    for command in (
        SetPace(7.0),
        ChoosePatterns(("full card",)),
        LetWin(True, True),
        GoesAway("user2"),
    ):
        control.apply(command)
    assert control.begin()
    present = world.patterns.present
    assert world.pace == 7.0 and present is not None and present.name == "full card"
    assert world.game_plan.several and world.game_plan.visits
    assert control.plan.away == {"user2"}
    control.apply(ComesIn("user2"))
    assert control.plan.away == frozenset()
