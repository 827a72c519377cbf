"""Comparing, choosing and reviewing policies before use; driven with keys."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_profiles.teaching_records import PolicyLearnt
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import keep_policy, last_policy
from tangy_tui.learning.policy import ForestSettings
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.difference import DifferenceDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.compare import CompareScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.screens.policy import PolicyScreen
from tests.interaction.gaps import learnt, otherwise, without
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, TangyPilot, screen_text

Cover = Callable[[str, int, int], tuple[Demonstration, ...]]

FEW = ForestSettings(trees=5)
TINY = (60, 18)


def found(workspace: Workspace, behaviour: str) -> Situation:
    """Return the situation in which this behaviour is expected."""
    expected = workspace.activity.expected
    return next(s for s in workspace.activity.situations if expected[s] == behaviour)


@pytest.fixture
def workspace(tmp_path: Path, cover: Cover) -> Iterator[Workspace]:
    """A workspace with a policy that lacks a row, a later one that has it, and another teacher."""
    opened = Workspace(tmp_path / "data")
    shown = cover("bingo", 1, 4)
    gap = found(opened, "call number")
    keep_policy(
        opened.store,
        learnt(opened.store, opened.activity, [without(shown[0], gap), *shown[1:]], FEW),
    )
    keep_policy(opened.store, learnt(opened.store, opened.activity, [], FEW))
    other = [otherwise(d, gap, "joke", "ben") for d in shown]
    keep_policy(opened.store, learnt(opened.store, opened.activity, other, FEW))
    yield opened
    opened.close()


async def shown(pilot: TangyPilot, kind: type) -> Any:
    """Wait for a screen."""
    while not isinstance(pilot.app.screen, kind):
        await pilot.pause(0.02)
    await pilot.pause()
    return pilot.app.screen


async def compare_teachers(pilot: TangyPilot) -> CompareScreen:
    """Choose the two teachers at the end of the list."""
    program: Any = pilot.app
    program.action_compare()
    await shown(pilot, ChooseDialog)
    await pilot.press("end", "up", "enter")
    await pilot.pause()
    await shown(pilot, ChooseDialog)
    await pilot.press("end", "enter")
    screen: CompareScreen = await shown(pilot, CompareScreen)
    return screen


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL, LARGE], ids=["tiny", "small", "large"])
async def test_two_teachers_are_compared(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), size=size) as pilot:
        screen = await compare_teachers(pilot)
        assert "They differ in 1 of 11 situations." in " ".join(screen_text(pilot.app).split())
        first = screen.rows[0]
        assert (first.situation, first.same) == (found(workspace, "call number"), False)
        assert {first.a.behaviour, first.b.behaviour} == {"call number", "joke"}
        assert "A call number 100%" in screen_text(pilot.app)
        await pilot.press("D")
        await pilot.pause()
        assert len(screen.rows) == 1
        await pilot.press("2")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert "by ben." in screen_text(pilot.app)
        await pilot.press("escape", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert "by test." in screen_text(pilot.app)
        await pilot.press("escape", "escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


@pytest.mark.slow
async def test_the_policy_screen_explains_decisions_and_marks_contested_ones(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), size=LARGE) as pilot:
        await pilot.press("o", "enter")
        screen = await shown(pilot, PolicyScreen)
        kept = last_policy(workspace.store, workspace.activity.name)
        assert kept is not None
        assert kept.name in screen_text(pilot.app)
        assert "1 contested" in screen_text(pilot.app)
        assert "contested" in [row.behaviour for row in screen.query_one("#policy").rows]
        await pilot.press("down", "down", "enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert "How sure Tangy is" in screen_text(pilot.app)
        await pilot.press("escape", "w")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)


@pytest.mark.slow
async def test_two_versions_are_compared_from_the_policy_screen(
    run: Run, workspace: Workspace
) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("o", "enter")
        await shown(pilot, PolicyScreen)
        await pilot.press("C")
        await shown(pilot, ChooseDialog)
        await pilot.press("enter")
        screen = await shown(pilot, CompareScreen)
        assert any(not row.same for row in screen.rows)
        assert "asks: contested" in screen_text(pilot.app)


@pytest.mark.slow
async def test_an_earlier_policy_can_be_opened(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("o", "enter")
        last = await shown(pilot, PolicyScreen)
        await pilot.press("O")
        await shown(pilot, ChooseDialog)
        await pilot.press("end", "enter")
        while not isinstance(pilot.app.screen, PolicyScreen) or pilot.app.screen is last:
            await pilot.pause(0.02)
        screen: Any = pilot.app.screen
        assert len(screen.policy.demonstrations) < len(last.policy.demonstrations)


def spoil(workspace: Workspace) -> None:
    """Store the last policy as if another version had learnt it."""
    kept = last_policy(workspace.store, workspace.activity.name)
    assert kept is not None
    rows = (kept.rows[0]._replace(behaviour="something else"), *kept.rows[1:])
    versions = {**kept.versions, "scikit-learn": "0.1"}
    workspace.store.append(replace(kept, digest="0" * 64, rows=rows, versions=versions))


@pytest.mark.slow
@pytest.mark.parametrize(("key", "used", "kept"), [("n", 0, 0), ("y", 1, 0), ("1", 1, 1)])
async def test_a_mismatching_digest_is_reviewed_before_use(
    run: Run, workspace: Workspace, key: str, used: int, kept: int
) -> None:
    spoil(workspace)
    before = sum(1 for _ in workspace.store.events(PolicyLearnt))
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("o", "enter")
        dialog = await shown(pilot, DifferenceDialog)
        while not dialog.fresh_keys.seen:
            await pilot.pause(0.02)
        text = " ".join(screen_text(pilot.app).split())
        assert "is not the one that was kept" in text
        assert "scikit-learn" in text
        assert "was something else" in text
        await pilot.press("enter", "space")
        await pilot.pause()
        assert pilot.app.screen is dialog
        await pilot.press(key)
        await shown(pilot, PolicyScreen if used else HomeScreen)
        assert sum(1 for _ in workspace.store.events(PolicyLearnt)) == before + kept


@pytest.mark.slow
@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_comparison_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), size=size) as pilot:
        await compare_teachers(pilot)
        looks(pilot.app)


@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_policy_screen_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(app=Program(workspace, clock=StillClock()), size=size) as pilot:
        await pilot.press("o", "enter")
        await shown(pilot, PolicyScreen)
        looks(pilot.app)
