"""A step that people stopped is told as stopped, and not as a failure of the robot."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.game_records import GameStep
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.replay import read_replays
from tangy_tui.text.log import STOPPED_BEFORE, replay_lines


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.mark.parametrize(
    ("acts", "stopped"),
    [(("stopped",), True), (("stopped", "let go on"), False), ((), False)],
)
def test_a_step_is_stopped_if_the_robot_was_stopped_when_it_was_over(
    workspace: Workspace, learnt: Policy, acts: tuple[StaffActionKind, ...], stopped: bool
) -> None:
    game = workspace.supervision(learnt, 3)
    game.begin()
    game.step()
    for did in acts:
        game.note(did, "Ada")
    done = workspace.store.last(GameStep)
    assert done is not None
    workspace.store.append(replace(done.record, completed=False))
    workspace.store.append(done.record)  # was over before the robot stood still
    (replay,) = read_replays(
        workspace.store, read_games(workspace.store), {"bingo": workspace.activity}, {}
    )
    first, second, third = replay.done
    assert (first.stopped, second.stopped, third.stopped) == (False, stopped, False)
    lines = list(replay_lines(replay, workspace.activity, str))
    assert sum(STOPPED_BEFORE in line for line in lines) == stopped
