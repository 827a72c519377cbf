"""The teacher's profile: the name is asked once, stored in the data folder, and used later."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.app.teacher_profile import (
    TeacherProfile,
    change_name,
    change_theme,
    login_name,
    read_profile,
    save_profile,
    teacher_name,
)
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.who import ask_who


def ask(folder: Path, *typed: str) -> tuple[str, list[str]]:
    """Ask by lines, and return the name and the output."""
    lines = iter(typed)
    said: list[str] = []
    return ask_who(folder, lambda: next(lines, None), said.append)[0], said


def test_the_name_is_asked_once_and_stored(tmp_path: Path) -> None:
    name, said = ask(tmp_path, "Ada\n")
    assert name == "Ada"
    assert said
    assert ask(tmp_path) == ("Ada", [])
    with closing(Workspace(tmp_path)) as workspace:
        assert workspace.teacher == "Ada"


def test_enter_alone_takes_the_login_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("USER", "rosa")
    assert ask(tmp_path, "\n")[0] == login_name()
    assert read_profile(tmp_path).name == login_name()


def test_a_name_must_be_typed_without_a_login_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("USER", raising=False)
    monkeypatch.delenv("USERNAME", raising=False)
    assert ask(tmp_path, "\n", " \n", "Ada\n")[0] == "Ada"


def test_an_invalid_name_is_asked_again(tmp_path: Path) -> None:
    name, said = ask(tmp_path, "x" * 500, "Bea")
    assert name == "Bea"
    assert len(said) > 2


def test_no_answer_stores_no_name(tmp_path: Path) -> None:
    assert ask(tmp_path)[0] == login_name()
    assert not read_profile(tmp_path).name


def test_a_given_name_overrides_the_stored_one(tmp_path: Path) -> None:
    save_profile(tmp_path, TeacherProfile('Zoë "Z" \\ O'))
    assert teacher_name(None, tmp_path) == 'Zoë "Z" \\ O'
    assert teacher_name("Bea", tmp_path) == "Bea"


def test_a_file_with_a_mistake_is_refused(tmp_path: Path) -> None:
    (tmp_path / "teacher.toml").write_text("name = 3\n")
    with pytest.raises(TangyError):
        read_profile(tmp_path)


def test_a_theme_is_stored_beside_the_name(tmp_path: Path) -> None:
    change_theme(tmp_path, "tangy-light")
    assert change_name(tmp_path, "Ada") == "Ada"
    assert read_profile(tmp_path) == TeacherProfile("Ada", "tangy-light")
