"""Reading TOML key by key: each key gives a value, or one sentence about the mistake."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.reading import Table, did_you_mean, nearest, plain, read_toml

values: st.SearchStrategy[Any] = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=8,
)
READERS: dict[str, Callable[[Table, str], object]] = {
    "text": lambda table, key: table.text(key),
    "flag": lambda table, key: table.flag(key),
    "number": lambda table, key: table.number(key, -5, 5),
    "number of any size": lambda table, key: table.number(key),
    "whole": lambda table, key: table.whole(key, -5, 5),
    "numbers": lambda table, key: table.numbers(key, 2, -5, 5),
    "words": lambda table, key: table.words(key),
    "known words": lambda table, key: table.words(key, ["one", "two"]),
    "choice": lambda table, key: table.choice(key, ["one", "two"]),
    "table": lambda table, key: table.table(key),
    "tables": lambda table, key: [list(t) for t in table.tables(key)],
    "items": lambda table, _: dict(table.items()),
    "close": lambda table, _: table.close(),
}


@pytest.mark.parametrize("reader", READERS)
@given(values, st.text())
def test_any_value_under_any_key_is_taken_or_refused_in_one_printable_line(
    reader: str, value: Any, key: str
) -> None:
    table = Table({key: value}, "mine.toml", "here.")
    try:
        READERS[reader](table, key)
    except ProfileError as error:
        assert str(error).startswith("mine.toml: here.")
        assert len(str(error)) < 800
        assert plain(str(error)) == str(error)
        assert "\n" not in str(error)


@given(st.text())
def test_printable_text_is_returned_unchanged(value: str) -> None:
    table = Table({"key": value}, "mine.toml")
    if value.strip() and plain(value) == value:
        assert table.text("key") == value
    else:
        with pytest.raises(ProfileError):
            table.text("key")


@given(st.floats() | st.integers(), st.floats(-9, 9), st.floats(-9, 9))
def test_a_number_is_finite_and_within_its_range(value: float, low: float, high: float) -> None:
    table = Table({"key": value}, "mine.toml")
    if low <= value <= high:
        assert table.number("key", low, high) == value
    else:
        with pytest.raises(ProfileError, match="must be a number from"):
            table.number("key", low, high)


def test_absent_keys_take_their_default_or_are_reported() -> None:
    table = Table({}, "mine.toml")
    assert table.text("a", "") == ""
    assert table.flag("a", False) is False
    assert table.number("a", default=2) == 2
    assert table.whole("a", 1, 3, 2) == 2
    assert table.words("a", default=()) == ()
    assert table.choice("a", ["x"], "y") == "y"
    assert list(table.table("a", optional=True)) == []
    assert not list(table.tables("b", optional=True))
    for reader in ("text", "flag", "number", "whole", "numbers", "words", "table", "choice"):
        with pytest.raises(ProfileError, match=r"^mine\.toml: a: is missing; it must be "):
            READERS[reader](table, "a")


def test_an_unknown_key_is_refused_with_a_suggestion() -> None:
    table = Table({"name": "x", "tilte": "y"}, "mine.toml")
    table.text("name")
    table.text("title", "")
    with pytest.raises(ProfileError, match="tilte = 'y': is not a key here; did you mean 'title'"):
        table.close()
    other = Table({"tilte": "y"}, "mine.toml")
    with pytest.raises(ProfileError, match="did you mean 'tilt'"):
        other.close(also=["tilt"])


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("b = [{ c = 1, }]", "look for a comma too many before it"),
        ("b = [{ c = 1,\n d = 2 }]", "{...} that goes on in the next line"),
        ("b = [1\nc = 2", "a comma or ] is missing before this (at line 3, column 1)"),
        ('b = ["Number {n}: "{begin}" ..."]', 'write a quotation mark inside a text as \\"'),
        ("[b.wait now]", 'a name of several words needs quotation marks, as in [behaviours."give'),
        ("b = { c = 1 d = 2 }", "a comma or } is missing before this"),
        ("b = { c: 1 }", "after a key = is missing"),
        ('b = "open', "this text has no quotation mark at its end (at line 2, column 10)"),
        ("b = open", "a text needs quotation marks around it (at line 2, column 5)"),
    ],
)
def test_the_commonest_mistakes_of_toml_are_named(tmp_path: Path, line: str, told: str) -> None:
    file = tmp_path / "a.toml"
    file.write_text(f"a = 1\n{line}\nc = 2\n", encoding="utf-8")
    with pytest.raises(ProfileError) as raised:
        read_toml(file)
    assert told in str(raised.value)


def test_the_nearest_word_or_all_words_are_suggested() -> None:
    assert nearest("jok", ["joke", "greeting"]) == "did you mean 'joke'?"
    assert nearest("zzz", ["joke", "greeting"]) == "choose one of: greeting, joke."
    assert nearest("tiems", ["items", "teams", "title"]) == "did you mean 'items'?"
    assert nearest("signing", ["sees", "singing", "sings"]) == "did you mean 'singing'?"
    assert nearest("zzz", []) == "there is none to choose from."


def test_a_word_that_is_like_no_other_has_no_suggestion() -> None:
    assert did_you_mean("jok", ["joke", "greeting"]) == "did you mean 'joke'?"
    assert not did_you_mean("zzz", ["joke", "greeting"])


def test_equally_near_words_are_suggested_unless_already_used() -> None:
    assert nearest("tems", ["items", "teams"]) == "did you mean 'items' or 'teams'?"
    assert nearest("tems", ["items", "teams"], ["teams"]) == "did you mean 'items'?"
    assert nearest("tems", ["items", "teams"], ["items"]) == "did you mean 'teams'?"
    assert nearest("tiems", ["items", "teams"], ["items"]) == "did you mean 'teams'?"
    assert nearest("teamss", ["items", "teams"], ["teams"]) == "did you mean 'teams'?"


@given(st.text(st.characters(exclude_categories=())))
def test_plain_text_has_no_control_characters(text: str) -> None:
    shown = plain(text)
    assert len(shown) == len(text)
    assert plain(shown) == shown
    assert shown.encode().decode() == shown
    for char in "\x00\x07\x08\x1b\r\n\t\x7f\x9b\x9d\u200b\u202e\u2066\ufeff\ud800\udcff":
        assert char not in shown
    assert all(a in (b, "\N{REPLACEMENT CHARACTER}") for a, b in zip(shown, text, strict=True))


@given(st.binary(max_size=200))
def test_any_bytes_are_a_table_or_refused_in_one_line(
    tmp_path_factory: pytest.TempPathFactory, content: bytes
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.toml"
    path.write_bytes(content)
    try:
        read_toml(path)
    except ProfileError as error:
        assert str(error).startswith("any.toml: ")
        assert plain(str(error)) == str(error)


def test_the_name_of_a_broken_file_cannot_act_on_the_terminal(tmp_path: Path) -> None:
    for content in (b"\xff", b"=", b"x = " + b"[" * 9999, b"#" * 1_000_001, b"x = 1" + b"0" * 5000):
        path = tmp_path / "a\x1b[2J.toml"
        path.write_bytes(content)
        with pytest.raises(ProfileError) as caught:
            read_toml(path)
        assert str(caught.value).isprintable()


def test_profile_errors_are_user_errors() -> None:
    assert issubclass(ProfileError, TangyError)
