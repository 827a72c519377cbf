"""Home opens one screen at a time, however fast the keys arrive."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from textual import events

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_tui.app import robot_opening
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import keep_policy
from tangy_tui.learning.policy import Policy
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.home import HomeScreen, Menu
from tangy_tui.ui.screens.live import LiveScreen
from tangy_tui.ui.screens.set_up import SetUpScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock, screen_text
from tests.pilot.live_games import HeldLink, held_world, live
from tests.support.append_body import append_body
from tests.support.waiting import until_shown


@pytest.mark.slow
@pytest.mark.parametrize("keys", ["tt", "gg", "ee", "ii", "tgiep", "dd", "de"])
async def test_a_repeated_key_opens_one_screen(keys: str, run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.type(*(key for letter in keys for key in (letter, "enter")))
        for _ in range(4):
            await pilot.pause(0.05)
        assert isinstance(pilot.app.screen_stack[0], HomeScreen)
        assert len(pilot.app.screen_stack) == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    "words", ["call number", "greet everyone", "play bingo", "mark it", "delete all", "PLEASE GO"]
)
async def test_words_typed_at_home_begin_nothing_and_tell_where_they_belong(
    words: str, run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), notifications=True) as pilot:
        pilot.type(*("space" if letter == " " else letter for letter in words), "enter")
        await pilot.pause()
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)
        assert read_library(workspace.store, "bingo").entries == {}
        *_, told = (one.message for one in pilot.app._notifications)
        assert f"{words[-2:]}” began nothing" in told
        await pilot.press("t", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, TeachScreen))


async def test_pasted_words_at_home_begin_nothing(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.app.post_message(events.Paste("call number"))
        await pilot.pause()
        await pilot.press("enter")
        await pilot.pause()
        assert len(pilot.app.screen_stack) == 1


@pytest.mark.parametrize(
    ("keys", "name"),
    [
        ("live", "Live"), ("li", "Library"), ("learn", "Learn"), ("Sens", "Sensors"),
        ("gp", "Play"), ("j", "Guided"), ("jj", "Library"), ("p", "Play"),
    ],
)  # fmt: skip
async def test_a_line_is_found_by_its_letter_or_its_name(
    keys: str, name: str, run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.type(*keys)
        await pilot.pause()
        assert pilot.app.screen.query_one(Menu).chosen.name == name


@pytest.mark.parametrize("letters", ["t", "m", "call"])
async def test_the_help_opens_after_any_letters(
    letters: str, run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.type(*letters, "question_mark")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HelpScreen))


@pytest.mark.parametrize(
    ("keys", "opens"),
    [
        (("h", "x"), True), ((*"hel",), True), ((*"hex",), False), ((*"he", "space", "x"), False),
        ((*"hex", "backspace"), True), ((*"xyz", "h"), False), ((*"xyz", "up", "down", "h"), True),
        (("h", "1"), True), (("h", "1", "2"), True), ((*"he1",), False), (("space", "h"), True),
        (("k", "j", "h"), True), ((*"hex", "enter", "h"), True),
    ],
)  # fmt: skip
async def test_enter_opens_the_line_unless_three_letters_name_no_line(
    keys: tuple[str, ...], opens: bool, run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.type(*keys, "enter")
        await pilot.pause()
        await pilot.pause()
        assert isinstance(pilot.app.screen, HelpScreen if opens else HomeScreen)


async def test_a_second_letter_that_begins_no_name_is_still_a_key(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), notifications=True) as pilot:
        pilot.type("m", "m")  # the mouse off and on again
        await pilot.pause()
        await pilot.pause()
        assert len(pilot.app._notifications) == 2


@pytest.mark.slow
async def test_a_repeated_enter_begins_one_demonstration(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        pilot.type("t", "enter", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)
        pilot.type(*"greet everyone", "enter")
        await pilot.pause()
        pilot.type("y")
        await pilot.pause()
        assert len(read_library(workspace.store, "bingo").entries) <= 1


async def test_keys_read_before_the_first_screen_was_shown_do_nothing(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        for key in ("t", "enter", "f8"):
            early = events.Key(key, None)
            early.time = 0.0
            pilot.app.post_message(early)
        await pilot.pause()
        await pilot.pause()
        assert len(pilot.app.screen_stack) == 1
        await pilot.press("t", "enter")
        assert isinstance(pilot.app.screen, TeachScreen)


async def test_a_stop_read_before_the_first_screen_was_shown_counts(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        reasons: list[str] = []
        monkeypatch.setattr(pilot.app, "stop", reasons.append)
        early = events.Key("ctrl+x", None)
        early.time = 0.0
        pilot.app.post_message(early)
        await pilot.pause()
        assert len(reasons) == 1


async def test_stop_at_home_says_that_nothing_moves(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        said: list[str] = []
        monkeypatch.setattr(pilot.app, "say", lambda sentence, **more: said.append(sentence))
        await pilot.press("ctrl+x")
        assert said == ["Nothing is moving."]
        await pilot.press("t", "enter")
        await pilot.pause()
        await pilot.press("ctrl+x")
        assert said == ["Nothing is moving."]


@pytest.mark.slow
async def test_v_asks_before_a_live_game_on_the_bench(
    run: Run, workspace: Workspace, policy: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    keep_policy(workspace.store, policy)
    link, opened = HeldLink(), list[bool]()

    @contextmanager
    def bench(_: Workspace, **__: Any) -> Iterator[LiveWorld]:
        opened.append(True)
        yield held_world(workspace, link)
        opened.append(False)

    monkeypatch.setattr(robot_opening, "open_bench", bench)
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await until_shown(pilot, lambda: "no robot is named" in screen_text(pilot.app))
        for answer in ("escape", "B"):
            assert opened == []
            await pilot.press("v", "enter")
            await until_shown(pilot, lambda: isinstance(pilot.app.screen, SetUpScreen))
            await pilot.press(answer)
            await until_shown(pilot, lambda: not isinstance(pilot.app.screen, SetUpScreen))
            if answer == "escape":  # home opens nothing during a closing
                await until_shown(pilot, lambda: all(w.is_finished for w in pilot.app.workers))
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, LiveScreen))
        await until_shown(pilot, lambda: live(pilot).control.supervision.steps >= 1)
        assert opened == [True]
        await pilot.press("escape")
        await until_shown(pilot, lambda: "Leave in the middle" in screen_text(pilot.app))
        await pilot.press("y")
        await until_shown(pilot, lambda: opened == [True, False])
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_v_needs_a_learnt_policy(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("v", "enter")
        await until_shown(pilot, lambda: "has not learnt" in screen_text(pilot.app))


async def test_home_reports_events_that_are_left_out_of_the_log(
    run: Run, workspace: Workspace
) -> None:
    store = workspace.store
    append_body(store, "policy learnt", {**POLICY_BODY, "name": "lost"})
    db = store.file.db
    assert db is not None
    db.executescript("DROP TRIGGER unchanged; UPDATE event SET body = '{'")
    store.notices.append("tangy.db: events 5 to 9 had been kept and are gone.")
    program = Program(workspace, clock=StillClock())
    async with run(app=program) as pilot:
        shown = program._notifications
        await until_shown(pilot, lambda: len(shown) == 2)
        first, second = (note.message for note in shown)
        assert "events 5 to 9 had been kept and are gone" in first
        assert "(policy learnt) is damaged and left out: its body is not JSON." in second


POLICY_BODY: dict[str, Any] = {
    **{"activity": "bingo", "demonstrations": [], "forest": {}, "versions": {}},
    **{"digest": "0", "rows": []},
}
