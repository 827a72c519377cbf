"""The drill, driven with keys: rounds, correct answers, leaving half-way, and the score sheet."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from typing import Any

import pytest
from textual.app import App

from tangy_profiles.drill_sheet import AnsweredRound, Sheet
from tangy_profiles.fault_file import load_faults
from tangy_profiles.faults import FaultBook
from tangy_profiles.game_records import DrillAnswered
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.drill import Drill
from tangy_tui.monitoring.drill_log import last_sheet, read_sheets
from tangy_tui.monitoring.drill_policy import DrillNote, DrillPolicy, policy_for_drill
from tangy_tui.monitoring.drill_rounds import DrillSimulator
from tangy_tui.text.drills import option_words
from tangy_tui.ui.dialogs.choose import ChooseDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.program import Program
from tangy_tui.ui.screens.drill import DrillScreen
from tangy_tui.ui.screens.help import HelpScreen
from tangy_tui.ui.screens.home import HomeScreen
from tests.pilot.conftest import LARGE, SMALL, Run, StillClock, TangyPilot
from tests.support.waiting import until_shown

TINY = (60, 18)
FEW = (
    "emergency-stop", "laser-disconnected", "camera-occluded", "path-blocked", "voice-dead",
    "requests-silent", "unexplained",
)  # fmt: skip
"""The rules for these drills, so that new rules do not change the pictures."""
SIZES = pytest.mark.parametrize("size", [TINY, SMALL, LARGE], ids=["tiny", "small", "large"])


def asked(drill: Drill) -> str:
    """Return what kind of question is open; "" for none."""
    return "" if drill.question is None else drill.question.kind


@pytest.fixture(scope="module")
def learnt(tmp_path_factory: pytest.TempPathFactory) -> DrillPolicy:
    """The policy of drills without demonstrations, made once for all tests."""
    folder = tmp_path_factory.mktemp("nothing") / "data"
    workspace = Workspace(folder)
    try:
        return policy_for_drill(workspace.store, workspace.activity)
    finally:
        workspace.close()


@pytest.fixture
def make(
    workspace: Workspace, learnt: DrillPolicy, clock: StillClock
) -> Callable[..., DrillScreen]:
    """A factory of drill screens: (rounds, seed) -> screen."""
    rules = load_faults(workspace.robot).rules
    few = FaultBook(tuple(rule for rule in rules if rule.code in FEW), "few")

    def screen(rounds: int = 6, seed: int = 1, note: DrillNote | None = None) -> DrillScreen:
        table = DrillSimulator(
            learnt.policy,
            learnt.effects,
            few,
            workspace.robot,
            workspace.activity,
            workspace.names,
        )
        drill = Drill(
            table, workspace.store, who="ada", seed=seed, rounds=rounds, clock=clock, note=note
        )
        return DrillScreen(drill)

    return screen


def drill_of(screen: DrillScreen) -> Drill:
    """Return a screen's drill."""
    return screen.drill


def on_top(pilot: TangyPilot, screen: DrillScreen) -> bool:
    """Return whether a screen has the focus."""
    return pilot.app.screen is screen


def right_key(drill: Drill) -> str:
    """Return the key of the right answer."""
    shown, question = drill.round, drill.question
    assert shown is not None
    assert question is not None
    right = {
        "what": shown.code,
        "do": shown.recovery,
        "clear": "yes" if shown.release and shown.release.right else "no",
    }[question.kind]
    return next(choice.key for choice in question.choices if choice.value == right)


async def answer_round(pilot: TangyPilot, drill: Drill) -> None:
    """Answer a round correctly."""
    while drill.question is not None:
        await pilot.press(right_key(drill))
        await pilot.pause()


@pytest.mark.slow
@SIZES
async def test_a_drill_leads_to_its_score_sheet(
    run: Run, make: Callable[..., DrillScreen], workspace: Workspace, size: tuple[int, int]
) -> None:
    screen = make(4)
    drill = drill_of(screen)
    async with run(screen, size) as pilot:
        assert "Ready?" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        for number in range(1, 5):
            text = pilot.text()
            assert f"{number} of 4" in text
            assert drill.question is not None
            for choice in drill.question.choices:
                words = option_words(drill.question, choice)
                assert f" {choice.key}  {words}" in text, "every answer can be seen"
            for label in ("Now", "Noticed"):
                assert label in text
            await answer_round(pilot, drill)
            assert "Right: " in pilot.text()
            await pilot.press("enter")
            await pilot.pause()
        text = pilot.text()
        assert f"ada: {drill.sheet.points} of {drill.sheet.most} points." in text
        assert "The sheet is kept." in text
    assert [sheet.finished for sheet in read_sheets(workspace.store)] == [True]


@pytest.mark.slow
@pytest.mark.parametrize(("seed", "wrong"), [(1, False), (1, True)], ids=["right", "wrong"])
async def test_drill_rounds_match_their_snapshots(
    run: Run,
    make: Callable[..., DrillScreen],
    clock: StillClock,
    looks: Callable[[App[Any]], None],
    seed: int,
    wrong: bool,
) -> None:
    screen = make(4, seed)
    drill = drill_of(screen)
    async with run(screen) as pilot:
        await pilot.press("enter")
        await pilot.pause()
        if not wrong:
            looks(pilot.app)
            return
        while not drill.over:
            clock.advance(7)
            while drill.question is not None:
                keys = [key for key in drill.question.keys if key != right_key(drill)]
                await pilot.press(keys[0])
                await pilot.pause()
            await pilot.press("enter")
            await pilot.pause()
        looks(pilot.app)


