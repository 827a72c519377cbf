"""Learning from a store: only finished demonstrations count, and missing ones are reported."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.demonstration import Demonstration
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import NothingToLearnFrom
from tests.shown import log_demonstration


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    return Workspace(tmp_path)


def test_learning_during_the_first_game_asks_to_finish_it(
    workspace: Workspace, demonstrate: Callable[..., Demonstration]
) -> None:
    with pytest.raises(NothingToLearnFrom, match="demonstrate a game first"):
        learn(workspace)
    shown = demonstrate("bingo", 1, 4)
    log_demonstration(workspace.store, replace(shown, steps=shown.steps[:5], finished=False))
    with pytest.raises(NothingToLearnFrom, match="finish the demonstration"):
        learn(workspace)
    log_demonstration(workspace.store, replace(shown, id="whole"))
    assert learn(workspace).table
    workspace.close()
