"""What the tests of execution monitoring share: supervised games with faults in them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from shutil import copytree

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.supervision import Supervision

Supervise = Callable[..., Supervision]


@pytest.fixture(scope="session")
def learnt(_taught: Path, tmp_path_factory: pytest.TempPathFactory) -> Policy:
    """The policy of the taught folder, fitted once for all tests."""
    workspace = Workspace(Path(copytree(_taught, tmp_path_factory.mktemp("learnt") / "data")))
    try:
        return load_policy(workspace.store, workspace.activity)[0]
    finally:
        workspace.close()


@pytest.fixture
def workspace(taught: Path) -> Iterator[Workspace]:
    """A workspace in which three demonstrations were given and learnt from."""
    opened = Workspace(taught)
    yield opened
    opened.close()


@pytest.fixture
def supervise(workspace: Workspace, learnt: Policy) -> Iterator[Supervise]:
    """Make supervised games: (*injections, seed=1, asks=True) -> them; written in one go."""

    def make(*injections: str, seed: int = 1, asks: bool = True) -> Supervision:
        return workspace.supervision(learnt, seed, asks=asks, injections=injections)

    with workspace.store.transaction():  # none of these tests is about the disk
        yield make
