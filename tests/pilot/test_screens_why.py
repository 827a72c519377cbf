"""Why this?: the explanation of a decision, read and opened with keys, at both sizes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.beliefs import Beta
from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.persuasion import StrategyChoice
from tangy_tui.learning.explanation import DecisionReasons, explain
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policies import load_policy
from tangy_tui.ui.dialogs.why import MOST, WhyDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.demonstration import DemonstrationScreen
from tangy_tui.ui.screens.home import HomeScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.widgets.page import Page
from tangy_tui.ui.widgets.transcript import Transcript
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, screen_text

TINY = (60, 18)


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


def why_of(workspace: Workspace, behaviour: str) -> DecisionReasons:
    """Return the explanation of the first situation with a decision."""
    policy, _ = load_policy(workspace.store, workspace.activity)
    shown = read_library(workspace.store, workspace.activity.name).demonstrations
    expected = workspace.activity.expected
    situation = next(s for s in workspace.activity.situations if expected[s] == behaviour)
    return explain(policy, shown, situation)


def a_choice(workspace: Workspace) -> StrategyChoice:
    """Return a choice among all strategies, as Thompson sampling makes it."""
    rng = Random(3)
    beliefs = {s: Beta(2.0 + n, 1.0 + n / 2) for n, s in enumerate(workspace.activity.strategies)}
    draws = {s: rng.betavariate(b.alpha, b.beta) for s, b in beliefs.items()}
    return StrategyChoice(
        "user2", max(draws, key=lambda s: draws[s]), draws, beliefs, "Thompson sampling"
    )


def showing(
    workspace: Workspace,
    why: DecisionReasons,
    choice: StrategyChoice | None = None,
    *,
    ascii: bool = False,
) -> Program:
    """Make the program with the dialog open."""

    async def start(program: Program) -> None:
        await program.push_screen(WhyDialog(workspace, why, choice))

    return Program(workspace, start, clock=StillClock(), kind=TerminalKind(ascii=ascii))


def persuading(workspace: Workspace) -> str:
    """Return a behaviour that persuades."""
    return next(b.name for b in workspace.activity.behaviours.values() if b.persuades)


@pytest.mark.slow
@pytest.mark.parametrize("size", [TINY, SMALL, LARGE], ids=["tiny", "small", "large"])
async def test_the_dialog_shows_votes_before_draws(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    why, choice = why_of(workspace, persuading(workspace)), a_choice(workspace)
    async with run(app=showing(workspace, why, choice), size=size) as pilot:
        await pilot.pause()
        seen = screen_text(pilot.app)
        for _ in range(30):
            await pilot.press("down")
            seen += screen_text(pilot.app)
        assert workspace.activity.in_words(why.situation).partition(" · ")[0] in seen
        assert "How sure Tangy is" in seen
        assert "Thompson sampling" in seen
        for strategy, number in choice.draws.items():
            assert strategy in seen
            assert f"{number:.3f}" in seen
        assert f"Based on {len(why.rests_on)} step" in seen


@pytest.mark.slow
async def test_enter_opens_the_demonstrated_step(run: Run, workspace: Workspace) -> None:
    why = why_of(workspace, persuading(workspace))
    async with run(app=showing(workspace, why)) as pilot:
        await pilot.press("down", "enter")
        await pilot.pause()
        screen: Any = pilot.app.screen
        assert isinstance(screen, DemonstrationScreen)
        page = pilot.app.screen_stack[-2].query_one(Page)
        assert page.chosen is not None
        step = why.steps[page.chosen]
        assert screen.query_one(Transcript).chosen == step.number
        assert f"{step.number} {workspace.activity.in_words(why.situation)}" in screen_text(
            pilot.app
        )
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HomeScreen)


async def test_an_undemonstrated_situation_shows_the_nearest_steps(
    run: Run, workspace: Workspace
) -> None:
    policy, _ = load_policy(workspace.store, workspace.activity)
    shown = read_library(workspace.store, workspace.activity.name).demonstrations
    never = next(s for s, d in policy.table.items() if not d.seen and s.stage == "help")
    why = explain(policy, shown, Situation(*never))
    async with run(app=showing(workspace, why), size=LARGE) as pilot:
        await pilot.pause()
        assert "Nobody has shown Tangy what to do here" in screen_text(pilot.app)
        assert "Shown nearby" in screen_text(pilot.app)


@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_explanation_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    why = why_of(workspace, persuading(workspace))
    async with run(size=size) as pilot:  # above an empty screen, to compare the dialog alone
        await pilot.app.push_screen(WhyDialog(workspace, why, a_choice(workspace)))
        await pilot.pause()
        looks(pilot.app)


async def test_the_explanation_is_readable_in_ascii(run: Run, workspace: Workspace) -> None:
    why = why_of(workspace, persuading(workspace))
    ascii_app = showing(workspace, why, a_choice(workspace), ascii=True)
    async with run(app=ascii_app) as pilot:
        await pilot.pause()
        assert pilot.text().isascii()


async def test_the_newest_of_many_steps_come_first_and_the_others_on_demand(
    run: Run, workspace: Workspace
) -> None:
    why = why_of(workspace, "call number")
    steps = tuple(replace(why.rests_on[0], number=number) for number in range(1, 101))
    many = replace(why, rests_on=steps, against=(), near=())
    async with run(app=showing(workspace, many), size=LARGE) as pilot:
        await pilot.pause()
        page = pilot.app.screen.query_one(Page)
        assert page.chosen == 99  # the index of the newest
        await pilot.press("end")
        assert page.cursor == MOST and page.chosen is not None and page.chosen >= len(steps)
        await pilot.press("enter")
        await pilot.pause()
        assert isinstance(pilot.app.screen, WhyDialog)
        assert page.cursor == MOST and page.chosen == 99 - MOST
        await pilot.press("end")
        assert page.chosen == 0
