"""The list of games on the command line."""

from __future__ import annotations

from collections.abc import Sequence

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from tangy_profiles.reading import plain
from tangy_tui.monitoring.games import NONE_YET, Game
from tangy_tui.ui.local_time import local_time


def print_games(games: Sequence[Game]) -> None:
    """Print the games of a log, the newest last."""
    console = Console(highlight=False)
    if not games:
        console.print(NONE_YET)
        return
    table = Table(title=Text("Games"), box=box.SIMPLE_HEAD, title_justify="left", pad_edge=False)
    for column in ("", "id", "when", "activity", "policy", "steps", "faults", "how it ended"):
        right = column in ("", "steps")
        table.add_column(column, overflow="fold", justify="right" if right else "left")
    for game in games:
        bad = game.ended is None or game.stopped is not None
        table.add_row(
            str(game.number),
            game.id,
            local_time(game.at.isoformat()),
            Text(plain(game.activity)),
            Text(plain(game.policy)),
            str(game.steps),
            _faults(game),
            Text(plain(game.ending), style="yellow" if bad else ""),
        )
    console.print(table)
    console.print(Text("tangy log show 1: a game step by step. tangy log report 1: its report."))


def _faults(game: Game) -> Text:
    words = Text(str(game.critical + game.other))
    if game.critical:
        words.append(f" ({game.critical} critical)", style="bold red")
    return words
