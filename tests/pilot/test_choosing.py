"""Choosing one of many people by letters of the name; typing stop still stops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from textual.app import ComposeResult

from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.round_trip import ReplyParser
from tests.support.waiting import until, until_shown

if TYPE_CHECKING:
    from tests.pilot.conftest import Run

NAMES = (
    "Rosa",
    "Anna Rose",
    "Christopher",
    "Oscar",
    "Big Ben",
    "Ben",
    "Zoë",
    *(f"User {n}" for n in range(6, 25)),
)


class Asking(TangyScreen[None]):
    """Asks for a person, and hears STOP."""

    def __init__(self) -> None:
        super().__init__()
        self.answers: list[str | None] = []
        self.stops = 0

    def compose(self) -> ComposeResult:
        return []

    def on_mount(self) -> None:
        options = [Option(name.lower(), name, "is here") for name in NAMES]
        self.app.push_screen(ChooseDialog("Who?", options), self.answers.append)


@pytest.mark.parametrize(
    ("keys", "chosen"),
    [
        ("o s c enter", "oscar"),
        ("slash c h r i s t o p h e r enter", "christopher"),
        ("r o s down enter", "anna rose"),
        ("b e n enter", "ben"),  # not Big Ben, who is first
        ("a n n a space r enter", "anna rose"),
        ("2 4 enter", "user 24"),
        ("x x escape enter", "rosa"),
        ("x backspace b e n enter", "ben"),
        ("j enter escape escape", None),
        ("escape", None),
        ("z o e enter", "zoë"),
        ("h e r e enter escape escape", None),  # text beside the names does not count
    ],
)
async def test_letters_filter_enter_chooses_and_esc_goes_back(
    run: Run, keys: str, chosen: str | None
) -> None:
    asking = Asking()
    async with run(asking) as pilot:
        await until_shown(pilot, lambda: "letters filter" in pilot.text())
        await pilot.press(*keys.split())
        await until(lambda: asking.answers == [chosen])


async def test_typing_stop_stops_instead_of_filtering(
    run: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    asking, stops = Asking(), list[str]()
    async with run(asking) as pilot:
        await until_shown(pilot, lambda: "letters filter" in pilot.text())
        monkeypatch.setattr(pilot.app, "action_stop", lambda: stops.append("stop"))
        await pilot.press(*"sto")
        assert "User 7" not in pilot.text()
        await pilot.press("p")
        assert stops == ["stop"]


@pytest.mark.parametrize("typed", ["oscar", "oscar\r", "\x1b[200~oscar\x1b[201~"])
async def test_pasted_letters_filter_and_a_pasted_enter_chooses_nothing(
    run: Run, typed: str
) -> None:
    asking = Asking()
    async with run(asking) as pilot:
        await until_shown(pilot, lambda: "letters filter" in pilot.text())
        for message in ReplyParser().feed(typed):
            pilot.app.post_message(message)
        await until_shown(pilot, lambda: "/oscar_" in pilot.text())
        assert not asking.answers
        await pilot.press("enter")
        await until(lambda: asking.answers == ["oscar"])
