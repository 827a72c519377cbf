"""The size of the sources by folder and kind of line, and functions that the program does not use.

Run by hand: `python -m tests.bench.size`. A line is code, an import, part of a table (an assignment
of eight lines or more at the top of a module), a docstring, a comment, or blank. The second part
lists functions whose name no other place of the sources contains: tests use them, or nobody does.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

HOUSE = Path(__file__).parents[2]
FLOORS = ("tangy_tui", "hw", "profiles", "sim")
KINDS = ("lines", "statements", "code", "import", "table", "docstring", "comment", "blank")
TABLE_LINES = 8
LAYOUT = (tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER)
CALLED_BY_OTHERS = re.compile(
    r"__|on_|_on_|action_|watch_|compute_|validate_|render|compose|get_|check_|key_|visit_|connection_"
    r"|data_received|(pause|resume)_writing|discover|list_commands|initialize_logging|handleError"
)
"""Beginnings of names that Python, textual or typer calls."""

Size = Counter[str]


def spans(nodes: Iterator[ast.stmt]) -> set[int]:
    """Return the numbers of the lines of some statements."""
    found: set[int] = set()
    for node in nodes:
        found |= set(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return found


def is_docstring(node: ast.AST) -> bool:
    """Return whether a statement is a text alone."""
    return (
        isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    )


def size_of(path: Path) -> Size:
    """Count the lines of a module by kind, and its statements."""
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source)
    statements = [node for node in ast.walk(tree) if isinstance(node, ast.stmt)]
    docstrings = spans(one for one in statements if is_docstring(one))
    imports = spans(one for one in statements if isinstance(one, ast.Import | ast.ImportFrom))
    tables = spans(
        one
        for one in tree.body
        if isinstance(one, ast.Assign | ast.AnnAssign)
        and (one.end_lineno or one.lineno) - one.lineno >= TABLE_LINES
    )
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type != tokenize.COMMENT and token.type not in LAYOUT:
            code |= set(range(token.start[0], token.end[0] + 1))
    size = Counter(lines=0, statements=len(statements))
    for number, line in enumerate(source.splitlines(), 1):
        size["lines"] += 1
        if not line.strip():
            size["blank"] += 1
        elif number in docstrings:
            size["docstring"] += 1
        elif number not in code:
            size["comment"] += 1
        elif number in imports:
            size["import"] += 1
        else:
            size["table" if number in tables else "code"] += 1
    return size


def folder_of(path: Path) -> str:
    """Return the folder that a module counts for: two levels below the package at most."""
    parts = path.relative_to(HOUSE).parts[:-1]
    return "/".join(parts[: 2 if parts[0] == "tangy_tui" else 3])


def words_of(tree: ast.AST) -> Iterator[str]:
    """Yield the names that a module uses, and the words of its texts."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from re.findall(r"\w+", node.value)


def unused(sources: list[Path]) -> Iterator[tuple[str, int]]:
    """Yield functions that no module uses by name, with their number of lines."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in sources}
    used = {word for tree in trees.values() for word in words_of(tree)}
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                continue
            framework = CALLED_BY_OTHERS.match(node.name) or node.decorator_list
            if node.name not in used and not framework:
                where = f"{path.relative_to(HOUSE)}:{node.lineno} {node.name}"
                yield where, (node.end_lineno or node.lineno) - node.lineno + 1


def main() -> None:
    """Print the tables."""
    sources = [path for floor in FLOORS for path in sorted((HOUSE / floor).rglob("*.py"))]
    sizes: dict[str, Size] = {}
    for path in sources:
        for name in (folder_of(path), "all"):
            sizes.setdefault(name, Counter()).update({**size_of(path), "modules": 1})
    columns = ("modules", *KINDS)
    print(f"{'':34}" + "".join(f"{one:>11}" for one in columns))
    for name, size in sorted(sizes.items(), key=lambda one: (one[0] == "all", one[0])):
        print(f"{name:34}" + "".join(f"{size[one]:>11,}" for one in columns))
    found = sorted(unused(sources), key=lambda one: -one[1])
    print(f"\nunused by the program: {sum(lines for _, lines in found)} lines")
    for where, lines in found:
        print(f"  {lines:3}  {where}")


if __name__ == "__main__":
    main()
