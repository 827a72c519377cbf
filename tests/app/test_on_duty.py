"""The person on duty: the name in the log and in reports for actions of staff in live games."""

from __future__ import annotations

from datetime import timedelta
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.store import Store
from tangy_tui.app.on_duty import on_duty, take_duty
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.teacher_profile import change_name
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.monitoring.games import read_games
from tangy_tui.text.live_games import played_lines
from tests.app.test_joining import LiveGame


def test_the_name_is_kept_for_the_next_session(tmp_path: Path) -> None:
    change_name(tmp_path, "Rosa")
    assert on_duty(tmp_path) == "Rosa"  # until the next person is
    take_duty(tmp_path, " Nina ")
    assert on_duty(tmp_path) == "Nina"
    with pytest.raises(TangyError):
        take_duty(tmp_path, "")
    assert on_duty(tmp_path) == "Nina"


def test_staff_say_by_lines_who_is_on_duty(data_folder: Path) -> None:
    workspace = Workspace(data_folder)
    lines, told = iter(["duty Nina", "Otto is on duty", "end"]), list[str]()
    SetUpLines(SetUp.of(workspace), lambda: next(lines, None), told.append).run()
    assert any("On duty: Nina." in line for line in told)
    assert SetUp.of(workspace).on_duty == "Otto"
    workspace.close()


REPORT = "tangy report --data 'my home'"


def test_the_end_of_a_game_is_told_with_the_way_to_its_report(taught: Path) -> None:
    workspace = Workspace(taught)
    game = LiveGame(workspace)
    game.play(3)
    store: Store = workspace.store
    (begun,) = read_games(store)
    assert played_lines([begun], begun.at, REPORT) == []  # it is not over
    game.control.abandon()
    (ended,) = read_games(store)
    first, *_, last = played_lines([ended], begun.at, REPORT)
    assert first.startswith("Game 1: ") and last.endswith(REPORT)
    assert ended.ended is not None
    assert played_lines([ended], ended.ended + timedelta(seconds=1), REPORT) == []
    workspace.close()
