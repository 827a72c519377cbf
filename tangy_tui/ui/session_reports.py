"""The way from home, and from the list of all commands, to the reports of sessions."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
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
