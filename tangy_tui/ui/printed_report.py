"""The report of a session as a page to print, in the data folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.monitoring.games import Game


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
    session = read_report(workspace, games, names)
    page.write(path, session_page(session, full=False), "the report")
    return path
