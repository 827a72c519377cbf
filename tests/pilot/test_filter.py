"""`/` filters every list, and esc shows all of it again."""

from __future__ import annotations

import pytest

from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.log_view import LogView
from tangy_tui.ui.widgets.page import Page, PageLine
from tangy_tui.ui.widgets.policy_table import PolicyRow, PolicyTable
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import Run

WORDS = ("red apple", "green pear", "red pear")


def transcript() -> Transcript:
    return Transcript()


def log() -> LogView:
    return LogView(id="log")


def choices() -> ChoiceList:
    return ChoiceList("List", "", id="choices")


def policy() -> PolicyTable:
    return PolicyTable()


def page() -> Page:
    return Page(lambda width: [PageLine(((w, "text"),), n) for n, w in enumerate(WORDS)])


def fill(panel: object) -> None:
    match panel:
        case Transcript():
            panel.fill(list(WORDS))
        case LogView():
            for word in WORDS:
                panel.write(word)
        case PolicyTable():
            panel.show([PolicyRow(word, "do", 1.0, 1) for word in WORDS])
        case ChoiceList():
            panel.show(lambda width, height: [ChoiceLine(((w, "text"),), w) for w in WORDS])


class ListScreen(TangyScreen[None]):
    """One list."""


@pytest.mark.parametrize("make", [transcript, log, choices, policy, page])
async def test_the_filter_keeps_lines_with_all_its_words(run: Run, make: type) -> None:
    panel = make()
    screen = ListScreen()
    async with run(screen) as pilot:
        await screen.mount(panel)
        fill(panel)
        panel.focus()
        await pilot.pause()
        pilot.type("slash", *"red pe")
        await pilot.pause()
        seen = [word for word in WORDS if word in pilot.text()]
        assert seen == ["red pear"]
        pilot.type("enter")
        await pilot.pause()
        assert "apple" not in pilot.text()
        pilot.type("escape")
        await pilot.pause()
        assert all(word in pilot.text() for word in WORDS)


async def test_choosing_in_a_filtered_list_returns_the_original_item(run: Run) -> None:
    table, steps = policy(), transcript()
    screen = ListScreen()
    async with run(screen) as pilot:
        await screen.mount(table, steps)
        for panel in (table, steps):
            fill(panel)
            panel.focus()
            await pilot.pause()
            pilot.type("slash", *"red pe", "enter", "home")
            await pilot.pause()
        assert table.chosen == 2
        assert steps.chosen == 3
