"""The phrasebook on a screen: reading, searching, playing, and editing a pronunciation."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest
from textual.app import App

from tangy_profiles.errors import TangyError
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.keys import NAMES
from tangy_tui.ui.dialogs.pronunciation import PhonesInput, PronunciationDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.phrases import PhrasesScreen
from tests.pilot.conftest import StillClock

if TYPE_CHECKING:
    from tests.pilot.conftest import Run, TangyPilot

NEW_NAME = "Xanthippe"


@pytest.fixture
def spoken() -> list[str]:
    """The spoken phones."""
    return []


@pytest.fixture
def screen(workspace: Workspace, spoken: list[str]) -> PhrasesScreen:
    """The screen, in a workspace with one name that the dictionary lacks."""
    workspace.rename(workspace.people[0], "Rosa")
    workspace.rename(workspace.people[1], NEW_NAME)

    async def say(phones: str) -> None:
        spoken.append(phones)

    return PhrasesScreen(workspace, say)


async def looked_up(pilot: TangyPilot) -> None:
    """Wait for the words' look-up, which runs in the background."""
    await pilot.pause()  # until the typed text has started it
    await pilot.app.workers.wait_for_complete()
    await pilot.pause()


async def find(pilot: TangyPilot, *keys: str) -> None:
    """Search, and go to the first hit."""
    await looked_up(pilot)
    pilot.type("slash")
    await pilot.pause()
    pilot.type(*keys, "enter")
    await pilot.pause()
    pilot.type("home")
    await pilot.pause()


@pytest.mark.slow
async def test_the_screen_shows_behaviours_people_seats_and_words(
    run: Run, screen: PhrasesScreen
) -> None:
    async with run(screen) as pilot:
        await looked_up(pilot)
        assert "greet everyone" in pilot.text()
        await find(pilot, *"rosa")
        assert "user 1, rosa, seat 1" in pilot.text()
        assert "R OW Z AH" in pilot.text()
        assert "greet everyone" not in pilot.text()
        pilot.type("escape", "home")
        await pilot.pause()
        assert "greet everyone" in pilot.text()
        pilot.type("end")
        await pilot.pause()
        assert "Y UW Z ER" in pilot.text()


@pytest.mark.slow
async def test_an_unrecognisable_name_is_marked_until_its_pronunciation_is_accepted(
    run: Run, screen: PhrasesScreen, workspace: Workspace
) -> None:
    async with run(screen) as pilot:
        await find(pilot, *"xanthippe")
        assert "Cannot be heard, only typed" in pilot.text()
        pilot.type("N")
        await pilot.pause()
        dialog = pilot.app.screen
        assert isinstance(dialog, PronunciationDialog)
        suggested = dialog.query_one(PhonesInput).value
        pilot.type("enter", at=1e9)
        await looked_up(pilot)
        assert workspace.find_person("user2").pronunciation == suggested
        assert "Cannot be heard, only typed" not in pilot.text()
        assert suggested in pilot.text()


async def test_entries_and_names_are_played(
    run: Run, screen: PhrasesScreen, spoken: list[str]
) -> None:
    async with run(screen) as pilot:
        await find(pilot, *"rosa")
        pilot.type("H")
        await pilot.pause()
        pilot.type("N")
        await pilot.pause()
        dialog = pilot.app.screen
        dialog.query_one(PhonesInput).value = "r oh"
        await pilot.pause()
        pilot.type("ctrl+g", at=1e9)
        await pilot.pause()
        assert "there is no phone 'OH'; did you mean 'OW'?" in pilot.text()
        dialog.query_one(PhonesInput).value = "r ow1 s ah"
        await pilot.pause()
        pilot.type("ctrl+g", at=1e9)
        await pilot.pause()
        assert spoken == ["R OW Z AH", "R OW S AH"]


@pytest.mark.slow
async def test_an_empty_line_deletes_the_pronunciation_and_esc_keeps_it(
    run: Run, screen: PhrasesScreen, workspace: Workspace
) -> None:
    workspace.pronounce(workspace.people[0], "R AO S AH")
    async with run(screen) as pilot:
        await find(pilot, *"rosa")
        pilot.type("N")
        await pilot.pause()
        pilot.app.screen.query_one(PhonesInput).value = "R"
        pilot.type("escape", at=1e9)
        await pilot.pause()
        assert workspace.find_person("user1").pronunciation == "R AO S AH"
        pilot.type("N")
        await pilot.pause()
        pilot.app.screen.query_one(PhonesInput).value = ""
        pilot.type("enter", at=1e9)
        await pilot.pause()
        assert workspace.find_person("user1").pronunciation is None


async def test_a_failed_playback_is_reported(run: Run, workspace: Workspace) -> None:
    async def fails(phones: str) -> None:
        raise TangyError("No sound comes out here.")

    async with run(PhrasesScreen(workspace, fails), notifications=True) as pilot:
        await looked_up(pilot)
        pilot.type("H")
        await pilot.pause()
        assert "No sound comes out here." in pilot.text()
        pilot.type("N")
        await pilot.pause()
        assert "Choose a person" in pilot.text()


async def test_the_smallest_size_matches_its_snapshot(
    run: Run, screen: PhrasesScreen, looks: Callable[[App[Any]], None]
) -> None:
    async with run(screen) as pilot:
        await looked_up(pilot)
        looks(pilot.app)


@pytest.mark.slow
async def test_the_palette_opens_the_phrases_and_esc_goes_back(
    run: Run, workspace: Workspace
) -> None:
    program = Program(workspace, clock=StillClock())
    async with run(app=program) as pilot:
        await pilot.press("ctrl+p", *"phrases")
        while NAMES["phrases"].name not in pilot.text():
            await pilot.pause(0.02)
        await pilot.press("enter")
        while not isinstance(program.screen, PhrasesScreen):
            await pilot.pause(0.02)
        await looked_up(pilot)
        assert isinstance(program.screen, PhrasesScreen)
        pilot.type("escape")
        await pilot.pause()
        assert not isinstance(program.screen, PhrasesScreen)
