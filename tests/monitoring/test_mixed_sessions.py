"""A session of several activities: each is reported by its own rules and its own method."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.beliefs import Beta
from tangy_profiles.persuading import PAPER, PersuasionConfig
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.memory import PersonModels
from tangy_tui.monitoring.attention import Attention, Wait, visiting
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.people_progress import people_progress
from tangy_tui.monitoring.replay import AnsweredRequest, GameReplay, read_replays
from tangy_tui.monitoring.session import read_session
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.pages.session import session_page
from tangy_tui.text.activities import stage_words
from tangy_tui.text.endings import all_endings, ending_sentence
from tangy_tui.text.games import NEVER_ASKED, NOBODY_ASKED, belief_lines
from tangy_tui.text.report import (
    attention_lines,
    care_lines,
    response_words,
    visiting_words,
    waited_words,
)
from tangy_tui.text.results import BY_METHOD, progress_line
from tests.monitoring.conftest import Supervise
from tests.support.games import play

FORGETS = PersuasionConfig(forgetting=0.5)


@pytest.fixture
def replays(workspace: Workspace, supervise: Supervise) -> list[GameReplay]:
    """Two games: bingo, and a raffle in which Tangy forgets half of what it learnt each time."""
    for seed in (1, 2):
        play(supervise(seed=seed))
    bingo = workspace.activity
    raffle = replace(bingo, name="raffle", title="Raffle", persuasion=FORGETS)
    games = read_games(workspace.store)
    first, second = read_replays(workspace.store, games, {bingo.name: bingo}, workspace.names)
    return [first, replace(second, game=replace(second.game, activity="raffle"), activity=raffle)]


def test_each_activity_has_the_beliefs_of_its_own_method(
    workspace: Workspace, replays: list[GameReplay]
) -> None:
    people = people_progress(workspace.store, replays, workspace.names)
    alone = {p.id: p for p in people_progress(workspace.store, replays[1:], workspace.names)}
    world = replays[0].game.world
    assert any(one.interactions for one in people)
    for one in people:
        bingo, raffle = one.methods
        assert (bingo.chosen, raffle.chosen) == (PAPER, FORGETS)
        assert raffle.interactions == alone[one.id].interactions
        for method in (bingo, raffle):
            models = PersonModels(
                workspace.store, tuple(method.strategies), method.chosen, world=world
            )
            believed = models.recall(one.id).beliefs
            assert {s: a.after.mean for s, a in method.strategies.items()} == pytest.approx(
                {s: belief.mean for s, belief in believed.items()}
            )
        assert one.to_json()["strategies"].keys() == one.strategies.keys()
        if one.interactions:
            assert (" (Raffle): " in progress_line(one)) is bool(raffle.interactions)


def test_a_method_of_a_persons_own_holds_in_every_activity(
    workspace: Workspace, replays: list[GameReplay]
) -> None:
    person = workspace.people[0].id
    own = PersuasionConfig(forgetting=0.75)
    workspace.memory().feedback.choose_method(person, own)
    people = people_progress(workspace.store, replays, workspace.names)
    (found,) = next(one for one in people if one.id == person).methods
    assert (found.chosen, found.activities) == (own, ("Bingo", "Raffle"))


def test_the_report_names_the_activities_in_which_tangy_goes_to_people(
    replays: list[GameReplay],
) -> None:
    quiz = replace(replays[0], activity=load_activity("trivia"))
    mixed = [replays[0], quiz]
    assert visiting(mixed) == (("Bingo",), ("Trivia",))
    assert visiting_words(replays) == ""
    ann = Attention("Ann", [Wait(3.0)])
    (alone,) = care_lines([ann], str, replays)
    (told,) = care_lines([ann], str, mixed)
    assert "Trivia" not in alone
    assert told.startswith("Tangy never went to Ann in Bingo") and "Trivia" in told
    assert visiting_words(mixed) in attention_lines([ann], str, mixed)[-1]


def test_games_that_ended_alike_are_named_together(replays: list[GameReplay]) -> None:
    one = replays[0].game
    left = replace(one, number=2, stopped="It was left before its end.")
    games = [replace(one, number=1), left, replace(one, number=3)]
    played = ending_sentence(one)
    assert all_endings(games) == f"Games 1 and 3: {played} Game 2: It was left before its end."
    assert all_endings([left]) == "Game 2: It was left before its end."
    two = [left, replace(left, number=3)]
    assert all_endings(two) == "Games 2 and 3: They were left before the end."


def test_a_late_response_is_not_told_as_done_in_time() -> None:
    def answer(complied: int | None, *, followed: bool | None = None) -> AnsweredRequest:
        return cast(AnsweredRequest, SimpleNamespace(complied=complied, followed=followed))

    late = answer(False, followed=True)
    assert response_words([answer(True), late, answer(False, followed=False)]) == "1 of 3, 1 late"
    as_in_the_log = [*map(answer, (1, 0)), answer(0, followed=True)]  # SQLite knows no booleans
    assert response_words(as_in_the_log) == "1 of 3, 1 late"
    assert response_words([late, answer(None)]) == "0 of 1, 1 late, 1 not known"
    assert response_words([answer(None)]) == "1 not known"


@pytest.mark.parametrize(
    ("waits", "words"),
    [
        ([30.0], "30 s"),
        ([10.0, 50.0, 20.0], "10 s, then 50 s, then 20 s"),
        ([10.0, 20.0, 40.0, 50.0], "half within 20 s, at most 50 s"),
        ([20.0, 20.0, 20.0, 20.0], "20 s"),
    ],
)
def test_every_wait_that_is_told_is_one_of_the_log(waits: list[float], words: str) -> None:
    assert waited_words(Attention("ann", list(map(Wait, waits)))) == words


def test_what_works_is_told_only_where_tangy_asks_people_for_something() -> None:
    def played(activity: str, beliefs: dict[str, dict[str, Beta]]) -> Supervision:
        world = SimpleNamespace(activity=load_activity(activity))
        persuasion = SimpleNamespace(beliefs=beliefs)
        return cast(Supervision, SimpleNamespace(world=world, persuasion=persuasion))

    assert belief_lines(played("trivia", {"Ann": {}}), str) == []
    assert belief_lines(played("bingo", {"Ann": {}, "Bo": {}}), str) == [NOBODY_ASKED]
    ann, others = belief_lines(
        played("bingo", {"Bo": {}, "Ann": {"praise": Beta(2, 1)}, "Cy": {}}), str
    )
    assert ann.startswith("Ann: praise worked")
    assert others == NEVER_ASKED.format(people="Bo and Cy")


def test_the_page_tells_each_method_and_names_stages_in_words(
    workspace: Workspace, replays: list[GameReplay]
) -> None:
    store, activities = workspace.store, {workspace.activity.name: workspace.activity}
    session = read_session(store, read_games(store), activities, workspace.names)
    people = people_progress(store, replays, workspace.names)
    page = session_page(replace(session, replays=tuple(replays), people=people))
    assert BY_METHOD in page and ", Raffle</h3>" in page and ", Bingo</h3>" in page
    assert BY_METHOD not in session_page(session)
    activity = replays[0].activity
    assert stage_words(activity, "navigate").startswith("somebody asks for help")
    assert stage_words(activity, "facilitate") in page
