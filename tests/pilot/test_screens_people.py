"""The people screen: which strategies work with each person, and corrections by staff."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from textual.app import App

from tangy_profiles.people_records import ResponseAwaited
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.feedback import Feedback
from tangy_tui.text.people import NO_REQUESTS
from tangy_tui.ui.dialogs.answer import AnswerDialog
from tangy_tui.ui.dialogs.confirm import ConfirmDialog
from tangy_tui.ui.dialogs.method import MethodDialog
from tangy_tui.ui.dialogs.pronunciation import PhonesInput, PronunciationDialog
from tangy_tui.ui.screens.people import PeopleScreen
from tangy_tui.ui.terminal import TerminalKind
from tangy_tui.ui.themes import LIGHT
from tangy_tui.ui.widgets.choice_list import ChoiceList
from tests.pilot.conftest import LARGE, SMALL, Run, TangyPilot
from tests.support.append_body import append_body

NOW = datetime(2026, 5, 22, 15, tzinfo=UTC)

GAMES = (
    (24, {"user1": "neutral- praise+ praise+ suggestion-", "user2": "scarcity-"}),
    (22, {"user1": "praise+ praise+ neutral- scarcity- praise-", "user2": "praise-"}),
    (21, {"user1": "praise+ praise- praise+ neutral- praise+ scarcity- suggestion-"}),
    (2, {"user3": "neutral+", "user2": "suggestion+ suggestion?"}),
)
"""Days ago, and the outcome of each request: complied (+), did not (-), not known (?)."""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Workspace]:
    """A workspace with four games, the last one two days ago."""
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    at = [NOW]
    with Store.open(tmp_path / "data", now=lambda: at[0]) as store:
        store.rename("user1", "Rosa")
        for number, (days, people) in enumerate(GAMES):
            at[0] = NOW - timedelta(days=days, minutes=60 * number)
            begun = {"game": f"g{number}", "people": list(people), "world": "simulated"}
            append_body(store, "game begun", begun)
            for person, told in people.items():
                for one in told.split():
                    at[0] += timedelta(minutes=7)
                    put(store, f"g{number}", person, one[:-1], one[-1])
    opened = Workspace(tmp_path / "data", now=lambda: NOW)
    yield opened
    opened.close()
    monkeypatch.undo()
    time.tzset()


def put(store: Store, game: str, person: str, strategy: str, came: str) -> None:
    kind = ResponseAwaited if came == "?" else "response"
    complied = {"+": True, "-": False, "?": None}[came]
    append_body(store, kind, {"game": game}, person=person, strategy=strategy, complied=complied)


def complied(workspace: Workspace, person: str, strategy: str) -> tuple[int, int]:
    """Return how often a person complied with a strategy, and the number of uses, by the log."""
    return workspace.store.responses().get((person, strategy), (0, 0))


def line_with(pilot: TangyPilot, *words: str) -> str:
    return next(line for line in pilot.lines() if all(word in line for word in words))


# ----------------------------------------------------------------------------------- content


async def test_the_screen_says_in_words_what_works_with_each_person(
    run: Run, workspace: Workspace
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        text = pilot.text()
        assert "praise works with Rosa: 7 of 9, last seen 3 weeks ago" in text
        assert "suggestion may work best with User 2: 1 of 1 so far, last seen 2 days ago" in text
        assert "neutral may work best with User 3: 1 of 1 so far, last seen 2 days ago" in text
        assert "nothing is known of User 4 yet" in text


async def test_the_table_shows_counts_mean_interval_best_and_settled(
    run: Run, workspace: Workspace
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        praise = line_with(pilot, "praise", "7 of 9 ")
        assert "  .73 .49-.91" in praise  # Beta(8, 3)
        assert "settled" in praise
        assert "★" not in line_with(pilot, "neutral", "0 of 3")
        assert "Thompson sampling (as the activity sets)" in pilot.text()
        assert "starts with every strategy equal" in pilot.text()


async def test_the_history_lists_games_with_their_times(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace), size=LARGE) as pilot:
        history = [line for line in pilot.lines() if "game of" in line]
        assert [line.split("game of ")[1].rstrip(" │┃█▅") for line in history] == [
            "1 May 2026 13:00", "30 Apr 2026 14:00", "28 Apr 2026 15:00",
        ]  # fmt: skip
        await pilot.press("down")
        await pilot.pause()
        assert "no response yet" in line_with(pilot, "suggestion", "no response")


async def test_another_person_is_chosen_with_the_arrows(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("down", "down", "down")
        await pilot.pause()
        assert "What works with User 4" in pilot.text()
        assert NO_REQUESTS in pilot.text()
        assert "★" not in pilot.text(), "equal is not best"


# ----------------------------------------------------------------------------------- changes


@pytest.mark.slow
async def test_a_response_is_voided_and_restored(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("tab", "tab", "x")
        await pilot.pause()
        assert isinstance(pilot.app.screen, ConfirmDialog)
        await pilot.press("n")
        assert complied(workspace, "user1", "suggestion") == (0, 2)
        await pilot.press("x", "y")
        await pilot.pause()
        assert complied(workspace, "user1", "suggestion") == (0, 1)
        assert "void: that was not a refusal" in pilot.text()
        await pilot.press("f2")
        await pilot.pause()
        assert "that a response to suggestion is void" in pilot.text()
        await pilot.press("y")
        await pilot.pause()
        assert complied(workspace, "user1", "suggestion") == (0, 2)
        assert "void:" not in pilot.text()


@pytest.mark.slow
async def test_a_void_response_can_be_answered_but_not_voided_again(
    run: Run, workspace: Workspace
) -> None:
    async with run(PeopleScreen(workspace), notifications=True) as pilot:
        await pilot.press("tab", "tab", "x", "y")
        await pilot.pause()
        await pilot.press("x")
        await pilot.pause()
        assert "Choose a response that counts" in pilot.text()
        await pilot.press("F")
        await pilot.pause()
        assert isinstance(pilot.app.screen, AnswerDialog)
        await pilot.press("y")
        await pilot.pause()
        assert complied(workspace, "user1", "suggestion") == (1, 1)
        assert "said later" in pilot.text()


async def test_a_request_without_a_response_is_answered_late(
    run: Run, workspace: Workspace
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("down", "F")
        await pilot.pause()
        assert "Did User 2 do it?" in pilot.text()
        await pilot.press("escape")
        await pilot.pause()
        assert complied(workspace, "user2", "suggestion") == (1, 0)
        await pilot.press("F", "n")
        await pilot.pause()
        assert complied(workspace, "user2", "suggestion") == (1, 1)
        assert "answered later" in pilot.text()


@pytest.mark.slow
async def test_a_strategy_is_switched_off_and_on_again(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("tab", "down", "down", "down", "x")
        await pilot.pause()
        assert "Switch scarcity off for Rosa?" in pilot.text()
        await pilot.press("y")
        await pilot.pause()
        assert workspace.memory().recall("user1").off == {"scarcity"}
        assert line_with(pilot, "scarcity", "0 of 2").rstrip("│┃ ").endswith("off")
        await pilot.press("x", "y")
        await pilot.pause()
        assert workspace.memory().recall("user1").off == frozenset()


async def test_the_last_strategy_stays_on(run: Run, workspace: Workspace) -> None:
    for strategy in ("praise", "suggestion", "scarcity"):
        Feedback(workspace.store).switch("user1", strategy, False, workspace.activity.strategies)
    async with run(PeopleScreen(workspace), notifications=True) as pilot:
        await pilot.press("x", "y")
        await pilot.pause()
        assert "neutral is the last one left" in pilot.text()


@pytest.mark.slow
async def test_another_method_is_chosen_and_the_default_restored(
    run: Run, workspace: Workspace
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("P")
        await pilot.pause()
        assert isinstance(pilot.app.screen, MethodDialog)
        await pilot.press("1", "2", "3", "3")
        await pilot.pause()
        for words in ("Bayes-UCB: tries less", "earlier people", "10% with each interaction"):
            assert words in pilot.text()
        await pilot.press("n")
        await pilot.pause()
        assert workspace.memory().feedback.method("user1") is None
        await pilot.press("P", "1", "2", "y")
        await pilot.pause()
        assert workspace.memory().feedback.method("user1") == PersuasionConfig(
            "bayes-ucb", "people"
        )
        assert "Bayes-UCB from earlier people" in pilot.text()
        assert "(for this person)" in pilot.text()
        assert "starts from what worked with earlier people" in pilot.text()
        await pilot.press("P", "0", "y")
        await pilot.pause()
        assert workspace.memory().feedback.method("user1") is None


async def test_undo_without_changes_is_refused(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace), notifications=True) as pilot:
        await pilot.press("f2")
        await pilot.pause()
        assert "nothing to take back" in " ".join(pilot.text().split())


async def test_the_cursor_keeps_its_place_after_a_change(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("tab", "tab", "down", "down")
        await pilot.pause()
        history = pilot.app.screen.query_one("#history", ChoiceList)
        before = history.chosen
        await pilot.press("x", "y")
        await pilot.pause()
        assert history.chosen == before
        assert pilot.app.screen.focused is history


async def test_markup_in_names_is_shown_as_text(run: Run, workspace: Workspace) -> None:
    workspace.store.rename("user1", "[/b] {x} [@click=quit]Jo")
    workspace.people = (
        type(workspace.people[0])("user1", "[/b] {x} [@click=quit]Jo"),
        *workspace.people[1:],
    )
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("tab", "x")
        await pilot.pause()
        assert "[@click=quit]Jo" in pilot.text()


async def test_the_key_line_lists_every_key_at_80_columns(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace), size=SMALL) as pilot:
        keys = pilot.lines()[-1]
        for key in ("tab", "x", "F", "P", "f2", "N", "esc", "?"):
            assert f" {key} " in keys


# ------------------------------------------------------------------------------- appearance


@pytest.mark.parametrize("size", [SMALL, LARGE], ids=["small", "large"])
async def test_the_people_screen_matches_its_snapshot(
    run: Run, workspace: Workspace, size: tuple[int, int], looks: Callable[[App[None]], None]
) -> None:
    async with run(PeopleScreen(workspace), size=size) as pilot:
        looks(pilot.app)


async def test_the_light_theme_with_a_prior_matches_its_snapshot(
    run: Run, workspace: Workspace, picture: Callable[[App[None]], None]
) -> None:
    feedback = Feedback(workspace.store)
    feedback.choose_method("user2", PersuasionConfig("bayes-ucb", "people", 0.98))
    feedback.switch("user2", "scarcity", False, workspace.activity.strategies)
    feedback.void("user2", feedback.history("user2")[1].seq, "that was not compliance")
    async with run(PeopleScreen(workspace)) as pilot:
        pilot.app.theme = LIGHT.name
        await pilot.press("down")
        await pilot.pause()
        picture(pilot.app)


async def test_the_choice_of_a_method_matches_its_snapshot(
    run: Run, workspace: Workspace, looks: Callable[[App[None]], None]
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press("P", "1")
        await pilot.pause()
        looks(pilot.app)


async def test_ascii_mode_shows_only_ascii(run: Run, workspace: Workspace) -> None:
    async with run(PeopleScreen(workspace), kind=TerminalKind(ascii=True)) as pilot:
        assert pilot.app._filters[-1].ascii  # type: ignore[attr-defined]
        assert "settled" in pilot.text()


@pytest.mark.parametrize(
    "keys", [("tab", "tab", "x"), ("down", "F"), ("x",)], ids=["void", "answer", "switch"]
)
async def test_the_questions_match_their_snapshots(
    run: Run, workspace: Workspace, keys: tuple[str, ...], looks: Callable[[App[None]], None]
) -> None:
    async with run(PeopleScreen(workspace)) as pilot:
        await pilot.press(*keys)
        await pilot.pause()
        looks(pilot.app)


async def test_eight_people_are_reachable_in_a_list_of_four(run: Run, tmp_path: Path) -> None:
    workspace = Workspace(tmp_path / "eight", users=8, now=lambda: NOW)
    async with run(PeopleScreen(workspace)) as pilot:
        assert "User 8" not in pilot.text()
        await pilot.press("end")
        await pilot.pause()
        assert "nothing is known of User 8 yet" in pilot.text()
        assert "What works with User 8" in pilot.text()
    workspace.close()


@pytest.mark.parametrize("size", [(60, 18), (100, 30), (200, 60)])
async def test_every_size_shows_the_chosen_person_in_full(
    run: Run, workspace: Workspace, size: tuple[int, int]
) -> None:
    async with run(PeopleScreen(workspace), size=size) as pilot:
        text = pilot.text()
        assert "praise works with Rosa: 7 of 9" in text
        for words in ("0 of 3", "★ settled", ".49-.91", "would rather not"):
            assert words in text


# ----------------------------------------------------------------------------- pronunciations


@pytest.mark.slow
async def test_a_pronunciation_is_played_and_stored(
    run: Run, workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    spoken: list[str] = []

    async def say(phones: str) -> None:
        spoken.append(phones)

    monkeypatch.setattr("tangy_tui.ui.screens.people.hear", say)
    async with run(PeopleScreen(workspace)) as pilot:
        pilot.type("N")
        await pilot.pause()
        dialog = pilot.app.screen
        assert isinstance(dialog, PronunciationDialog)
        assert "Rosa is said R OW Z AH, as in the dictionary." in pilot.text()
        dialog.query_one(PhonesInput).value = "r ow s ah"
        await pilot.pause()
        pilot.type("ctrl+g", "enter", at=1e9)
        await pilot.pause()
        assert spoken == ["R OW S AH"]
        assert workspace.find_person("user1").pronunciation == "R OW S AH"
        assert workspace.store.pronunciations() == {"user1": "R OW S AH"}
        assert all("R OW S AH" not in str(event.body) for event in workspace.store.events())


async def test_a_pronunciation_of_another_person_is_refused(run: Run, workspace: Workspace) -> None:
    workspace.rename(workspace.find_person("user2"), "Ann")
    async with run(PeopleScreen(workspace)) as pilot:
        pilot.type("N")
        await pilot.pause()
        dialog = pilot.app.screen
        assert isinstance(dialog, PronunciationDialog)
        dialog.query_one(PhonesInput).value = "AE N"
        await pilot.pause()
        pilot.type("enter", at=1e9)
        await pilot.pause()
        assert pilot.app.screen is dialog
        assert "sounds like Ann (user2)" in pilot.text()
        assert dialog.query_one(PhonesInput).value == "AE N"
        assert workspace.store.pronunciations() == {}
