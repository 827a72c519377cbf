"""A game killed at any moment is in the log, and resumes where it was."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.bench.kills import run

KILLS = 4


@pytest.mark.slow
@pytest.mark.timeout(900)
@pytest.mark.parametrize("bench", [False, True], ids=["simulated", "bench"])
def test_a_killed_game_loses_nothing_and_resumes(bench: bool, tmp_path: Path) -> None:
    found = run(1 if bench else KILLS, bench=bench, seed=11, scratch=tmp_path, every=2)
    assert found.acknowledged > 0
    assert (found.lost, found.not_offered, found.other) == (0, 0, {})
    assert bench or found.played_on == KILLS // 2
