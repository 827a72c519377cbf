"""The chosen activity of a data folder is the default of its workspaces."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.app.chosen_activity import FILE, choose_activity, chosen_activity
from tangy_tui.app.workspace import Workspace
from tests.support.declared import declared


def test_the_chosen_activity_is_stored(tmp_path: Path) -> None:
    first = Workspace(tmp_path)
    usual = first.activity.name
    first.change_activity("trivia")
    assert first.activity.name == "trivia"
    first.close()
    again = Workspace(tmp_path)
    assert again.activity.name == "trivia"
    again.close()
    named = Workspace(tmp_path, activity=usual)
    assert named.activity.name == usual and chosen_activity(tmp_path) == "trivia"
    named.close()


def test_a_change_of_activity_switches_between_people_and_teams(tmp_path: Path) -> None:
    workspace = Workspace(tmp_path, users=3)
    people = [person.id for person in workspace.people]
    workspace.change_activity("team-trivia")
    assert tuple(person.id for person in workspace.people) == declared("team-trivia").teams
    workspace.change_activity("trivia")
    assert [person.id for person in workspace.people] == people
    workspace.close()


def test_a_chosen_file_is_found_from_any_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "own.toml"
    own.write_text((Path(__file__).parents[1] / "lanterns.toml").read_text("utf-8"), "utf-8")
    monkeypatch.chdir(tmp_path)
    assert choose_activity(tmp_path, "own.toml") == str(own)
    assert chosen_activity(tmp_path) == str(own)


def test_an_unknown_activity_is_not_stored(tmp_path: Path) -> None:
    with pytest.raises(TangyError):
        choose_activity(tmp_path, "chess boxing")
    assert not (tmp_path / FILE).exists()
