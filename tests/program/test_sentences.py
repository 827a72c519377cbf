"""Sentences for people stand in `tangy_tui/text`: elsewhere they are counted, and only get fewer.

Not counted are the reasons of errors, which name what was wrong where it is found, the help of the
command line and of keys beside what they explain, and what is logged for engineers.
"""

from __future__ import annotations

import ast
import re
from collections import Counter
from pathlib import Path

HOUSE = Path(__file__).parents[2]
ELSEWHERE = {
    "hw": 73,
    "profiles": 12,
    "sim": 1,
    "tangy_tui": 11,
    "tangy_tui/app": 14,
    "tangy_tui/console": 22,
    "tangy_tui/experiments": 50,
    "tangy_tui/interaction": 9,
    "tangy_tui/learning": 41,
    "tangy_tui/monitoring": 15,
    "tangy_tui/pages": 11,
    "tangy_tui/speech": 56,
    "tangy_tui/ui": 210,
    "tangy_tui/verbs": 72,
}
"""How many sentences each room may still hold. Lower a number when you have moved some."""


def said(text: str) -> bool:
    """Say whether a text is a sentence for people."""
    words = re.findall(r"[A-Za-z{][\w'{}]*", text)
    begins = re.match(r"\s*[A-Z{]", text)
    ends = re.search(r"[.?!:]\s*$|[.?!] ", text)
    is_code = "SELECT" in text or "CREATE" in text or "\\" in text
    return len(words) >= 3 and bool(begins and ends) and not is_code


def beside(parents: dict[ast.AST, ast.AST], node: ast.AST) -> bool:
    """Say whether a text stands where it need not be counted."""
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


def room(source: Path) -> str:
    """Return the room of a module: a floor, or a folder of the program."""
    floor, *below = source.relative_to(HOUSE).parts
    return f"{floor}/{below[0]}" if floor == "tangy_tui" and len(below) > 1 else floor


def test_sentences_for_people_stand_in_one_place() -> None:
    found = Counter[str]()
    for floor in ("hw", "profiles", "sim", "tangy_tui"):
        for source in (HOUSE / floor).rglob("*.py"):
            if room(source) != "tangy_tui/text":
                found[room(source)] += sentences(source)
    assert {one: count for one, count in found.items() if count} == ELSEWHERE
