"""Commands that an answer names carry the options of the present call."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

from tangy_tui.text.follow_up import follow_up

Tangy = Callable[..., "CompletedProcess[str]"]


def test_a_follow_up_command_has_the_options_of_the_call() -> None:
    said = follow_up("Then `tangy learn`.", activity="my file.toml", data="/a b")
    assert said == "Then `tangy learn --activity 'my file.toml' --data '/a b'`."
    assert follow_up("Then `tangy learn`.") == "Then `tangy learn`."


def test_an_option_that_the_message_names_is_not_added_again() -> None:
    said = "`tangy learn --activity a --data b`"
    assert follow_up(said, activity="c", data="d") == said


def test_a_follow_up_command_has_only_options_that_it_knows() -> None:
    said = follow_up("See `tangy report session 1`, `tangy doctor`.", activity="a", data="d")
    assert said == "See `tangy report session 1 --data d`, `tangy doctor`."


def test_unfinished_demonstrations_stay_in_the_call_where_they_count() -> None:
    named = "`tangy demonstrations resolve 1 --right BEHAVIOUR`, then `tangy play`"
    said = follow_up(named, unfinished=True)
    assert said == (
        "`tangy demonstrations resolve 1 --right BEHAVIOUR --unfinished`, then `tangy play`"
    )


def test_learning_leads_to_the_conflicts_of_the_same_activity(tangy: Tangy, tmp_path: Path) -> None:
    at = ("--activity", "trivia", "--data", tmp_path / "d d")
    script = tmp_path / "lines"
    for first in ("welcome everyone", "tell scores"):
        script.write_text(f"{first}\ny\nquit\n")
        tangy("teach", "--teacher", "Ada", "--script", script, "--new", *at)
    options = f"--activity trivia --data '{tmp_path}/d d'"
    learnt = tangy("learn", "--unfinished", *at).stdout
    assert f"`tangy demonstrations conflicts --unfinished {options}`" in learnt
    shown = tangy("demonstrations", "conflicts", "--unfinished", *at).stdout
    assert shown.startswith("Conflict 1.")
    assert f"--right BEHAVIOUR --unfinished {options}`" in shown
    agreed = tangy("demonstrations", "conflicts", *at).stdout
    assert agreed == "Trivia: the demonstrations agree in every situation.\n"
    refused = tangy("learn", *at).stderr
    assert f"`tangy teach {options}`" in refused


def test_the_scripted_teacher_counts_what_others_have_shown(tangy: Tangy, tmp_path: Path) -> None:
    at = ("--activity", "memory", "--data", tmp_path / "d", "--teacher", "scripted")
    first = tangy("teach", *at, "--seed", "1").stdout
    assert first.startswith("Demonstration 1 ")
    second = tangy("teach", *at, "--seed", "2").stdout
    learnt = tangy("learn", *at[:4]).stdout
    assert second.startswith("Demonstration 2 ")
    shown = learnt.partition(": ")[2].partition(" situations")[0]
    assert f"; {shown} situations were shown so far." in second


def test_a_new_activity_takes_the_data_folder_along(tangy: Tangy, tmp_path: Path) -> None:
    new = ("activity", "new", tmp_path, "--title", "Our game", "--kind", "game", "--yes")
    done = tangy(*new, "--data", tmp_path / "d")
    assert f"tangy learn --activity {tmp_path}/our-game.toml --data {tmp_path}/d\n" in done.stdout
    before = tangy("--data", tmp_path / "d", *new[:2], tmp_path / "2", *new[3:])
    assert f"--data {tmp_path}/d\n" in before.stdout


def test_checking_a_file_accepts_a_data_folder(tangy: Tangy, tmp_path: Path) -> None:
    done = tangy("activity", "check", "nothing-there", "--data", tmp_path)
    assert done.stderr.startswith("There is no activity 'nothing-there'")


def test_an_option_that_a_command_has_is_not_added_again() -> None:
    named = "`tangy policy show --activity trivia`"
    assert follow_up(named, activity="my quiz.toml") == named


def test_a_broken_choice_of_the_activity_spoils_no_call_that_names_one(
    tangy: Tangy, tmp_path: Path
) -> None:
    folder = tmp_path / "data"
    folder.mkdir()
    (folder / "activity.toml").write_text("activity = [")
    done = tangy("learn", "--activity", "trivia", "--data", folder)
    assert "demonstrate a game first" in done.stderr, done.stderr
