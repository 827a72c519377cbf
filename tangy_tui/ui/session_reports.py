"""The way from home, and from the list of all commands, to the reports of sessions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.monitoring.games import Game
    from tangy_tui.ui.program import Program


async def show_reports(program: Program) -> None:
    """Open the report of the last session, unless no game was played yet or it is open."""
    from tangy_tui.app.session_reports import read_sessions
    from tangy_tui.text.games import NONE_YET
    from tangy_tui.text.session_reports import READING, REPORTS
    from tangy_tui.ui.screens.report import ReportScreen

    if any(isinstance(screen, ReportScreen) for screen in program.screen_stack):
        return
    sessions = await program.in_thread(READING, lambda: read_sessions(program.workspace))
    if sessions:
        await program.push_screen(ReportScreen(program.workspace, sessions))
    elif sessions is not None:
        await program.tell(NONE_YET, title=REPORTS[0])


def write_page(workspace: Workspace, games: Sequence[Game], names: Mapping[str, str]) -> Path:
    """Write the report of a session as a page to print, into the data folder; return its path.

    Args:
        workspace: the workspace of the games.
        games: the games of the session.
        names: the names of people, by id.

    Raises:
        TangyError: the log cannot be read, or the page not be written.
    """
    from tangy_tui.app.session_reports import read_report
    from tangy_tui.pages import page
    from tangy_tui.pages.session import session_page

    began = games[0].at.astimezone()
    path = workspace.store.folder.absolute() / f"report-{began:%Y-%m-%d-%H%M}.html"
    page.write(path, session_page(read_report(workspace, games, names)), "the report")
    return path
