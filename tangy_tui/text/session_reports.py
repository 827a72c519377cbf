"""Words of the screen with the reports of sessions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tangy_tui.text.times import local_time
from tangy_tui.text.worlds import WORLDS

if TYPE_CHECKING:
    from tangy_tui.monitoring.games import Game

REPORTS = ("Report of the last session", "What happened in the last games, and in earlier ones")
"""The name of the reports in the list of all commands, and their purpose."""
READING = "Tangy is reading the log ..."
EARLIER, LATER, SCROLL = "earlier", "later", "scroll"
SCREEN_HELP = (
    "The report of the last session: what to look after, who took part, what was called, what went "
    "wrong, and what staff did. The left arrow goes to an earlier session, the right arrow back. "
    "Games less than half an hour apart belong to one session. {printed_page} writes the report as "
    "a page to print (HTML) into the data folder, and shows its name."
)


def games_title(games: Sequence[Game]) -> str:
    """Name the games of a session, with the time and the place of the first one."""
    first, last = games[0], games[-1]
    numbers = f"Game {first.number}" if first is last else f"Games {first.number} to {last.number}"
    return f"{numbers}, {local_time(first.at.isoformat())}, {WORLDS[first.world]}"


def place_words(at: int, count: int) -> str:
    """Tell which session is shown; the last one is `at` 0."""
    return "the last session" if not at else f"session {count - at} of {count}"


def as_page(games: Sequence[Game], data: str = "", *, last: bool) -> str:
    """Tell the key and the command that write the report of a session as a page to print.

    Args:
        games: the games of the session.
        data: the options that name the data folder.
        last: whether it is the last session.
    """
    key = "To print this report, press {printed_page}: Tangy writes it as a page."
    if not last and len(games) > 1:
        return key
    which = "" if last else f" {games[0].number}"
    return f"{key} Or type in a terminal: tangy report session{which} --html report.html{data}"


PRINTED_PAGE = "The report as a page"
"""The title of the message that tells where the page is."""


def printed_page_words(path: str) -> str:
    """Tell where the page is, and how to print it."""
    return f"The page is here:\n{path}\nOpen it with a web browser, and print it from there."
