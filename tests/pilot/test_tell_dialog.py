"""The line for reports about people stays open if Tangy refuses a report."""

from __future__ import annotations

from textual.app import App
from textual.widgets import Input

from tangy_profiles.errors import TangyError
from tangy_tui.ui.dialogs.staff_line import TellDialog
from tests.pilot.conftest import screen_text


async def test_a_refused_report_stays_with_the_reason_until_it_is_corrected() -> None:
    told: list[str] = []

    def tell(line: str) -> None:
        told.append(line)
        if line != "reds: gene":
            raise TangyError("That does not count in this game.")

    app = App[None]()
    async with app.run_test() as pilot:
        app.push_screen(TellDialog(tell, "", ["Gene"]))
        await pilot.pause()
        await pilot.press(*"fred", "enter")
        assert isinstance(app.screen, TellDialog)
        assert "That does not count in this game." in screen_text(app)
        assert app.screen.query_one(Input).value == "fred"
        await pilot.press(*"reds: gene", "enter")
        assert not isinstance(app.screen, TellDialog)
    assert told == ["fred", "reds: gene"]
