"""A table on the command line."""

from __future__ import annotations

from rich import box
from rich.table import Table
from rich.text import Text

from tangy_profiles.reading import plain


def titled_table(title: str, *columns: str) -> Table:
    """Return an empty table with a title, whose cells fold if they are too wide."""
    table = Table(
        title=Text(plain(title)), box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False
    )
    for column in columns:
        table.add_column(column, overflow="fold")
    return table
