"""User settings in the data folder; mistakes are reported with their place."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.errors import ProfileError
from tangy_tui.app.user_settings import UserSettings, read_settings


def test_a_missing_file_gives_the_defaults(tmp_path: Path) -> None:
    assert read_settings(tmp_path) == UserSettings(question="auto")


@pytest.mark.parametrize("question", ["auto", "y", "digit"])
def test_the_yes_key_of_questions_can_be_set(tmp_path: Path, question: str) -> None:
    (tmp_path / "settings.toml").write_text(f'question = "{question}"\n')
    assert read_settings(tmp_path).question == question


@pytest.mark.parametrize(("wanted", "link"), [("", "fast"), ("slow", "slow"), ("x", "fast")])
def test_the_speed_of_the_link_is_set_in_the_file_or_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wanted: str, link: str
) -> None:
    monkeypatch.setenv("TANGY_LINK", wanted)
    (tmp_path / "settings.toml").write_text('link = "fast"\n')
    assert read_settings(tmp_path).link == link


@pytest.mark.parametrize(
    ("written", "told"),
    [
        ('question = "n"', "settings.toml: question"),
        ("question = 1", "settings.toml: question"),
        ('qestion = "y"', "settings.toml: qestion"),
        ("question", "is not TOML"),
    ],
)
def test_a_mistake_is_reported_with_its_place(tmp_path: Path, written: str, told: str) -> None:
    (tmp_path / "settings.toml").write_text(written)
    with pytest.raises(ProfileError, match=told):
        read_settings(tmp_path)
