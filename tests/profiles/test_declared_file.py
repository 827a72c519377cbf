"""Reading an activity declared by facts; each mistake is reported with its place."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import read_activity, shipped_activities
from tangy_profiles.declared.items import EmptyCell, empty_cells, read_csv
from tangy_profiles.declared.reader import read_declaration
from tangy_profiles.declared.source import MistakesError, SourceText
from tangy_profiles.declared.table_text import ReadAs
from tangy_profiles.errors import ProfileError
from tests.support.declared import DECLARED
from tests.support.laws import tried

SHIPPED = shipped_activities()["trivia"]
FOLDER = SHIPPED.parent
TEXT = SHIPPED.read_text(encoding="utf-8")
TOKENS = [match.span() for match in re.finditer(r"[a-z_]{3,}", TEXT)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(SHIPPED.with_suffix(".csv"), tmp_path / "trivia.csv")
    return tmp_path


def mistakes(folder: Path, *changes: tuple[str, str], text: str = TEXT) -> tuple[str, ...]:
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(MistakesError) as caught:
        read_declaration(path)
    return caught.value.lines


def place(text: str, wanted: str) -> str:
    before = text[: text.index(wanted)]
    return f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"


def test_all_mistakes_are_reported_at_once_with_place_and_suggestion(folder: Path) -> None:
    changes = (
        ('about = "first asking"', 'about = "frst asking"'),
        ('"set told yes"', '"set told yess"'),
        ("chance = 0.4", "chanse = 0.4"),
        ('checks = "right"', 'checks = "rigt"'),
    )
    text = TEXT
    for old, new in changes:
        text = text.replace(old, new)
    found = mistakes(folder, *changes)
    near = {"'first asking'": "frst", "'yes'": "set told yess", "'chance'": "chanse"}
    near["'right'"] = '"rigt"'
    for word, wrong in near.items():
        (line,) = (line for line in found if f"did you mean {word}?" in line)
        # a place points at a key, or into the wrong value
        row = place(text, wrong).partition(":")[0]
        assert line.startswith(f"mine.toml:{row}:")
    assert len(found) == len(changes)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('next question" },', 'next question", when = ["open is no"] },', "the last stage"),
        ('does = ["finish"]', "does = []", "'finish'"),
        ("{hint}", "{hunt}", "{hunt}"),
        ("repeat question -> first asking", "repeat question -> quietest", "among its 'to'"),
        ('"set open no", "next turn"', '"invite open"', "needs a value"),
        ('sees = ["clock", "hinted"]', 'sees = ["score"]', "bands"),
        ('when = ["items is over"]', 'when = ["any items is over"]', "each player"),
        ('to = "whose turn"', 'to = "whose trun"', "'whose turn'"),
        ('"add score"', '"add scores"', "'score'"),
        ('"start clock"', '"start score"', "timer"),
        ('file = "trivia.csv"', 'file = "../trivia.csv"', "beside"),
        ("rounds = 6", "rounds = 600", "from 1 to 40"),
        ("words = { answer", "words = { anwser", "'answer'"),
        ('["no hint yet", "after a hint"]', '["no hint yet"]', "2 texts: for no, yes"),
        ("{name} gave an answer", "{nmae} gave an answer", "{name}"),
    ],
)
def test_impossible_declarations_are_refused_by_name(
    folder: Path, old: str, new: str, told: str
) -> None:
    assert any(told in line for line in mistakes(folder, (old, new)))


@pytest.mark.parametrize(
    ("right", "wrong", "key"),
    [
        ('[behaviours."give hint"]', '[behaviours."give hnit"]', "behaviours"),
        ('{ name = "listen", words', '{ name = "lisetn", words', "stages[4].name"),
    ],
)
def test_a_misspelt_name_is_reported_once_at_its_definition(
    folder: Path, right: str, wrong: str, key: str
) -> None:
    names = [re.findall(r'"([^"]*)"', one)[0] for one in (right, wrong)]
    first, *rest = mistakes(folder, (right, wrong))
    row = place(TEXT.replace(right, wrong), wrong).partition(":")[0]
    assert first.startswith(f"mine.toml:{row}:")
    assert key in first
    assert all(f"'{name}'" in first for name in names)
    assert not any("expected:" in line for line in rest)


def test_a_mistake_that_causes_others_comes_first(folder: Path) -> None:
    first, *_ = mistakes(folder, ("[behaviours.", "[behavours."))
    row = place(TEXT.replace("[behaviours.", "[behavours."), "[behavours.").partition(":")[0]
    assert first.startswith(f"mine.toml:{row}:")
    assert "'behaviours'" in first


def test_an_activity_without_a_name_is_named_after_its_file(folder: Path) -> None:
    named = re.search(r"(?m)^name = .*\n", TEXT)
    assert named is not None
    path = folder / "garden-quiz.toml"
    path.write_text(TEXT.replace(named[0], ""), encoding="utf-8")
    assert read_declaration(path).name == "garden-quiz"


@pytest.mark.parametrize("name", DECLARED)
def test_shipped_declarations_have_at_most_80_lines(name: str) -> None:
    assert shipped_activities()[name].read_text(encoding="utf-8").count("\n") <= 80


def first_right(folder: Path, right: str, third: str = "Venus") -> str:
    """Write the right answer of the first item, with Saturn's letter or words, into the file."""
    lines = (folder / "trivia.csv").read_text(encoding="utf-8").splitlines()
    lines[1] = f"Which planet has rings?,Mars,Saturn,{third},{right},It has rings."
    (folder / "trivia.csv").write_text("\n".join(lines), encoding="utf-8")
    shutil.copy(SHIPPED, folder / "mine.toml")
    return read_declaration(folder / "mine.toml").items.value(0, "right")


