"""Finding the line of a key in any style of TOML."""

from __future__ import annotations

import pytest

from tangy_profiles.toml_lines import KeyPath, line_of

TEXT = '''# a comment
name = "x"
long = """
seats = 3
[inner]
"""
list = [
    1,
    2,
]
dotted.key = 1

[table]
here = { a = 1, b = 2 }

[[seats]]
x = 1

[[seats]]  # the second
x = 2
[[seats.legs]]
y = 1
[[seats.legs]]
y = 2
'''


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("name",), 2),
        (("long",), 3),
        (("list",), 7),
        (("dotted", "key"), 11),
        (("table",), 13),
        (("table", "here", "b"), 14),
        (("table", "missing"), 13),
        (("seats", 0, "x"), 17),
        (("seats", 1), 19),
        (("seats", 1, "x"), 20),
        (("seats", 1, "legs", 1, "y"), 24),
        (("missing",), None),
    ],
)
def test_the_line_of_a_key_or_its_table_is_found(path: KeyPath, line: int | None) -> None:
    assert line_of(TEXT, path) == line


def test_the_search_of_a_large_file_is_bounded() -> None:
    assert line_of("a = [\n" + "1,\n" * 300_000 + "]\nb = 1\n", ("b",)) is None
