"""The rates of misses, slips, requests and hidden cards match the user model."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.behaviour import Action
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld

BINGO = load_activity("bingo")
USERS = load_users()
IDS = tuple(f"user{n}" for n in range(1, 9))


def action(name: str, target: str | None = None) -> Action:
    return BINGO.action(BINGO.behaviours[name], target, None)


def test_the_rate_of_missed_numbers_matches_the_model() -> None:
    world = SimulatedWorld(BINGO, IDS, seed=31, users=replace(USERS, slip=0))
    called = missed = 0
    for _ in range(60):
        world.execute(action("greeting"))
        for _ in range(75):
            world.execute(action("call number"))
        for player in world.players.values():
            called += player.called.bit_count()
            missed += (player.called & ~player.marked).bit_count()
            assert not player.marked & ~player.called
        world.begin()
    assert called == 60 * 8 * 25
    assert missed / called == pytest.approx(0.101, rel=0.08)


def test_the_rate_of_wrong_marks_matches_the_model() -> None:
    world = SimulatedWorld(BINGO, IDS, seed=32, users=replace(USERS, miss=0))
    slips, calls = 0, 20
    for _ in range(200):
        for _ in range(calls):
            before = [player.marked & ~player.called for player in world.players.values()]
            world.execute(action("call number"))
            for player, wrong in zip(world.players.values(), before, strict=True):
                now = player.marked & ~player.called
                slips += (now & ~wrong).bit_count()
                assert not player.called & ~player.marked, "marked early is right once it is called"
        world.begin()
    assert slips / (200 * calls * 8) == pytest.approx(0.0369, rel=0.08)


def test_a_slip_marks_a_number_that_was_not_called() -> None:
    world = SimulatedWorld(BINGO, IDS, seed=35, users=replace(USERS, miss=1, slip=1))
    for _ in range(20):
        for _ in range(12):
            before = [player.marked for player in world.players.values()]
            world.execute(action("call number"))
            for player, marked in zip(world.players.values(), before, strict=True):
                new = player.marked & ~marked
                assert new.bit_count() == 1
                assert not new & player.called
        world.begin()


def test_nobody_marks_the_free_centre() -> None:
    deck = replace(BINGO.deck, free_centre=True)
    world = SimulatedWorld(
        replace(BINGO, deck=deck), IDS, seed=36, users=replace(USERS, miss=0, slip=0)
    )
    centres = {player.id: player.numbers[12] for player in world.players.values()}
    for _ in range(75):
        (number,) = world.execute(action("call number")).numbers
        for person, centre in centres.items():
            if centre == number:
                assert not world.scene().doing[person].startswith("marks")


@pytest.mark.parametrize(("miss", "factor"), [(0.0, 1.0), (1.0, 1.47)])
def test_the_rate_of_requests_matches_the_model_and_rises_with_errors(
    miss: float, factor: float
) -> None:
    deck = replace(BINGO.deck, patterns=("four corners",))  # so that hardly anybody wins
    world = SimulatedWorld(
        replace(BINGO, deck=deck), IDS, seed=33, users=replace(USERS, miss=miss, slip=0)
    )
    asked = waited = 0
    for _ in range(400):
        world.execute(action("greeting"))
        for _ in range(10):  # enough for everybody to miss a number, if all are missed
            world.execute(action("call number"))
        world.tracker.queue.clear()
        for _ in range(20):
            world.execute(action("call number"))
            full = {p.id for p in world.players.values() if deck.wins(p.marked)}
            asked += len(set(world.tracker.queue) - full)
            waited += 8
            world.tracker.queue.clear()
        world.begin()
    assert asked / waited == pytest.approx(0.0074 * factor, rel=0.1)


def test_the_rate_of_cards_out_of_view_matches_the_model() -> None:
    world = SimulatedWorld(BINGO, IDS, seed=34)
    world.execute(action("greeting"))
    hidden, visits = 0, 4000
    for _ in range(visits):
        world.tracker.ask("user3")
        world.execute(action("navigate to user", "user3"))
        hidden += world.tracker.seen is None
    assert hidden / visits == pytest.approx(23 / 71, rel=0.08)
