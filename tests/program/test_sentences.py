"""Sentences for people belong in `tangy_tui/text`: sentences elsewhere may only become fewer.

Exempt are the reasons of errors, which name the fault where it is found, the help of the
command line and of keys beside its subject, and log messages for engineers.
"""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path
from typing import Any

import pytest

HOUSE = Path(__file__).parents[2]
FLOORS = ("hw", "profiles", "sim", "tangy_tui")
TABLE = Path(__file__).with_name("sentences.toml")
"""The number of sentences that each module may still hold. Lower a number after moving some.

Its table of exceptions names the modules whose sentences should stay beside their cause, and why.
"""

CODE = re.compile(r"SELECT|CREATE|INSERT|\\|\(\?|</|\{\s*[a-z-]+:")
"""Patterns of SQL, regular expressions, markup and style sheets."""


def said(text: str) -> bool:
    """Return whether a text is a sentence for people: three words, and a capital or a full stop."""
    words = re.findall(r"(?<![\w{])[A-Za-z][A-Za-z'-]*(?![\w}])", text)
    if not any(word[1:].islower() for word in words):  # sounds are written in capitals
        return False
    begins = re.match(r"\s*[A-Z][a-z]*\b", text)
    ends = re.search(r"[a-z}][.?!]\s*$", text)
    return len(words) >= 3 and bool(begins or ends) and not CODE.search(text)


def beside(parents: dict[ast.AST, ast.AST], node: ast.AST) -> bool:
    """Return whether a text is exempt by its place."""
    above: ast.AST | None = node
    while above is not None:
        if isinstance(above, ast.Raise):
            return True
        if isinstance(above, ast.Call):
            called = ast.unparse(above.func)
            if called.endswith("Error") or called.startswith(("_LOG.", "typer.", "Binding")):
                return True
        if isinstance(above, ast.Assign) and ast.unparse(above.targets[0]) == "HELP":
            return True
        above = parents.get(above)
    return False


def sentences(source: Path) -> int:
    """Count the sentences of a module."""
    tree = ast.parse(source.read_text(encoding="utf-8"))
    parents = {below: node for node in ast.walk(tree) for below in ast.iter_child_nodes(node)}
    count = 0
    for node in ast.walk(tree):
        above = parents.get(node)
        if isinstance(node, ast.JoinedStr):
            text = "".join(
                str(part.value) if isinstance(part, ast.Constant) else "{}" for part in node.values
            )
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            if isinstance(above, ast.Expr | ast.JoinedStr):  # a docstring, or counted with the rest
                continue
            text = node.value
        else:
            continue
        count += said(text) and not beside(parents, node)
    return count


def elsewhere() -> dict[str, int]:
    """Count the sentences of each module outside `tangy_tui/text`."""
    sources = (p for floor in FLOORS for p in sorted((HOUSE / floor).rglob("*.py")))
    names = {source.relative_to(HOUSE).as_posix(): source for source in sources}
    counts = {n: sentences(p) for n, p in names.items() if not n.startswith("tangy_tui/text/")}
    return {name: count for name, count in counts.items() if count}


def table() -> tuple[dict[str, int], dict[str, str]]:
    """Read each module's limit, and the modules whose sentences stay for a reason."""
    counts: dict[str, Any] = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    exceptions: dict[str, dict[str, Any]] = counts.pop("exceptions")
    counts |= {name: one["count"] for name, one in exceptions.items()}
    return counts, {name: one["reason"] for name, one in exceptions.items()}


@pytest.mark.parametrize(
    ("text", "counts"),
    [
        ("The robot stands still.", True),
        ("Nothing was kept", True),
        ("{} asks for help.", True),
        ("{} of {}: {}.", False),
        ("call number", False),
        ("Policy", False),
        ("K S CH SH", False),
        ("Menu { height: 1fr; padding: 1 2 0 2; }", False),
        (r"^Call (?:the )?number \d+.", False),
        ("SELECT name FROM people.", False),
    ],
)
def test_a_sentence_has_three_words_and_a_capital_or_a_full_stop(text: str, counts: bool) -> None:
    assert said(text) is counts


def test_sentences_for_people_are_in_one_package() -> None:
    allowed, _ = table()
    found = elsewhere()
    changed = [name for name in sorted({*allowed, *found}) if allowed.get(name) != found.get(name)]
    more = [name for name in changed if found.get(name, 0) > allowed.get(name, 0)]
    assert not more, f"Write these sentences in tangy_tui/text: {more}"
    lower = [f'"{name}" = {found.get(name, 0)}' for name in changed]
    assert not lower, f"Fewer sentences are left: write this in {TABLE.name}: {lower}"


def test_each_exception_has_a_reason_and_is_listed_once() -> None:
    counted, reasons = tomllib.loads(TABLE.read_text(encoding="utf-8")), table()[1]
    assert not [name for name in reasons if name in counted]
    assert not [name for name, reason in reasons.items() if len(reason.split()) < 4]