@pytest.mark.parametrize("right", ["Saturn", "saturn", "b", "B", "b|the one with rings"])
def test_a_right_answer_is_given_by_words_or_letter(folder: Path, right: str) -> None:
    assert first_right(folder, right).casefold().partition("|")[0] == "saturn"


@pytest.mark.parametrize("right", ["d", "", "c"])
def test_a_right_answer_outside_the_options_is_a_mistake(folder: Path, right: str) -> None:
    with pytest.raises(MistakesError) as caught:
        first_right(folder, right, third="")  # the letter of an option without words is no answer
    (line,) = caught.value.lines
    assert f"row 2: right {right!r} is none of its options" in line


def test_a_byte_order_mark_and_blank_lines_are_ignored(folder: Path) -> None:
    items = (folder / "trivia.csv").read_text(encoding="utf-8")
    (folder / "trivia.csv").write_text("\ufeff" + items + "\n,,,,,\n", encoding="utf-8")
    (folder / "mine.toml").write_text(TEXT, encoding="utf-8")
    assert read_declaration(folder / "mine.toml").items == read_declaration(SHIPPED).items


@pytest.mark.parametrize(
    ("encoding", "separator", "windows"),
    [
        ("utf-8", ";", False), ("cp1252", ",", True), ("cp1252", ";", True),
        ("utf-8-sig", "\t", False), ("utf-16", "\t", False),
    ],
)  # fmt: skip
def test_a_table_is_read_as_spreadsheets_save_it(
    folder: Path, encoding: str, separator: str, windows: bool
) -> None:
    rows = [["ask", "right"], ["Was blüht, im Mai?", "Flieder; auch Mohn"], ["Wo?", "Hier"]]
    quoted = [separator.join(f'"{cell}"' for cell in row) for row in rows[1:]]
    lines = [separator.join(rows[0]), *quoted]
    (folder / "t.csv").write_bytes("\r\n".join(lines).encode(encoding))
    source = SourceText("a.toml", "")
    assert read_csv(source, ("items",), folder / "t.csv") == rows
    assert source.tables == [ReadAs("t.csv", windows, separator)]


@pytest.mark.parametrize(
    "table",
    [
        "ask;right\nWhere, when?;Here",
        "sep=;\r\nask;right\r\nWhere, when?;Here\r\n",
        "\n\nask;right\n\nWhere, when?;Here\n;\n",
        'ask,right\r"Where, when?",Here\r',
        "ask;right;;\nWhere, when?;Here;;\n;;;\n",
        'ask,right\r\n"Where,\nwhen?",Here\r\n',
        'ask,right\r\n"Where,\r\nwhen?",Here\r\n',
    ],
    ids=[
        *("no end", "sep", "blank lines", "old ends", "empty columns", "a line break in a cell"),
        "a Windows line break in a cell",
    ],
)
def test_what_spreadsheets_add_to_a_table_is_no_part_of_it(folder: Path, table: str) -> None:
    (folder / "t.csv").write_bytes(table.encode())
    rows = read_csv(SourceText("a.toml", ""), ("items",), folder / "t.csv")
    assert rows == [["ask", "right"], ["Where, when?", "Here"]]


