"""Importing questions of other programs as an activity."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_tui.app.question_files import ChoiceQuestion, read_questions

Tangy = Callable[..., CompletedProcess[str]]

AIKEN = """What grows from an acorn?
A. a birch
B. an oak
C) a lime
ANSWER: B

Which of these is
a root?
A) a carrot
B) a pea
ANSWER: a
"""
KAHOOT = """Quiz template,,,,,,,
Read this first,,,,,,,
,Question - max 120 characters,Answer 1,Answer 2,Answer 3,Answer 4,Time limit,Correct answer(s)
1,"Which is red, mostly?",a tomato,a leek,a pea,a plum,20,1
2,What is sown in spring?,peas,beans,garlic,,20,"1,2"
3,,,,,,,
"""


def test_the_aiken_format_is_read() -> None:
    assert read_questions(AIKEN, "quiz.txt") == [
        ChoiceQuestion("What grows from an acorn?", ("a birch", "an oak", "a lime"), (1,)),
        ChoiceQuestion("Which of these is a root?", ("a carrot", "a pea"), (0,)),
    ]


@pytest.mark.parametrize("separator", [",", ";"])
def test_the_kahoot_table_is_read_below_its_instructions(separator: str) -> None:
    text = KAHOOT if separator == "," else KAHOOT.replace('"', "").replace("red, m", "red m")
    if separator == ";":
        text = text.replace("1,2\n", "1 2\n").replace(",", ";")
    first, second = read_questions(text, "quiz.csv")
    assert first.options == ("a tomato", "a leek", "a pea", "a plum") and first.right == (0,)
    assert second.options == ("peas", "beans", "garlic") and second.right == (0, 1)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("Why?\nA. so\nB. so\nANSWER: A\n", 4),
        ("Why?\nA. so\nB. not so\nANSWER: C\n", 4),
        ("Why?\nA. so\nand more\nANSWER: A\n", 3),
        ("A. so\nB. not so\nANSWER: A\n", 3),
        ("Why?\nA. so\nB. not so\nANSWER: A\nWhat?\n", 5),
        ("Question,Answer 1,Answer 2,Correct\nWhy?,so,not so,3\n", 2),
    ],
)
def test_a_mistake_names_its_line(text: str, line: int) -> None:
    with pytest.raises(TangyError, match=rf"^quiz, line {line}: "):
        read_questions(text, "quiz")


@pytest.mark.parametrize("text", ["", "hello", "a,b\n1,2\n", "\0"])
def test_a_file_without_questions_is_refused(text: str) -> None:
    with pytest.raises(TangyError):
        read_questions(text, "quiz")


@pytest.mark.slow
@pytest.mark.parametrize("text", [AIKEN, KAHOOT])
def test_an_imported_activity_can_be_checked_tried_and_played(
    text: str, tangy: Tangy, tmp_path: Path
) -> None:
    (tmp_path / "quiz").write_text("\ufeff" + text, encoding="utf-8")
    made = tangy("activity", "import", tmp_path / "quiz", "--title", "Garden quiz",
                 "--folder", tmp_path)  # fmt: skip
    assert (made.returncode, made.stderr) == (0, "")
    file = tmp_path / "garden-quiz.toml"
    assert len(file.read_text("utf-8").splitlines()) <= 82
    assert load_activity(str(file)).title == "Garden quiz"
    checked = json.loads(tangy("activity", "check", "--json", file).stdout)
    assert [one["mistakes"] for one in checked["files"]] == [[]]
    assert json.loads(tangy("activity", "try", "--json", file).stdout)["finished"]
