"""Rules for tests: public names of the product, local fixtures, and screens compared as text.

A test that reads a private attribute breaks when only the inside changes; a test and a reader of
the code need the same information, so it gets a public name.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

TESTS = Path(__file__).parents[1]
FLOORS = ("tangy_tui", "sim", "hw", "profiles")
FILES = sorted(TESTS.rglob("*.py"))

ELSEWHERE = {"_replace", "_display", "_ready", "_id"}
"""Names by others: of named tuples, Textual's app, asyncio's loop, pytest's items."""

MOST_PICTURES = 12


def private(name: str) -> bool:
    return (
        name.startswith("_") and name != "_" and not name.startswith("__") and name not in ELSEWHERE
    )


def named(tree: ast.AST) -> Iterator[str]:
    """Return the private names that a module defines."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            if isinstance(node.value, ast.Name) and node.value.id in ("self", "cls"):
                yield node.attr
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id


@cache
def of_the_product() -> frozenset[str]:
    paths = (path for floor in FLOORS for path in (TESTS.parent / floor).rglob("*.py"))
    trees = (ast.parse(path.read_text(encoding="utf-8")) for path in paths)
    return frozenset(name for tree in trees for name in named(tree) if private(name))


def touched(tree: ast.Module) -> Iterator[str]:
    """Return each private name of the product that a test reads, sets, imports or replaces."""
    own = set(named(tree))
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(attr=name) if name not in own and name in of_the_product():
                yield f"{node.lineno}: {ast.unparse(node)}"
            case ast.ImportFrom(module=str(module), names=names) if module.startswith("tangy_"):
                yield from (f"{node.lineno}: {n.name}" for n in names if private(n.name))
            case ast.Call(func=ast.Attribute(attr=does) | ast.Name(id=does), args=args):
                if re.fullmatch("(set|get|del|has)attr|object", does):
                    for given in args:
                        match given:
                            case ast.Constant(value=str(name)):
                                last = name.rpartition(".")[2]
                                if private(last) and last in of_the_product() - own:
                                    yield f"{node.lineno}: {name!r}"


def test_tests_use_no_private_names_of_the_product() -> None:
    found = {
        path.relative_to(TESTS).as_posix(): there
        for path in FILES
        if (there := list(touched(ast.parse(path.read_text(encoding="utf-8")))))
    }
    assert not found, "give the product a public name, or look at what it does"


def test_every_use_of_a_private_name_is_found() -> None:
    name = next(iter(sorted(of_the_product())))
    for how in (
        f"thing.{name}",
        f"thing.{name} = 1",
        f"from tangy_tui.learning.policy import {name}",
        f"monkeypatch.setattr(thing, '{name}', 1)",
        f"monkeypatch.setattr('tangy_tui.thing.{name}', 1)",
    ):
        assert list(touched(ast.parse(how))), how
    assert not list(touched(ast.parse("state._replace(step=1)")))
    assert not list(touched(ast.parse(f"class Own:\n def {name}(self): return self.{name}()")))


def test_a_conftest_is_imported_only_in_its_folder() -> None:
    found = [
        f"{path.relative_to(TESTS)}: {folder}"
        for path in FILES
        for folder in re.findall(
            r"^\s*from tests\.(?:(\w+)\.)?conftest import", path.read_text("utf-8"), re.MULTILINE
        )
        if folder != path.relative_to(TESTS).parts[0]
    ]
    assert found == []


def test_few_screens_are_compared_as_pictures() -> None:
    pictures = sorted(path.name for path in TESTS.rglob("*.svg"))
    assert len(pictures) <= MOST_PICTURES, pictures
