"""Background tasks of a screen end before its panels are removed."""

from __future__ import annotations

import asyncio

import pytest
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.widgets import Static

from tangy_tui.ui.app import TangyApp
from tangy_tui.ui.base import TangyScreen
from tests.pilot.conftest import Run


class Busy(TangyScreen[None]):
    """Writes to its last panel at every turn of the loop."""

    written = 0

    def compose(self) -> ComposeResult:
        with Vertical():
            for number in range(20):
                yield Static(id=f"panel{number}")
        yield Static(id="late")

    def on_mount(self) -> None:
        self.run_worker(self._write())

    async def _write(self) -> None:
        while True:
            for number in range(20):
                self.query_one(f"#panel{number}", Static).update(str(self.written))
            self.query_one("#late", Static).update(str(self.written))
            self.written += 1
            await asyncio.sleep(0)


@pytest.mark.slow
@pytest.mark.parametrize("leaves", [False, True], ids=["it is closed", "the program is left"])
async def test_no_task_writes_to_removed_panels(run: Run, leaves: bool) -> None:
    for _ in range(5):
        async with run(app=TangyApp()) as pilot:
            busy = Busy()
            await pilot.app.push_screen(busy)
            await pilot.pause(0.05)
            if not leaves:
                busy.close(None)
                await pilot.pause(0.05)
                assert not busy.is_running
        assert busy.written > 1
