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
from tangy_tui.text.log import replay_lines
from tangy_tui.text.steps import ENDED_BEFORE, NOT_FINISHED, STOPPED_BEFORE


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


@pytest.mark.parametrize("completed", [False, True])
def test_a_step_that_the_end_of_the_game_broke_off_is_no_failure_of_the_robot(
    workspace: Workspace, learnt: Policy, completed: bool
) -> None:
    game = workspace.supervision(learnt, 3)
    game.begin()
    game.step()
    done = workspace.store.last(GameStep)
    assert done is not None
    workspace.store.append(replace(done.record, completed=False))  # of itself, before
    workspace.store.append(replace(done.record, completed=completed))
    game.note("ended", "Ada")
    (replay,) = read_replays(
        workspace.store, read_games(workspace.store), {"bingo": workspace.activity}, {}
    )
    assert [one.ended for one in replay.done] == [False, False, not completed]
    lines = "\n".join(replay_lines(replay, workspace.activity, str))
    assert lines.count(ENDED_BEFORE) == (not completed) and lines.count(NOT_FINISHED) == 1
