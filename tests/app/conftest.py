"""What several tests of the program without a screen need."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.planned_games import Planned


@pytest.fixture
def planned(taught: Path) -> Iterator[Planned]:
    one = Planned(taught)
    yield one
    one.workspace.close()
