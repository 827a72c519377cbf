"""Live games by lines that a person joins: the message if the robot does not come on again."""

from __future__ import annotations

import os
from itertools import count
from pathlib import Path
from typing import TextIO

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import LIVE
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.verbs.live_lines import LiveLines
from tests.hw.links import FakeLink
from tests.support.live_worlds import live_world

RESUMES = "tangy live --resume"
CALL = 2  # Tangy greets the group before


def joins_at_the_first_call(link: FakeLink) -> TextIO:
    """Return standard input on which Berta is added when Tangy first calls a number."""
    reads, writes = os.pipe()
    performed = count(1)

    def meanwhile(do: str, time: float) -> None:
        if do == "perform" and next(performed) == CALL:
            os.write(writes, b"add Berta\n")
            os.close(writes)

    link.meanwhile = meanwhile
    return os.fdopen(reads)


@pytest.mark.slow
def test_a_game_is_kept_if_the_robot_does_not_come_on_again(
    taught: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    workspace = Workspace(taught)
    policy, _ = load_policy(workspace.store, workspace.activity)
    people = tuple(workspace.names)
    link = FakeLink(people)
    monkeypatch.setattr("sys.stdin", joins_at_the_first_call(link))
    world = live_world(workspace, link, pace=30.0)
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
