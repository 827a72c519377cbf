"""Converting an activity's file of version 0.6.0 adds the new keys and keeps its games."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.activity import Activity, read_activity, shipped_activities
from tangy_profiles.errors import ProfileError
from tangy_profiles.person import load_people
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_tui.app.activity_conversion import OPTIONAL, converted
from tangy_tui.language.activity_check import check_activity
from tangy_tui.text.activity_conversion import CAN_ADD, COMMENTS

Tangy = Callable[..., CompletedProcess[str]]
OLD = Path(__file__).parents[1] / "lanterns.toml"
"""A file of version 0.6.0, of a game with other words than the shipped one."""
TEXT = OLD.read_text(encoding="utf-8")


def put(folder: Path, text: str) -> Path:
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def as_before(activity: Activity) -> Activity:
    """Leave out the activity's path, and whether its file names the defaults."""
    asking = replace(activity.asking, named=False)
    return replace(activity, source="", names_pressing=False, asking=asking)


@pytest.mark.parametrize("more", ["", "asks_in_visit = 8\n", "asks_in_game = 9\n"])
def test_a_converted_file_gives_the_same_activity_with_explicit_defaults(
    more: str, tmp_path: Path
) -> None:
    file = put(tmp_path, more + TEXT)
    before, found = read_activity(file), converted(file, COMMENTS)
    assert set(found.text.split("\n")) > set(file.read_text(encoding="utf-8").split("\n"))
    assert found.lacks == OPTIONAL
    after = read_activity(put(tmp_path, found.text))
    assert as_before(after) == as_before(before)
    people = load_room().placed(load_people(4))
    assert check_activity(before, load_robot(), people).warnings
    assert not check_activity(after, load_robot(), people).warnings
    assert not converted(put(tmp_path, found.text), COMMENTS).added


def test_a_new_file_that_could_not_be_opened_is_not_written(tangy: Tangy, tmp_path: Path) -> None:
    file = put(tmp_path, TEXT)
    done = tangy("activity", "convert", str(file), "--to", str(tmp_path / "out.txt"))
    assert done.returncode == 2
    assert "must end in .toml" in done.stderr
    assert not (tmp_path / "out.txt").exists()


def test_a_file_saved_with_a_byte_order_mark_is_the_same_activity(tmp_path: Path) -> None:
    plain = read_activity(put(tmp_path, TEXT))
    marked = read_activity(put(tmp_path, "\ufeff" + TEXT))
    assert marked == plain


@pytest.mark.parametrize("ending", ["", "\n"])
def test_omitted_keys_keep_their_meaning(ending: str, tmp_path: Path) -> None:
    shipped = Path(shipped_activities()["bingo"]).read_text(encoding="utf-8")
    new = ("pressing_strategies", "asks_in_visit", "asks_in_game")
    text = "\n".join(line for line in shipped.split("\n") if not line.startswith(new))
    plain = re.search(r'plain_strategy = "(\w+)"', text)
    assert plain is not None
    several = text.replace(plain[0], f'plain_strategy = """{ending}{plain[1]}"""')
    file = put(tmp_path, several)
    before, found = read_activity(file), converted(file, COMMENTS)
    assert found.added == new
    after = read_activity(put(tmp_path, found.text))
    assert before.pressing and as_before(after) == as_before(before)


def test_every_convertible_key_has_a_comment(tmp_path: Path) -> None:
    assert set(converted(put(tmp_path, TEXT), COMMENTS).added) == set(COMMENTS)
    assert tuple(CAN_ADD) == OPTIONAL


@pytest.mark.parametrize("name", shipped_activities())
def test_shipped_activities_need_no_conversion(name: str) -> None:
    found = converted(shipped_activities()[name], COMMENTS)
    assert (found.added, found.lacks) == ((), ())


def test_a_mistake_is_refused_with_its_line(tmp_path: Path) -> None:
    wrong = TEXT.replace('effect = "draw"', 'effect = "drow"', 1)
    line = wrong[: wrong.index("drow")].count("\n") + 1
    with pytest.raises(ProfileError, match=rf"\(line {line}\).*did you mean 'draw'"):
        converted(put(tmp_path, wrong), COMMENTS)


@pytest.mark.slow  # five programs
def test_the_verb_writes_a_new_file_and_overwrites_none(tangy: Tangy, tmp_path: Path) -> None:
    file = put(tmp_path, TEXT)
    done = tangy("activity", "convert", file)
    assert (done.returncode, done.stderr) == (0, "")
    new = tmp_path / "mine-new.toml"
    assert file.read_text(encoding="utf-8") == TEXT
    assert f"Written: {new}" in done.stdout
    written = new.read_text(encoding="utf-8")
    again = tangy("activity", "convert", file)
    assert again.returncode == 2 and "--to" in again.stderr
    assert new.read_text(encoding="utf-8") == written
    assert "nothing is written" in tangy("activity", "convert", new, "--to", file).stdout
    assert file.read_text(encoding="utf-8") == TEXT
    assert "up to date" in tangy("activity", "convert", shipped_activities()["trivia"]).stdout
    (tmp_path / "garden.txt").write_text("What is green?\nA. Grass\nB. Milk\nANSWER: A\n")
    told = tangy("activity", "convert", tmp_path / "garden.txt")
    assert told.returncode == 2 and "tangy activity import" in told.stderr
