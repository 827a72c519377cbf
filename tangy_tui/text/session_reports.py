"""Words of the screen with the reports of sessions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tangy_tui.text.times import local_time
from tangy_tui.text.watching import WORLDS

if TYPE_CHECKING:
    from tangy_tui.monitoring.games import Game

REPORTS = ("Report of the last session", "What happened in the last games, and in earlier ones")
"""The name of the reports in the list of all commands, and their purpose."""
READING = "Tangy is reading the log ..."
EARLIER, LATER, SCROLL = "earlier", "later", "scroll"
SCREEN_HELP = (
    "The report of the last session: what to look after, who took part, what was called, what went "
    "wrong, and what staff did. The left arrow goes to an earlier session, the right arrow back. "
    "Games less than half an hour apart belong to one session."
)


def games_title(games: Sequence[Game]) -> str:
    """Name the games of a session, with the time and the place of the first one."""
    first, last = games[0], games[-1]
    numbers = f"Game {first.number}" if first is last else f"Games {first.number} to {last.number}"
    return f"{numbers}, {local_time(first.at.isoformat())}, {WORLDS[first.world]}"


def place_words(at: int, count: int) -> str:
    """Tell which session is shown; the last one is `at` 0."""
    return "the last session" if not at else f"session {count - at} of {count}"


def as_page(games: Sequence[Game], *, last: bool) -> str:
    """Tell the command that writes the report of a session as a page, "" if there is none."""
    if not last and len(games) > 1:
        return ""
    which = "" if last else f" {games[0].number}"
    return f"To print it, type in a terminal: tangy report session{which} --html report.html"
