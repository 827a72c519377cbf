"""The list of games, on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from tangy_profiles.game_world import BENCH, LIVE, SIMULATED, UNKNOWN
from tangy_profiles.reading import plain
from tangy_tui.monitoring.games import Game
from tangy_tui.text.endings import ending_words
from tangy_tui.text.follow_up import follow_up
from tangy_tui.text.games import NONE_YET
from tangy_tui.text.log import HOW_TO_GO_ON
from tangy_tui.text.times import local_time

SHORT = 6
"""Printed characters of an id."""
SHORT_WORLDS = {UNKNOWN: "?", SIMULATED: "sim", BENCH: "bench", LIVE: "live"}
COLUMNS = ("", "id", "when", "activity", "policy", "steps", "faults", "end", "games")
FOLDED = ("activity", "policy")
"""Columns with users' own names; the others fit 80 columns, even with numbers of five digits."""


def print_games(games: Sequence[Game], data: str) -> None:
    """Print the games of a log, the newest last, and below the reasons why some stopped early.

    `data` is the folder for the commands that follow, "" for the usual one.
    """
    console = Console(highlight=False)
    if not games:
        console.print(Text(follow_up(NONE_YET, data=data)), soft_wrap=True)
        return
    table = Table(
        title=Text("Games"), box=box.SIMPLE_HEAD, title_justify="left", padding=0, show_edge=False
    )
    for column in COLUMNS:
        if column in FOLDED:
            table.add_column(column, overflow="fold", min_width=len("activity"))
        else:
            justify: Literal["left", "right"] = "right" if column in ("", "steps") else "left"
            table.add_column(column, no_wrap=True, justify=justify)
    for game in games:
        table.add_row(
            str(game.number),
            game.id[:SHORT],
            local_time(game.at.isoformat()),
            Text(plain(game.activity)),
            Text(plain(game.policy)),
            str(game.steps),
            _faults(game),
            _ended(game),
            SHORT_WORLDS[game.world],
        )
    console.print(table)
    for game in games:
        if game.ended is None or game.stopped is not None or game.due:
            console.print(Text(plain(f"Game {game.number}: {ending_words(game)}")))
    console.print(Text(follow_up(HOW_TO_GO_ON, data=data)), soft_wrap=True)


def _ended(game: Game) -> Text:
    if game.ended is None:
        return Text("no end", style="yellow")
    if game.stopped is not None:
        return Text("stopped", style="yellow")
    return Text("ended early", style="yellow") if game.due else Text("played")


def _faults(game: Game) -> Text:
    words = Text(str(game.critical + game.other))
    if game.critical:
        words.append(f", {game.critical} critical", style="bold red")
    return words
