"""A game that is killed at any moment stands in the log, and goes on where it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.bench.kills import run

KILLS = 4


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_a_killed_game_loses_nothing_and_goes_on_as_it_was(tmp_path: Path) -> None:
    found = run(KILLS, bench=False, seed=11, scratch=tmp_path, every=2)
    assert found.acknowledged > 0
    assert (found.lost, found.not_offered, found.other) == (0, 0, {})
    assert found.played_on == KILLS // 2
