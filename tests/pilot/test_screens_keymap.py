"""The keymap on the screens: no letter changes stored data, and every custom key works."""

from __future__ import annotations

import string
from collections.abc import Callable, Coroutine
from functools import partial
from typing import Any

import pytest
from textual.binding import Binding
from textual.widgets import Input

from tangy_tui.app.keymap import ACTIONS, BY_ID, Keymap, is_letter
from tangy_tui.app.training import learn
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.scripted_teacher import SCRIPTED, ScriptedTeacher
from tangy_tui.ui.listing import listed
from tangy_tui.ui.program import Program
from tangy_tui.ui.round_trip import ReplyParser
from tangy_tui.ui.screens.demonstrations import DemonstrationsScreen
from tangy_tui.ui.screens.help import help_for
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.people import PeopleScreen
from tangy_tui.ui.screens.play import PlayScreen
from tangy_tui.ui.screens.teach import TeachScreen
from tests.pilot.conftest import Run, StillClock, TangyPilot
from tests.pilot.live_games import HeldLink, held_world, live, live_program, paused_after
from tests.support.waiting import until

LETTERS = (*string.ascii_letters, "slash", "asterisk", "full_stop", "less_than_sign")

ROOM = (160, 45)  # every panel of a screen is visible, and can have the focus

Opens = Callable[[Program], Coroutine[Any, Any, None]]


@pytest.fixture
def taught(workspace: Workspace) -> Workspace:
    """A workspace with a demonstration, and the policy learnt from it."""
    teaching = workspace.teaching(SCRIPTED, 1)
    teacher = ScriptedTeacher(teaching)
    teaching.begin()
    for _ in teacher.demonstrate():
        pass
    learn(workspace)
    return workspace


async def teach(program: Program) -> None:
    await program.push_screen(TeachScreen(program.workspace, program.workspace.teaching("ann", 3)))


async def library(program: Program) -> None:
    await program.push_screen(DemonstrationsScreen(program.workspace))


async def people(program: Program) -> None:
    await program.push_screen(PeopleScreen(program.workspace))


async def policy(program: Program) -> None:
    program.run_worker(program.open_policy(learn(program.workspace)))


async def play(program: Program) -> None:
    workspace = program.workspace
    supervision = workspace.supervision(learn(workspace), 5)
    screen = PlayScreen(workspace, supervision, games=1, speed=1)
    await program.push_screen(screen)
    screen.action_pause()


async def home(program: Program) -> None:
    """Stay at home."""


def kept(workspace: Workspace) -> list[int]:
    """Return the numbers of the log's events."""
    return [event.seq for event in workspace.store.events()]


def changed(workspace: Workspace, before: list[int]) -> bool:
    """Return whether the log has a new event."""
    return kept(workspace) != before


async def back(pilot: TangyPilot, screen: object) -> None:
    """Close any dialog that a letter has opened, without an answer."""
    for _ in range(4):
        if pilot.app.screen is screen:
            return
        await pilot.press("escape")
        await pilot.pause()


@pytest.mark.slow
@pytest.mark.parametrize("opens", [home, teach, library, people, policy, play])
async def test_no_letter_changes_stored_data_on_any_panel(
    run: Run, taught: Workspace, opens: Opens
) -> None:
    async with run(app=Program(taught, opens, clock=StillClock()), size=ROOM) as pilot:
        await pilot.pause()
        screen = pilot.app.screen
        before = kept(taught)
        panels = [widget for widget in screen.query("*") if widget.focusable]
        for panel in (None, *panels):
            for letter in LETTERS:
                if opens is play and letter in ("p", "full_stop"):
                    continue  # these keys let the simulated game continue
                screen.set_focus(panel)
                pilot.type(letter)
                await pilot.pause()
                assert kept(taught) == before, f"{letter} on {panel}"
                await back(pilot, screen)
                for line in screen.query(Input):
                    line.clear()
        assert panels or opens is home


GAME_MOVES = {"p": "pause or go on", "full_stop": "one step"}
"""Letters that take effect without a question: the simulated game runs or pauses."""

PACE = ("less_than_sign", "greater_than_sign")
STAFF_SAYS = {"i": "autonomy", "c": "call again", "o": "take over"}
"""Commands of staff in a live game that take effect at once and can be revised."""


@pytest.mark.slow
async def test_the_game_keys_only_move_the_simulated_game(run: Run, taught: Workspace) -> None:
    async with run(app=Program(taught, play, clock=StillClock()), size=ROOM) as pilot:
        await pilot.pause()
        for letter in (*GAME_MOVES, "p"):
            before = set(kept(taught))
            pilot.type(letter)
            await pilot.pause()
            new = {event.kind for event in taught.store.events() if event.seq not in before}
            assert new <= {
                "game step",
                *(["staff action"] if letter in ("p", "full_stop") else []),
            }, letter


