"""Fixtures of the tests of execution monitoring: supervised games with faults."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.supervision import Supervision

Supervise = Callable[..., Supervision]


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def supervise(workspace: Workspace, learnt: Policy) -> Iterator[Supervise]:
    """Make supervised games: (*injections, seed=1, asks=True) -> games; in one transaction."""

    def make(*injections: str, seed: int = 1, asks: bool = True) -> Supervision:
        return workspace.supervision(learnt, seed, asks=asks, injections=injections)

    with workspace.store.transaction():  # none of these tests is about the disk
        yield make
