"""The cache of forests: verified on reading, and optional."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.learning.conflicts import training_rows
from tangy_tui.learning.forest_cache import FOLDER, MOST, ForestCache
from tangy_tui.learning.policies import load_policy, need_policy
from tangy_tui.learning.policy import (
    EXACT,
    ForestSettings,
    all_situations,
    grown,
)

Rows = tuple[tuple[Situation, str], ...]
Demonstrate = Callable[[str, int, int], Demonstration]


@pytest.fixture
def rows(demonstrate: Demonstrate) -> Rows:
    shown, _ = training_rows([demonstrate("bingo", 1, 4)], [])
    return tuple(shown)


def kept(folder: Path) -> list[Path]:
    return sorted((folder / FOLDER).glob("*"))


def test_a_cached_forest_equals_the_grown_one(
    activity: Activity, rows: Rows, tmp_path: Path
) -> None:
    situations = tuple(all_situations(activity))
    cache = ForestCache(tmp_path)
    first = cache.grown(EXACT, rows, situations)
    (file,) = kept(tmp_path)
    before = file.read_bytes()
    assert first == grown(EXACT, rows, situations)
    assert ForestCache(tmp_path).grown(EXACT, rows, situations) == first
    assert file.read_bytes() == before


def test_settings_and_steps_identify_a_cached_forest(
    activity: Activity, rows: Rows, tmp_path: Path
) -> None:
    situations, cache = tuple(all_situations(activity)), ForestCache(tmp_path)
    for settings, some in ((EXACT, rows), (ForestSettings(trees=10), rows), (EXACT, rows[:-3])):
        cache.grown(settings, some, situations)
    assert len(kept(tmp_path)) == 3


@pytest.mark.slow
def test_a_manipulated_cache_is_noticed_and_corrected(taught: Path) -> None:
    with Store.open(taught, write=True) as store:
        activity = load_activity("bingo")
        right, notices = load_policy(store, activity)
        assert notices == []
        (file,) = kept(taught)
        told = json.loads(file.read_text())
        told["votes"] = [[["joke", 1.0]] for _ in told["votes"]]
        file.write_text(json.dumps(told))
        assert load_policy(store, activity) == (right, [])
        assert right.digest == need_policy(store, activity).digest
        assert json.loads(file.read_text())["votes"] != told["votes"]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        '{"votes": 3}',
        '{"votes": [], "versions": []}',
        "[" * 100_000,
        "\0",
        "NaN",
    ],
)
def test_an_invalid_cache_file_is_ignored(
    text: str, activity: Activity, rows: Rows, tmp_path: Path
) -> None:
    situations, cache = tuple(all_situations(activity)), ForestCache(tmp_path)
    first = cache.grown(EXACT, rows, situations)
    (file,) = kept(tmp_path)
    file.write_text(text)
    assert cache.grown(EXACT, rows, situations) == first
    assert json.loads(file.read_text())["votes"]


def test_the_forest_is_grown_again_if_the_cache_cannot_be_written(
    activity: Activity, rows: Rows, tmp_path: Path
) -> None:
    (tmp_path / FOLDER).write_text("a file in the way")
    situations = tuple(all_situations(activity))
    assert ForestCache(tmp_path).grown(EXACT, rows, situations).votes
    assert (tmp_path / FOLDER).read_text() == "a file in the way"


def test_only_the_newest_files_are_kept(activity: Activity, rows: Rows, tmp_path: Path) -> None:
    situations, cache = tuple(all_situations(activity)), ForestCache(tmp_path)
    (tmp_path / FOLDER).mkdir()
    for old in range(MOST + 5):
        (tmp_path / FOLDER / f"{old:040}.json").write_text("{}")
    cache.grown(EXACT, rows, situations)
    assert len(kept(tmp_path)) == MOST


@pytest.mark.slow
def test_showing_a_policy_loads_no_forest(taught: Path) -> None:
    look = (
        "import sys; from tangy_tui.cli import main\n"
        f"sys.argv = ['tangy', 'policy', '--json', '--data', {str(taught)!r}]\n"
        "try: main()\n"
        "except SystemExit as ended: assert not ended.code\n"
        "print('loaded' if 'sklearn' in sys.modules else 'not loaded', file=sys.stderr)"
    )
    done = [
        subprocess.run([sys.executable, "-c", look], capture_output=True, text=True)  # noqa: S603
        for _ in range(2)
    ]
    assert [one.returncode for one in done] == [0, 0]
    assert done[1].stderr.strip() == "not loaded"
    assert done[0].stdout == done[1].stdout


@pytest.mark.parametrize("share", ["NaN", "Infinity", "-1.0", "0.25"])
def test_a_cache_with_impossible_votes_is_grown_again(
    share: str, activity: Activity, rows: Rows, tmp_path: Path
) -> None:
    situations, cache = tuple(all_situations(activity)), ForestCache(tmp_path)
    first = cache.grown(EXACT, rows, situations)
    (file,) = kept(tmp_path)
    told = json.loads(file.read_text())
    told["votes"][0] = [[told["votes"][0][0][0], "SHARE"]]
    file.write_text(json.dumps(told).replace('"SHARE"', share))
    assert cache.grown(EXACT, rows, situations) == first
