"""A command beside a running game reports its process, in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.defaults import REGISTERED
from tangy_profiles.errors import StoreBusy
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.verbs.opening import open_workspace


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


def refused(folder: Path) -> str:
    with pytest.raises(StoreBusy) as caught, open_workspace(folder, "", REGISTERED):
        pass
    return str(caught.value)


def test_a_running_game_is_named_with_its_driver(workspace: Workspace) -> None:
    learnt, _ = load_policy(workspace.store, workspace.activity)
    control = GameController(workspace.supervision(learnt, 4), "Ann")
    workspace.door.open()
    workspace.door.attach(control)
    folder = workspace.store.folder
    assert "another Tangy" in refused(folder)  # no game has begun
    control.begin()
    assert refused(folder).startswith("Ann runs a game (simulated) with the data in ")


def test_a_program_that_shows_no_game_is_told_of(workspace: Workspace) -> None:
    assert refused(workspace.store.folder).startswith("another Tangy (process ")
