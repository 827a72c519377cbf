"""Live games without a screen: their events and log."""

from __future__ import annotations

import pytest

from tangy_profiles.past_game import interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.live_games import LiveGames, News
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameChanged, GameEnded
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text.live_news import live_lines
from tests.hw.links import FakeLink, LaidCard
from tests.support.live_worlds import live_world

PEOPLE = ("user1", "user2", "user3", "user4")


@pytest.mark.slow
def test_a_swapped_seat_is_reported_once_in_each_game(workspace: Workspace, learnt: Policy) -> None:
    link = FakeLink(PEOPLE)
    link.cards["user2"] = LaidCard(7)
    link.faces["user2"] = "user4"
    world = live_world(workspace, link, knows_faces=True)
    game = workspace.supervision(learnt, 1, world=world)
    played = LiveGames(workspace, game)
    lines: list[str] = []

    def tell(events: list[Event], news: list[News]) -> None:
        lines.extend(live_lines(events, news, workspace.name))
        if game.steps in (2, 12):
            link.sign(2)
        elif world.tracker.place == "user2":
            link.sign()  # all signs are down

    played.play(range(2), expert=False, tell=tell)
    going = workspace.activity.behaviours["navigate to user"].question
    said = [line for line in lines if "sits at" in line]
    assert (
        len([line for line in lines if f"{going} (User 2): " in line]) == 6
    )  # one after the last number
    assert said == ["User 4 sits at User 2's place: Tangy speaks to User 4."] * 2


def test_a_resumed_live_game_repeats_no_final_visit(workspace: Workspace, learnt: Policy) -> None:
    game = workspace.supervision(learnt, 1, world=live_world(workspace, FakeLink(PEOPLE)))
    told = game.begin()
    while sum(isinstance(e, GameChanged) and e.what == "visit over" for e in told) < 2:
        told += game.step()
    past = interrupted_game(workspace.store, "bingo")
    assert past is not None
    world = live_world(workspace, FakeLink(PEOPLE))
    again = workspace.supervision(learnt, 1, world=world)
    again.begin(past, "Ann")
    assert (world.requests.all, world.tracker.queue) == ({}, [])
    told = []
    while not again.over:
        told += again.step()
    visits = [e.person for e in told if isinstance(e, GameChanged) and e.what == "visit"]
    assert visits == ["user3", "user4"]
    assert isinstance(told[-1], GameEnded) and told[-1].stopped is None


def test_an_unjudged_card_is_reported_logged_and_counted(
    workspace: Workspace, learnt: Policy
) -> None:
    link = FakeLink(PEOPLE)
    link.cards["user2"] = LaidCard(7, marked=1, others=(9,))
    world = live_world(workspace, link)
    world.cards.dealt.deal({"user2": 7})
    game = workspace.supervision(learnt, 1, world=world)
    played = LiveGames(workspace, game)
    lines: list[str] = []

    def tell(events: list[Event], news: list[News]) -> None:
        lines.extend(live_lines(events, news, workspace.name))
        if game.steps == 2:
            link.sign(2)
        elif world.tracker.place == "user2":
            link.sign()  # all signs are down

    played.play(range(1), expert=False, tell=tell)
    told = [line for line in lines if "two cards in front of User 2: 7 and 9" in line]
    assert len(told) == 2  # the other one after the last number, when each person gets a visit
    notes = [event.record for event in workspace.store.events(StaffAction)]
    assert [(note.did, note.detail) for note in notes[:2]] == [
        ("cards dealt", "user2 7"),
        ("card doubted", "several cards: 7, 9"),
    ]
    doubts = played.document()["card_doubts"]
    told_of = [(doubt["game"], doubt["person"], doubt["cards"]) for doubt in doubts]
    assert told_of == [(1, "user2", [7, 9])] * 2
