"""`tangy log`: played games on the command line."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.activity import shipped_activities
from tangy_profiles.store import Store
from tangy_tui.monitoring.fault_table import ROWS
from tangy_tui.monitoring.games import Game
from tangy_tui.ui.log_report import print_games
from tests.support.append_body import append_body
from tests.support.games import play

Tangy = Callable[..., CompletedProcess[str]]
FAULTS = ("laser-disconnected@6", "path-blocked", "arm-failed@9")


@pytest.fixture(scope="module")
def _played(_taught: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policies import load_policy

    folder = Path(shutil.copytree(_taught, tmp_path_factory.mktemp("played") / "data"))
    workspace = Workspace(folder)
    learnt, _ = load_policy(workspace.store, workspace.activity)
    with workspace.store.transaction():
        play(workspace.supervision(learnt, 1, asks=True))
        play(workspace.supervision(learnt, 2, asks=True, injections=FAULTS))
        play(workspace.supervision(learnt, 3, injections=("base-failed@5",)), expert=False)
    workspace.close()
    return folder


@pytest.fixture
def played(_played: Path, tmp_path: Path) -> Path:
    """A data folder with three games: one without faults, one with faults, and a stopped one."""
    return Path(shutil.copytree(_played, tmp_path / "played"))


@pytest.mark.slow
def test_the_list_has_every_game_in_order(tangy: Tangy, played: Path) -> None:
    done = tangy("log", "list", "--json", "--data", played)
    games = json.loads(done.stdout)
    assert (done.returncode, [game["number"] for game in games]) == (0, [1, 2, 3])
    assert [game["faults"] for game in games] == [
        {"critical": 0, "other": 0}, {"critical": 1, "other": 2}, {"critical": 1, "other": 0},
    ]  # fmt: skip
    assert [game["stopped"] is None for game in games] == [True, True, False]
    shown = tangy("log", "list", "--data", played).stdout
    assert tangy("log", "--data", played).stdout == shown
    before = tangy("log", "--json", "show", 1, "--data", played)
    assert before.stdout == tangy("log", "show", 1, "--json", "--data", played).stdout
    for game in games:
        assert game["id"][:6] in shown
    table = [line for line in shown.splitlines() if "`tangy " not in line]  # has the folder's name
    assert len(table) >= len(games) and all(len(line) <= 80 for line in table)


def test_staff_can_set_the_world_of_a_game(tangy: Tangy, played: Path) -> None:
    done = tangy("log", "world", 2, "bench", "--by", "Ada", "--data", played)
    assert (done.returncode, done.stdout) == (0, "Game 2 counts as a bench game.\n")
    games = json.loads(tangy("log", "list", "--json", "--data", played).stdout)
    assert [game["world"] for game in games] == ["simulated", "bench", "simulated"]
    wrong = tangy("log", "world", 2, "benhc", "--data", played)
    assert (wrong.returncode, "did you mean 'bench'?" in wrong.stderr) == (2, True)


def test_an_empty_folder_has_no_games(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("log", "list", "--data", tmp_path / "none")
    assert (done.returncode, "tangy play" in done.stdout) == (0, True)
    assert json.loads(tangy("log", "list", "--json", "--data", tmp_path / "none").stdout) == []
    assert not (tmp_path / "none").exists(), "who only reads makes nothing"
    for verb in ("show", "report"):
        done = tangy("log", verb, "last", "--data", tmp_path / "none")
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("number", [7, 1000, 12345])
def test_no_number_of_games_wraps_the_list(
    number: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    now = datetime(2026, 11, 21, 9, 0, tzinfo=UTC)
    game = Game(
        number, "feedfacefeed", 1, now, "bingo", "policy 12", "d" * 64, ("user1",),
        112, 3, 14, now, 9, "somebody said stop",
    )  # fmt: skip
    print_games([game], "")
    shown = capsys.readouterr().out.splitlines()
    (row,) = [line for line in shown if "feedfa" in line]
    for part in (
        str(number),
        "2026-11-21 ",
        "bingo",
        "policy ",
        " 112 ",
        "17, 3 critical",
        "stopp",
    ):
        assert part in row
    long = replace(game, policy="the one that was learnt after lunch", activity="a long name")
    print_games([long], "")
    shown = capsys.readouterr().out.splitlines()
    assert all(len(line) <= 80 for line in shown)
    assert any("17, 3 critical stopped" in line for line in shown)


def test_a_game_is_shown_step_by_step_with_its_faults(tangy: Tangy, played: Path) -> None:
    document = json.loads(tangy("log", "show", 2, "--json", "--data", played).stdout)
    kinds = [moment["kind"] for moment in document["moments"]]
    assert kinds.count("step") == document["steps"]
    assert kinds.count("fault") == len(document["fault_list"]) == 3
    lines = tangy("log", "show", 2, "--data", played).stdout.splitlines()
    halted = next(n for n, line in enumerate(lines) if "Laser scanner silent: halted" in line)
    steps = [line for line in lines[:halted] if re.match(r" *\d+:\d\d \d\d:\d\d:\d\d  [A-Z]", line)]
    assert len(steps) == 6, "the fault stands after the step after which it came"
    assert steps[0].endswith("  Greet everyone, because the game has not begun.")
    assert "->" not in "".join(lines)
    assert any("Tangy says: " in line for line in lines)
    assert any(" did it" in line or " would rather not" in line for line in lines)


@pytest.mark.slow
def test_a_report_in_json_has_all_of_its_parts(tangy: Tangy, played: Path) -> None:
    for game in ("2", "last", "all"):
        document = json.loads(tangy("log", "report", game, "--json", "--data", played).stdout)
        assert {"games", "rows", "faults", "fault_list", "people", "look_after"} <= set(document)
        assert [(row["criticality"], row["recovery"]) for row in document["faults"]] == list(ROWS)
        assert sum(row["instances"] for row in document["rows"]) == sum(
            game["steps"] for game in document["games"]
        )
    assert len(document["games"]) == 3
    assert len(document["fault_list"]) == 4


def test_a_report_is_a_page_or_a_few_lines(tangy: Tangy, played: Path, tmp_path: Path) -> None:
    page = tmp_path / "report.html"
    done = tangy("log", "report", "all", "--html", page, "--data", played)
    assert (done.returncode, done.stderr) == (0, "")
    assert page.read_text(encoding="utf-8").count('class="timeline"') == 3
    lines = tangy("log", "report", "--data", played).stdout
    assert "What to look after:" in lines
    assert "Wheels do not answer" in lines


def test_a_game_is_found_by_id_prefix_and_a_session_by_day(tangy: Tangy, played: Path) -> None:
    games = json.loads(tangy("log", "list", "--json", "--data", played).stdout)
    short = games[1]["id"][:8]
    found = json.loads(tangy("log", "show", short, "--json", "--data", played).stdout)
    assert found["id"] == games[1]["id"]
    done = tangy("log", "report", "2001-02-03", "--data", played)
    assert (done.returncode, "the nearest day with one is" in done.stderr) == (2, True)


@pytest.mark.parametrize("wrong", ["7", "nosuch", "al", "", "\x1b[2J", "0"])
def test_an_unknown_game_is_refused_in_one_sentence(tangy: Tangy, played: Path, wrong: str) -> None:
    for verb in ("show", "report"):
        done = tangy("log", verb, wrong, "--data", played)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr.count("\n") == 1
        assert done.stderr.strip().isprintable()


def test_an_impossible_page_path_is_refused_first(
    tangy: Tangy, played: Path, tmp_path: Path
) -> None:
    for place in (tmp_path, tmp_path / "none" / "report.html"):
        done = tangy("log", "report", "nosuch", "--html", place, "--data", played)
        assert done.returncode == 2
        assert done.stderr.startswith(f"tangy: --html {place}: ")


def test_a_game_of_a_missing_activity_is_listed(tangy: Tangy, tmp_path: Path, played: Path) -> None:
    with Store.open(played) as store:
        begun = next(store.events("game begun")).body
        append_body(store, "game begun", {**begun, "game": "feedfacefeed", "activity": "whist"})
    assert "whist" in tangy("log", "list", "--data", played).stdout
    done = tangy("log", "show", "last", "--data", played)
    missing = "Tangy cannot find the file of the activity 'whist': name it with --activity."
    assert (done.returncode, missing in done.stderr) == (0, True)
    assert missing in tangy("log", "report", "--data", played).stdout
    other = Path(__file__).parent.parent / "lanterns.toml"
    done = tangy("log", "report", "--activity", other, "--data", played)
    assert (done.returncode, "played was whist" in done.stderr) == (2, True)


def test_a_game_of_an_activity_file_is_shown_in_its_words(tangy: Tangy, tmp_path: Path) -> None:
    data, shipped = tmp_path / "data", shipped_activities()["memory"]
    own = tmp_path / "mine.toml"
    own.write_text(shipped.read_text().replace('name = "memory"', 'name = "mine"'))
    shutil.copy(shipped.with_suffix(".csv"), tmp_path)
    file = ("--activity", own, "--data", data)
    tangy("teach", "--teacher", "scripted", "--guided", "--users", 1, *file)
    tangy("learn", *file)
    tangy("play", "--games", 1, "--headless", "--users", 1, *file)
    done = tangy("log", "show", "last", "--data", data)
    assert ("cannot find" in done.stderr, "Let us find the pairs" in done.stdout) == (False, True)
    own.unlink()
    assert "cannot find the file" in tangy("log", "show", "last", "--data", data).stderr


def test_reports_use_the_current_names(tangy: Tangy, played: Path) -> None:
    tangy("people", "rename", "user1", "Rosa", "--data", played)
    document = json.loads(tangy("log", "report", "all", "--json", "--data", played).stdout)
    assert document["people"][0]["name"] == "Rosa"
    assert "Took part: Rosa, " in tangy("log", "report", "--data", played).stdout