async def test_leaving_half_way_asks_and_keeps_an_unfinished_drill(
    run: Run, make: Callable[..., DrillScreen], workspace: Workspace
) -> None:
    screen = make(4)
    drill = drill_of(screen)
    async with run() as pilot:
        await pilot.app.push_screen(screen)
        await pilot.pause()
        await pilot.press("enter")
        await pilot.pause()
        await answer_round(pilot, drill)
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("escape")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await pilot.press("n")
        await pilot.pause()
        assert on_top(pilot, screen)
        assert drill.question is not None, "the round goes on"
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("y")
        await pilot.pause()
        await pilot.pause()
        assert not on_top(pilot, screen)
    kept = last_sheet(workspace.store)
    assert kept is not None
    assert (len(kept.answered), kept.finished) == (1, False)


async def test_leaving_before_the_first_answer_keeps_nothing(
    run: Run, make: Callable[..., DrillScreen], workspace: Workspace
) -> None:
    screen = make(4)
    async with run() as pilot:
        await pilot.app.push_screen(screen)
        await pilot.press("enter", "1", "escape")
        await pilot.pause()
        assert not on_top(pilot, screen)
    assert last_sheet(workspace.store) is None


async def test_quitting_half_way_keeps_the_answers(
    run: Run, make: Callable[..., DrillScreen], workspace: Workspace
) -> None:
    screen = make(4)
    async with run(screen) as pilot:
        await pilot.press("enter")
        await pilot.pause()
        await answer_round(pilot, drill_of(screen))
        await pilot.press("ctrl+c")
        await pilot.pause()
    kept = last_sheet(workspace.store)
    assert kept is not None
    assert len(kept.answered) == 1


async def test_keys_typed_ahead_do_not_answer(
    run: Run, make: Callable[..., DrillScreen], clock: StillClock
) -> None:
    screen = make(4)
    drill = drill_of(screen)
    async with run(screen, clock=clock) as pilot:
        await pilot.press("enter")
        await pilot.pause()
        clock.now = monotonic() + 1000
        await pilot.press("1")  # this question had been there before
        await pilot.pause()
        assert drill.question is not None
        assert drill.question.kind == "do"
        pilot.type("1", "1", "enter")
        await pilot.pause()
        assert drill.question is not None
        assert drill.question.kind == "do"
        pilot.type("1", at=clock.now + 1)
        await pilot.pause()
        assert asked(drill) in ("", "clear")


async def test_other_keys_do_nothing_and_help_opens(
    run: Run, make: Callable[..., DrillScreen]
) -> None:
    screen = make(4)
    drill = drill_of(screen)
    async with run(screen) as pilot:
        await pilot.press("1", "y")
        await pilot.pause()
        assert drill.round is None
        await pilot.press("enter")
        await pilot.pause()
        await pilot.press("y", "9", "x", "enter", "down", "up", "ctrl+x")
        await pilot.pause()
        assert drill.question is not None
        assert drill.question.kind == "what"
        await pilot.press("question_mark")
        await pilot.pause()
        assert isinstance(pilot.app.screen, HelpScreen)
        text = " ".join(pilot.text().split())
        assert "0 to 4 Answer" in text
        assert "kept as an unfinished drill" in text
        await pilot.press("escape")
        await pilot.pause()
        assert on_top(pilot, screen)


async def test_a_note_is_shown_before_the_drill(run: Run, make: Callable[..., DrillScreen]) -> None:
    async with run(make(1, 1, "nothing learnt")) as pilot:
        assert "Tangy has learnt nothing yet" in pilot.text()


@pytest.mark.slow
async def test_home_opens_the_drill_and_shows_its_score(run: Run, workspace: Workspace) -> None:
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        assert "what to do when things go wrong" in pilot.text()
        await pilot.press("r", "enter")
        while not isinstance(pilot.app.screen, DrillScreen):
            await pilot.pause(0.02)
        screen = pilot.app.screen
        await pilot.pause()
        assert "Tangy has learnt nothing yet" in pilot.text()
        await pilot.press("enter")
        await pilot.pause()
        await answer_round(pilot, drill_of(screen))
        points = drill_of(screen).sheet.points
        await pilot.press("escape")
        await pilot.pause()
        await pilot.press("y")
        while not isinstance(pilot.app.screen, HomeScreen):
            await pilot.pause(0.02)
        await pilot.pause()
        assert f"last: {points} of {points} points" in pilot.text()


async def test_an_interrupted_drill_is_offered_and_resumed(run: Run, workspace: Workspace) -> None:
    right = AnsweredRound(1, "", "Nothing was wrong", "continue", (), "", "continue", 2.0)
    sheet = Sheet(workspace.teacher, workspace.activity.name, 3, 2, (right,))
    workspace.store.append(DrillAnswered(sheet=sheet))
    async with run(app=Program(workspace, clock=StillClock())) as pilot:
        await pilot.press("r", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("escape")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, HomeScreen))
        await pilot.press("r", "enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, ChooseDialog))
        await pilot.press("enter")
        await until_shown(pilot, lambda: isinstance(pilot.app.screen, DrillScreen))
        await pilot.pause()
        await pilot.press("enter")
        await pilot.pause()
        screen = pilot.app.screen
        assert isinstance(screen, DrillScreen) and drill_of(screen).number == 2
        await answer_round(pilot, drill_of(screen))
        assert drill_of(screen).over
    kept = last_sheet(workspace.store)
    assert kept is not None and kept.finished


def test_the_demonstrations_for_a_drill_are_not_stored(
    workspace: Workspace, learnt: DrillPolicy
) -> None:
    assert learnt.note
    store: Store = workspace.store
    assert list(store.events()) == []
