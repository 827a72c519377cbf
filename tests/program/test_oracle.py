"""The recorder for refactorings: how it normalises and compares."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

from tests.oracle.comparing import differences
from tests.oracle.normal import Names


def _recorded(folder: Path, name: str, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")
    return folder


def test_runs_that_differ_only_in_ids_and_times_are_recorded_alike() -> None:
    def run(first: str, second: str, at: str) -> str:
        return Names().document(f'{{"a": "{first}", "b": ["{second}", "{first}"], "at": "{at}"}}')

    one = run(str(uuid4()), "0123456789ab", "2026-01-01T10:00:00.5+00:00")
    two = run(str(uuid4()), "ba9876543210", "2025-02-03T11:22:33.0+00:00")
    assert one == two


def test_an_id_at_another_place_is_a_difference() -> None:
    ids = [str(uuid4()) for _ in range(2)]
    assert Names().text(" ".join([*ids, ids[0]])) != Names().text(" ".join([*ids, ids[1]]))


def test_digests_numbers_and_words_are_never_hidden() -> None:
    kept = f"digest {'0f' * 32}, 19 responses, share 0.25, call number"
    assert Names().text(kept) == kept


def test_every_different_or_missing_file_is_named(tmp_path: Path) -> None:
    before, after = tmp_path / "before", tmp_path / "after"
    for name, old, new in (("same", "x", "x"), ("changed", "one\ntwo", "one\n2")):
        _recorded(before, f"{name}.txt", old)
        _recorded(after, f"{name}.txt", new)
    _recorded(before, "gone.txt", "")
    found = differences(before, after)
    assert [line.split(":")[0].splitlines()[0] for line in found] == ["changed.txt", "gone.txt"]
    assert "-two" in found[0]
    assert "+2" in found[0]
