"""A session of several activities: each is reported by its own rules and its own method."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.persuading import PAPER, PersuasionConfig
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.memory import PersonModels
from tangy_tui.monitoring.attention import Attention, visiting
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.people_progress import people_progress
from tangy_tui.monitoring.replay import GameReplay, read_replays
from tangy_tui.text.report import attention_lines, care_lines, visiting_words
from tangy_tui.text.results import progress_line
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
    ann = Attention("Ann", waits=[3.0])
    (alone,) = care_lines([ann], str, replays)
    (told,) = care_lines([ann], str, mixed)
    assert "Trivia" not in alone
    assert told.startswith("Tangy never went to Ann in Bingo") and "Trivia" in told
    assert visiting_words(mixed) in attention_lines([ann], str, mixed)[-1]
