"""Public docstrings state the unit of each float, and the shape or kind of each array."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

HOUSE = Path(__file__).parents[2]
Function = ast.FunctionDef | ast.AsyncFunctionDef
UNITS = r"""s ms min h m mm cm m/s rad rad/s 1/s Hz dB px bytes? radians degrees? [Mm]etres? pixels?
[Ss]econds? minutes? hours? days? cells? rows shares? probabilit(?:y|ies) ratio fraction chance
quantile likelihood likeness scores? standard\ deviations? times\ life responses? Beta 0\ to\ 1"""
_ANY = "|".join(re.split(r"(?<!\\)\s", UNITS))
UNIT = re.compile(rf"(?<![\w'])(?:{_ANY})(?![\w'])|%|P\(")
"""Units, and words for quantities without one."""
SHAPE = re.compile(r"\(\w+, ?\w*[,):]|BGR|RGB|grey")
"""A shape, or the kind of a picture."""
NO_MEASURE = ("number", "numbers", "number_of", "word_or_number", "wrong")
"""Functions that read or write any number."""
SAME_AS_INNER = "As the inner method does."


def functions(source: Path) -> Iterator[tuple[Function, str]]:
    """Yield the public functions of a module, each with its docstrings."""

    def inside(body: list[ast.stmt], about: str) -> Iterator[tuple[Function, str]]:
        for node in body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                yield from inside(node.body, ast.get_docstring(node) or "")
            elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                says = ast.get_docstring(node) or ""
                if node.name == "__init__":
                    yield node, f"{about} {says}"
                elif not node.name.startswith("_"):
                    yield node, says

    yield from inside(ast.parse(source.read_text(encoding="utf-8")).body, "")


def types(function: Function) -> list[str]:
    """Return the types that a function takes and returns, except functions."""
    taken = [one.annotation for one in (*function.args.args, *function.args.kwonlyargs)]
    told = [ast.unparse(one) for one in (*taken, function.returns) if one is not None]
    return [one for one in told if "Callable" not in one]


def missing(word: str, says: re.Pattern[str]) -> list[str]:
    """Return functions with a type in their signature whose docstring does not describe it."""
    found = []
    for floor in ("hw", "profiles", "sim", "tangy_tui"):
        for source in sorted((HOUSE / floor).rglob("*.py")):
            if source.parent.name == "verbs":  # their docstrings are the help of the command line
                continue
            for function, docstring in functions(source):
                measures = any(re.search(rf"\b(?:{word})\b", one) for one in types(function))
                exempt = function.name in NO_MEASURE or SAME_AS_INNER in docstring
                if measures and not exempt and not says.search(docstring):
                    found.append(f"{source.relative_to(HOUSE)}:{function.lineno} {function.name}")
    return found


def test_public_functions_state_the_unit_of_their_floats() -> None:
    assert missing("float", UNIT) == []


def test_public_functions_state_the_shape_of_their_arrays() -> None:
    assert missing("NDArray|Floats", SHAPE) == []
