"""A count, a share and a list have the same form everywhere."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tangy_tui.text.numbers import counted, listed, often, ordinal

PROGRAM = Path(__file__).parents[2] / "tangy_tui"


@pytest.mark.parametrize(
    ("number", "words"),
    [(0, "0 steps"), (1, "1 step"), (2, "2 steps"), (3725, "3,725 steps")],
)
def test_a_count_agrees_with_its_noun(number: int, words: str) -> None:
    assert counted(number, "step") == words


def test_a_noun_can_have_a_plural_of_its_own() -> None:
    assert [counted(n, "entry", "entries") for n in (1, 2)] == ["1 entry", "2 entries"]


def test_ordinals_are_worded() -> None:
    said = [ordinal(number) for number in (1, 2, 3, 4, 11, 12, 21, 22, 113)]
    assert said == ["first", "second", "third", "4th", "11th", "12th", "21st", "22nd", "113th"]


@pytest.mark.parametrize(
    ("things", "words"),
    [((), ""), ((1,), "1"), ((1, 2), "1 and 2"), (("A", "B", "C"), "A, B and C")],
)
def test_lists_are_joined_in_words(things: tuple[object, ...], words: str) -> None:
    assert listed(things) == words


def test_alternatives_are_joined_by_or() -> None:
    assert listed(["joke", "greeting", "celebrate"], "or") == "joke, greeting or celebrate"


def plural_rules(source: Path) -> list[str]:
    """Return the functions of a module that form a plural with "s" themselves."""
    tree = ast.parse(source.read_text(encoding="utf-8"))
    return [
        f"{source.relative_to(PROGRAM).as_posix()}:{node.lineno}"
        for node in ast.walk(tree)
        if (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult) and _is_s(node.left))
        or (isinstance(node, ast.IfExp) and (_is_s(node.body) or _is_s(node.orelse)))
    ]


def _is_s(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and node.value == "s"


@pytest.mark.parametrize(
    ("times", "words"),
    [(0, "never"), (1, "once"), (2, "twice"), (3, "3 times"), (1200, "1,200 times")],
)
def test_how_often_is_worded(times: int, words: str) -> None:
    assert often(times) == words


@pytest.mark.slow
def test_how_often_is_worded_in_one_place() -> None:
    """`counted(n, "time")` would write "1 time"."""
    calls = (
        (source, node)
        for source in PROGRAM.rglob("*.py")
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and len(node.args) >= 2
    )
    found = {
        source.relative_to(PROGRAM).as_posix()
        for source, node in calls
        if ast.unparse(node.func) == "counted" and ast.unparse(node.args[1]) == "'time'"
    }
    assert found == set()


@pytest.mark.slow
def test_plurals_are_made_in_one_place() -> None:
    found = [where for source in PROGRAM.rglob("*.py") for where in plural_rules(source)]
    assert {where.partition(":")[0] for where in found} <= {"text/numbers.py"}
