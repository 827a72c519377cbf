"""The staff panel: everybody is readable, however many there are."""

from __future__ import annotations

from textual.app import ComposeResult

from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tests.pilot.conftest import Run


class Panel(TangyScreen[None]):
    """A screen with the staff panel alone, ten lines high."""

    CSS = "StaffPanel { height: 10; }"

    def compose(self) -> ComposeResult:
        yield StaffPanel()


async def test_people_beyond_the_last_line_are_counted_and_scrolled_to(run: Run) -> None:
    people = [(f"Person {number:02}", "no visit yet", "text") for number in range(24)]
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.focus()
        panel.show("B7", "Next: call number.", ["1:01 so far"], people)
        await pilot.pause()
        seen = {name for name, _, _ in people if name in pilot.text()}
        assert 0 < len(seen) < 24
        assert panel.border_subtitle == f"{24 - len(seen)} more: ↓"
        for _ in range(8):
            await pilot.press("down")
            await pilot.pause()
            seen |= {name for name, _, _ in people if name in pilot.text()}
        assert len(seen) == 24
        assert not panel.border_subtitle


async def test_facts_below_the_last_line_are_not_counted_as_people(run: Run) -> None:
    people = [(f"Person {number:02}", "no visit yet", "text") for number in range(12)]
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.styles.height = 5
        panel.show("", "Next: call number.", [f"fact {n}" for n in range(5)], people)
        await pilot.pause()
        assert panel.border_subtitle == "12 more: ↓"


async def test_a_few_people_need_no_count(run: Run) -> None:
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.show("B7", "Next: call number.", ["1:01 so far"], [("Rosa", "asks 10 s", "warn")])
        await pilot.pause()
        assert "Rosa" in pilot.text() and not panel.border_subtitle


async def test_a_fact_is_told_in_the_longest_words_for_which_there_is_room(run: Run) -> None:
    ways = ("1:01 so far, paused 0:40, 12:00 left, until 15:20", "1:01 so far, paused 0:40")
    for width, told in ((80, ways[0]), (62, ways[1])):
        async with run(Panel(), size=(width, 24)) as pilot:
            panel = pilot.app.screen.query_one(StaffPanel)
            panel.show("B7", "Next: call number.", [ways], [("Rosa", "asks 10 s", "warn")])
            await pilot.pause()
            assert told in pilot.text() and (told == ways[0] or ways[0] not in pilot.text())


async def test_a_panel_that_was_scrolled_returns_to_the_next_step(run: Run) -> None:
    people = [(f"Person {number:02}", "no visit yet", "text") for number in range(24)]
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.focus()
        panel.show("B7", "Next: call number.", ["1:01 so far"], people)
        await pilot.pause()
        await pilot.press("down", "down")
        panel.show("B7", "Next: call number.", ["1:02 so far"], people)  # only the clock went on
        await pilot.pause()
        assert panel.scroll_offset.y == 2
        panel.show("B7", "Next: tell a joke.", ["1:03 so far"], people)
        await pilot.pause()
        assert panel.scroll_offset.y == 0 and "Next: tell a joke." in pilot.text()
        await pilot.press("down", "home")
        await pilot.pause()
        assert panel.scroll_offset.y == 0


async def test_a_long_next_step_takes_two_lines_and_shows_where_it_is_cut(run: Run) -> None:
    words = [f"word{number:02}" for number in range(40)]
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.show("B7", " ".join(words[:12]), ["1:01 so far"], [("Rosa", "asks 10 s", "warn")])
        await pilot.pause()
        assert all(word in pilot.text() for word in words[:12])
        panel.show("B7", " ".join(words), ["1:01 so far"], [("Rosa", "asks 10 s", "warn")])
        await pilot.pause()
        first, second, third = pilot.lines()[:3]
        assert words[0] in first and second.endswith("…") and "word" not in third


async def test_the_title_tells_what_tangy_said_as_far_as_there_is_room(run: Run) -> None:
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.show("B7", "Next: call number.", [], [], said="Tangy said: The number is [B-7].")
        assert str(panel.border_title) == "Now │ Tangy said: The number is [B-7]."
        panel.show("B7", "Next: call number.", [], [], said="Tangy said: " + "long " * 40)
        title = str(panel.border_title)
        assert title.endswith(" …") and 70 < len(title) <= 78
        panel.styles.height = 13
        words = " ".join(f"word{number:02}" for number in range(24))
        panel.show("B7", "Next: call number.", [], [], said=f"Tangy said: {words}")
        await pilot.pause()
        title = str(panel.border_title)
        below = " ".join(line.strip("│┃ ") for line in pilot.lines()[:2])
        told = f"{title.removeprefix('Now │ ').removesuffix(' …')} {below.removeprefix('… ')}"
        assert told.startswith(f"Tangy said: {words}")
        panel.show("B7", "Next: call number.", [], [])
        assert str(panel.border_title) == "Now"


async def test_a_low_panel_writes_the_call_in_words_and_shows_people(run: Run) -> None:
    people = [(f"User {number}", "asks 2 min", "warn") for number in range(1, 13)]
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.styles.height = 4  # as while Tangy asks in a small window
        panel.show("O-66", "Tangy waits for your answer.", ["1 called", "0:15 so far"], people)
        await pilot.pause()
        assert "O-66   1 called, 0:15 so far" in pilot.text() and "█" not in pilot.text()
        assert pilot.text().count("asks 2 min") >= 4


async def test_facts_of_a_game_without_calls_begin_where_people_do(run: Run) -> None:
    async with run(Panel(), size=(80, 24)) as pilot:
        panel = pilot.app.screen.query_one(StaffPanel)
        panel.show("", "Tangy waits.", ["0:15 so far"], [("User 1", "score 0", "text")])
        await pilot.pause()
        columns = {
            line.index(one) for line in pilot.lines() for one in ("0:15", "User 1") if one in line
        }
        assert len(columns) == 1
