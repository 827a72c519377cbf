"""Reports in a terminal: what does not fit in columns is written in paragraphs, and never cut."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tangy_tui.text.house import GAME_COLUMNS, MONTH_COLUMNS, WHO_COLUMNS
from tangy_tui.ui.reports import print_rows, row_lines

COLUMNS = ("person", "last here", "waited")
ROWS = (
    ("Wilhelmina Featherstonehaugh", "27 Nov 2026 07:42", "usually 12 s, at most 14 s"),
    ("Bo", "27 Nov 2026 07:42", "\N{EN DASH}"),
)


@pytest.mark.parametrize("width", [30, 60, 80, 120, 200])
@pytest.mark.parametrize("columns", [MONTH_COLUMNS, WHO_COLUMNS, GAME_COLUMNS])
def test_every_word_of_a_table_is_printed_at_every_width(
    width: int,
    columns: Sequence[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setenv("COLUMNS", str(width))
    cells = [f"November {n} usually" for n in range(100, 100 + len(columns))]
    print_rows(columns, [cells], "Month by month")
    said = capsys.readouterr().out
    assert max(map(len, said.splitlines())) <= width
    words = [*["Month", "by", "month"], *" ".join([*columns[1:], *cells]).split()]
    assert not {*words} - {*said.replace(":", " ").replace(";", " ").split()}


def test_a_row_in_lines_leaves_out_cells_that_say_nothing() -> None:
    assert list(row_lines(COLUMNS, ROWS, 60)) == [
        "Wilhelmina Featherstonehaugh",
        "  last here: 27 Nov 2026 07:42; waited: usually 12 s, at",
        "  most 14 s",
        "Bo",
        "  last here: 27 Nov 2026 07:42",
    ]