@pytest.mark.slow
async def test_no_letter_changes_a_live_game_without_a_question(
    run: Run, taught: Workspace
) -> None:
    link = HeldLink()
    world = held_world(taught, link)
    async with run(app=live_program(taught, world, learn(taught)), size=ROOM) as pilot:
        await paused_after(pilot, link, 3)
        screen = live(pilot)
        for letter in LETTERS:
            if letter in STAFF_SAYS or letter in ("p", "d", "slash", *PACE):
                # p continues; in the dialog of d only arrows drive; / begins to filter;
                # each key of the pace undoes the other
                continue
            before, told = kept(taught), list(link.told)
            pilot.type(letter)
            await pilot.pause()
            await back(pilot, screen)
            assert (kept(taught), link.told) == (before, told), letter
            assert not screen.control.going, letter
        for letter in STAFF_SAYS:
            before, told = kept(taught), list(link.told)
            pilot.type(letter)
            await pilot.pause()
            await until(partial(changed, taught, before))
            new = [event for event in taught.store.events() if event.seq not in before]
            assert [event.kind for event in new] == ["staff action"], letter
            assert link.told == told, letter


@pytest.mark.slow
@pytest.mark.parametrize("opens", [home, library, people, play])
async def test_pasted_text_runs_only_a_stop(
    run: Run, taught: Workspace, opens: Opens, monkeypatch: pytest.MonkeyPatch
) -> None:
    async with run(app=Program(taught, opens, clock=StillClock())) as pilot:
        await pilot.pause()
        app, stops = pilot.app, list[bool]()
        monkeypatch.setattr(app, "action_stop", lambda: stops.append(True))
        screen, before = app.screen, kept(taught)

        async def paste(text: str) -> None:
            for message in ReplyParser().feed(text):
                app.post_message(message)
            await pilot.pause()

        for text in ("greet everyone\r", "xyEyMy\r", "\x1b[200~greet everyone\r\x1b[201~"):
            await paste(text)
            assert app.screen is screen
            assert kept(taught) == before
            assert stops == []
        for text in ("stop the robot\r", "\x1b[200~please stop the robot\x1b[201~"):
            await paste(text)
            assert stops.pop()
            assert app.screen is screen


async def test_a_few_simultaneous_characters_count_as_keys(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.pause()
        for message in ReplyParser().feed("e\r"):
            pilot.app.post_message(message)
        await pilot.pause()
        assert isinstance(pilot.app.screen, PeopleScreen)


@pytest.mark.slow
@pytest.mark.parametrize("opens", [home, teach, library, people, policy, play])
async def test_help_and_palette_list_every_action_of_a_screen(
    run: Run, taught: Workspace, opens: Opens
) -> None:
    async with run(app=Program(taught, opens, clock=StillClock()), size=ROOM) as pilot:
        await pilot.pause()
        screen = pilot.app.screen
        classes = (*type(screen).__mro__, *type(pilot.app).__mro__)
        made = [binding for cls in classes for binding in vars(cls).get("BINDINGS", ())]
        bound = {one.id or "" for one in made if isinstance(one, Binding) and one.id in BY_ID}
        bound = {id for id in bound if not BY_ID[id].fixed}
        here = {one.word for one in listed(screen)}
        elsewhere = {"talk", "listen", "command", "zoom", "filter"}  # only where they have a use
        assert {BY_ID[str(id)].word for id in bound - elsewhere} <= here
        help = help_for(screen)
        assert len(help.here) + len(help.everywhere) >= len(here)


CHANGED = {"undo": ("f12",), "learn": ("ctrl+n",), "pause": ("semicolon",), "put_away": ("z",)}


async def test_custom_keys_work_and_are_shown(run: Run, taught: Workspace) -> None:
    program = Program(taught, library, clock=StillClock(), keymap=Keymap(CHANGED))
    async with run(app=program) as pilot:
        await pilot.pause()
        assert "z put away" in pilot.lines()[-1]
        before = kept(taught)
        pilot.type("x")
        await pilot.pause()
        assert isinstance(pilot.app.screen, DemonstrationsScreen)
        pilot.type("z")
        await pilot.pause()
        pilot.type("y")
        await pilot.pause()
        deleted = kept(taught)
        assert len(deleted) == len(before) + 1
        await pilot.press("f2")
        assert kept(taught) == deleted
        await pilot.press("f12")
        assert len(kept(taught)) == len(deleted) + 1


async def test_a_letter_at_home_selects_and_enter_opens(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("t")
        assert isinstance(pilot.app.screen, HomeScreen)
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, TeachScreen)


def test_actions_beside_a_command_line_use_no_letters() -> None:
    typing = [action for action in ACTIONS if action.with_line]
    assert all(not is_letter(Keymap().keys(a.id)[0]) for a in typing)