def test_only_columns_that_are_empty_throughout_are_left_out(folder: Path) -> None:
    (folder / "t.csv").write_text("ask,right,\nWhere?,Here,\nWhen?,Now,late\n")
    source = SourceText("a.toml", "")
    assert read_csv(source, ("items",), folder / "t.csv") == []
    (folder / "t.csv").write_text("ask,right,hint\nWhere?,Here,\n")
    rows = read_csv(source, ("items",), folder / "t.csv")
    assert rows == [["ask", "right", "hint"], ["Where?", "Here", ""]]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"PK\x03\x04\0\0", "save it as CSV UTF-8"),
        (b"ask,right\nWhat?,\x81", "save it as CSV UTF-8"),
        (b'ask,right\n"a "b" c",d', "line 2: its quotation marks do not match"),
        (b'sep=,\nask,right\n"a "b" c",d', "line 3: its quotation marks do not match"),
        (b"the question,a,b,c,right,hint\n1,2,3,4,2,6", "such as 'the_question'"),
    ],
)
def test_a_table_that_cannot_be_read_is_the_only_mistake(
    folder: Path, content: bytes, told: str
) -> None:
    (folder / "trivia.csv").write_bytes(content)
    (line,) = mistakes(folder)
    assert told in line


def test_an_empty_right_answer_is_named_by_row_and_column(folder: Path) -> None:
    rows = (folder / "trivia.csv").read_text(encoding="utf-8").splitlines()
    rows[2] = "Whose?,a,b,c,,hint"
    (folder / "trivia.csv").write_text("\n".join(rows), encoding="utf-8")
    (line,) = mistakes(folder, ('options = ["a", "b", "c"], ', ""))
    assert "trivia.csv: row 3, column right is empty; 'answer' compares answers with it." in line


def test_an_empty_cell_that_leaves_a_behaviour_without_words_is_found(folder: Path) -> None:
    rows = (folder / "trivia.csv").read_text(encoding="utf-8").splitlines()
    rows[2] = "Whose?,a,b,c,b,"
    (folder / "trivia.csv").write_text("\n".join(rows), encoding="utf-8")
    path = folder / "mine.toml"
    path.write_text(TEXT, encoding="utf-8")
    assert list(empty_cells(read_declaration(path))) == [EmptyCell(3, "hint", "give hint")]
    path.write_text(TEXT.replace('says = ["', 'says = ["Think, all.", "'), encoding="utf-8")
    assert not list(empty_cells(read_declaration(path)))


@given(token=st.sampled_from(TOKENS), how=st.sampled_from(("twist", "drop", "double", "number")))
@tried(3_000)
def test_a_mistaken_word_is_reported_in_a_line_without_traceback(
    tmp_path_factory: pytest.TempPathFactory, token: tuple[int, int], how: str
) -> None:
    begin, end = token
    word = TEXT[begin:end]
    changed = {
        "twist": word[1] + word[0] + word[2:],
        "drop": "",
        "double": f"{word} {word}",
        "number": "7",
    }[how]
    folder = tmp_path_factory.mktemp("mutant", numbered=True)
    shutil.copy(SHIPPED.with_suffix(".csv"), folder / "trivia.csv")
    path = folder / "mine.toml"
    path.write_text(TEXT[:begin] + changed + TEXT[end:], encoding="utf-8")
    try:
        read_activity(path)
    except MistakesError as error:
        assert all(re.match(r"mine\.toml:\d+:\d+: ", line) for line in error.lines)
        assert all(line.isprintable() and len(line) < 700 for line in error.lines)
    except ProfileError as error:
        assert str(error).isprintable()


@pytest.mark.parametrize("name", DECLARED)
def test_a_misspelt_key_is_reported_first_with_the_right_one(name: str, tmp_path: Path) -> None:
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    for table in FOLDER.glob("*.csv"):
        shutil.copy(table, tmp_path)
    file, passed = tmp_path / f"{name}.toml", set[str]()
    for key in re.finditer(r"(?m)(?:^|[{,]\s*)([a-z_]{4,})(?=\s*=)", text):
        if key[1] in passed:
            continue
        passed.add(key[1])
        file.write_text(f"{text[: key.end(1) - 1]}x{text[key.end(1) :]}", encoding="utf-8")
        with pytest.raises(MistakesError) as refused:
            read_activity(file)
        assert f"'{key[1]}'" in str(refused.value)
