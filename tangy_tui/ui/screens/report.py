"""The report of a session, as `tangy report` writes it, and of those before it."""

from __future__ import annotations

import asyncio
import shlex
from collections.abc import Sequence
from typing import ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType

from tangy_profiles.errors import TangyError
from tangy_tui.app.register import guest_ids
from tangy_tui.app.session_reports import read_report
from tangy_tui.app.workspace import Workspace, data_folder
from tangy_tui.monitoring.games import Game
from tangy_tui.text import session_reports as text
from tangy_tui.text.keys import with_keys
from tangy_tui.text.log import session_lines
from tangy_tui.text.register import with_guests
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.printed_report import write_page
from tangy_tui.ui.widgets.page import Page, PageLine
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.wrapping import wrap


class ReportScreen(TangyScreen[None]):
    """The report of one session; left and right go to the sessions before and after it."""

    DEFAULT_CSS = """
    ReportScreen Page { height: 1fr; }
    """
    TITLE = "Report"
    AUTO_FOCUS = "#report"
    HELP = text.SCREEN_HELP
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("left", "turn(1)", text.EARLIER, id="left"),
        Binding("right", "turn(-1)", text.LATER, id="right"),
        *bind("printed_page"),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace, sessions: Sequence[Sequence[Game]]) -> None:
        """Create the screen; `sessions` are the games of each session, the last one first."""
        super().__init__()
        self._workspace, self._sessions = workspace, sessions
        store = workspace.store
        self._names = with_guests(workspace.names | store.names(), guest_ids(store))
        self._at = 0
        self._lines: tuple[str, ...] = ()

    @property
    def games(self) -> Sequence[Game]:
        """The games of the session that is shown."""
        return self._sessions[self._at]

    def compose(self) -> ComposeResult:
        """Lay out the report."""
        yield StatusLine(Status(mode="report"))
        yield panel(Page(id="report"), self.TITLE)
        yield key_line(
            ("←", text.EARLIER), ("→", text.LATER), "printed_page", ("↑ ↓", text.SCROLL), "filter",
            "back", "help",
        )  # fmt: skip

    async def on_mount(self) -> None:
        """Show the report of the last session."""
        await self._show()

    def action_turn(self, by: int) -> None:
        """Go to an earlier session (1), or a later one (-1)."""
        at = min(max(0, self._at + by), len(self._sessions) - 1)
        if at != self._at:
            self._at = at
            self.run_worker(self._show(), exclusive=True)

    async def action_printed_page(self) -> None:
        """Write the report as a page to print, and tell where it is."""
        try:
            path = await asyncio.to_thread(write_page, self._workspace, self.games, self._names)
        except TangyError as error:
            said = str(error)
        else:
            said = text.printed_page_words(str(path))
        self.app.push_screen(MessageDialog(said, title=text.PRINTED_PAGE))

    def action_leave(self) -> None:
        """Close the screen."""
        self.leave(None)

    async def _show(self) -> None:
        session = await asyncio.to_thread(read_report, self._workspace, self.games, self._names)
        self._lines = (*session_lines(session, full=False), "", self._printing())
        self.query_one(StatusLine).show(
            Status(mode="report", note=text.place_words(self._at, len(self._sessions)))
        )
        page = self.query_one(Page)
        page.border_title = text.games_title(self.games)
        page.show(self._write)
        page.scroll_home(animate=False)

    def _printing(self) -> str:
        """Tell how to get the report on paper."""
        folder = self._workspace.store.folder
        data = "" if folder == data_folder(None) else f" --data {shlex.quote(str(folder))}"
        command = text.as_page(self.games, data, last=not self._at)
        return with_keys(command, keymap_of(self.app))

    def _write(self, width: int) -> list[PageLine]:
        """Wrap the lines; a line that belongs to another one stays indented."""
        written: list[PageLine] = []
        for line in map(clean, self._lines):
            words = line.lstrip()
            indent = " " * (len(line) - len(words))
            room = width - len(indent) - 1  # a gap before the scroll bar
            for part in wrap(words, max(10, room)) or [""]:
                written.append(PageLine(((indent + part, "text"),)))
        return written
