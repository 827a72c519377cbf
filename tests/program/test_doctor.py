"""What is said of the parts of a machine: those that work, are missing, or are broken."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tangy_profiles.store import Store
from tangy_tui.doctor import Finding, examine


def data_folder(folder: Path) -> Finding:
    """Return what is found of a data folder."""
    return next(f for f in examine(folder, lambda _: None) if f.part == "data folder")


def test_a_program_that_is_not_installed_is_missing_and_not_broken(tmp_path: Path) -> None:
    states = {f.part: f.state for f in examine(tmp_path, lambda _: None)}
    assert (states["voice"], states["microphone"]) == ("missing", "missing")
    assert {f.state for f in examine(tmp_path, str) if f.part in ("voice", "microphone")} == {"ok"}


def test_a_folder_that_is_sound_or_can_be_made_is_ok(tmp_path: Path) -> None:
    Store.open(tmp_path).close()
    assert data_folder(tmp_path) == Finding("data folder", True, f"{tmp_path} is sound.")
    new = tmp_path / "a" / "b"
    found = data_folder(new)
    assert found.state == "ok"
    assert "is made as soon as there is something to keep" in found.text
    assert not new.exists(), "looking makes nothing"


def test_a_damaged_log_is_broken(tmp_path: Path) -> None:
    (tmp_path / "tangy.db").write_bytes(b"no log at all" * 1000)
    found = data_folder(tmp_path)
    assert (found.ok, found.state) == (False, "broken")
    assert "tangy.db" in found.text


def test_what_is_no_folder_is_broken(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    for path, why in ((file, "is no folder"), (file / "in" / "it", "cannot be made, for ")):
        found = data_folder(path)
        assert found.state == "broken"
        assert why in found.text
        assert found.text.endswith("choose another folder with --data.")


def test_a_folder_that_may_not_be_written_to_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path)
    for path in (tmp_path, tmp_path / "new" / "one"):
        found = data_folder(path)
        assert found.state == "broken"
        assert "cannot be written to" in found.text
    assert not (tmp_path / "new").exists()


def test_a_folder_that_may_not_be_looked_into_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exists = Path.exists

    def barred(path: Path) -> bool:
        if tmp_path in path.parents:
            raise PermissionError
        return exists(path)

    monkeypatch.setattr(Path, "exists", barred)
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert data_folder(tmp_path / "new").state == "broken"
