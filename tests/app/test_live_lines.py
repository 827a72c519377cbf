"""Live games by lines that a person joins: the message if the robot does not come on again."""

from __future__ import annotations

import io
from pathlib import Path
from typing import cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import LIVE
from tangy_profiles.robot import load_robot
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.verbs.live_lines import LiveLines
from tests.hw.links import FakeLink

RESUMES = "tangy live --resume"


@pytest.mark.slow
def test_a_game_is_kept_if_the_robot_does_not_come_on_again(
    taught: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    workspace = Workspace(taught)
    monkeypatch.setattr("sys.stdin", io.StringIO("wait until called\nadd Berta\n"))
    policy, _ = load_policy(workspace.store, workspace.activity)
    people = tuple(workspace.names)
    world = LiveWorld(
        workspace.activity, people, cast(RobotLink, FakeLink(people)),
        load_robot(), workspace.room, seed=1, names=workspace.names, pace=30.0,
    )  # fmt: skip
    console = LiveLines(workspace, 1, "Ada", None)
    with pytest.raises(TangyError), console.keeping(RESUMES):
        raise TangyError("It cannot be switched on.")
    assert RESUMES not in capsys.readouterr().out  # no game has begun
    assert console.play(workspace.supervision(policy, 1, asks=True, world=world), world)
    with pytest.raises(TangyError), console.keeping(RESUMES):
        raise TangyError("It cannot be switched on.")
    assert RESUMES in capsys.readouterr().out
    assert find_interrupted(workspace, LIVE) is not None
    workspace.close()
