"""Turns by lot: each game draws a new order of players, and everybody has a turn."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from tangy_profiles.codec import decode, encode
from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.lots import turns_of
from tangy_profiles.declared.memory import GameMemory, game_from, memory_of
from tangy_profiles.person import load_people
from tangy_sim.device_simulator.declared_people import DeclaredPeople
from tangy_sim.device_simulator.declared_reception import DeclaredReception
from tangy_sim.device_simulator.faults import Faults
from tangy_sim.worlds.declared_world import DeclaredWorld

FILE = Path(__file__).parent.parent / "support" / "activities" / "raffle.toml"
PLAYERS = ("user1", "user2", "user3")


@pytest.fixture(scope="module")
def raffle() -> DeclaredActivity:
    return read_declared(FILE)


def world(raffle: DeclaredActivity, seed: int) -> DeclaredWorld:
    return DeclaredWorld(raffle, PLAYERS, seed=seed)


def test_turn_orders_are_drawn_uniformly(raffle: DeclaredActivity) -> None:
    draw = Random(5).random
    drawn = Counter(turns_of(raffle.declaration, PLAYERS, draw) for _ in range(6_000))
    assert len(drawn) == 6
    assert all(900 < count < 1_100 for count in drawn.values())


def test_turns_without_lots_follow_the_seats(raffle: DeclaredActivity) -> None:
    def never() -> float:
        raise AssertionError

    in_order = replace(raffle.declaration, turns="in order")
    assert turns_of(in_order, PLAYERS, never) == PLAYERS


def test_the_order_depends_on_seed_and_game(raffle: DeclaredActivity) -> None:
    room = world(raffle, 3)
    orders = [room.game.players]
    for _ in range(20):
        room.begin()
        orders.append(room.game.players)
    assert len(set(orders)) == 6
    again = world(raffle, 3)
    assert again.game.players == orders[0]
    again.begin()
    assert again.game.players == orders[1]


def test_the_order_is_stored_in_the_log(raffle: DeclaredActivity) -> None:
    games = [world(raffle, seed).game for seed in range(8)]
    assert len({game.players for game in games}) > 2
    for game in games:
        game.execute("open the raffle", None)
        logged = decode(GameMemory, encode(memory_of(game)))
        restored = game_from(raffle.declaration, PLAYERS, logged)
        assert restored is not None
        assert restored.players == restored.here == game.players
        assert restored.whom("whose turn") == game.whom("whose turn")


def test_people_on_the_bench_learn_the_turn_from_the_robot(
    raffle: DeclaredActivity,
) -> None:
    seats = load_people(3)
    people, ears = DeclaredPeople(raffle, seats, Faults(), seed=2), DeclaredReception(raffle, seats)
    people.begin(0.0)
    names = {person.id: person.name for person in seats}
    for text, whose in (
        ("The lot falls on ... {user3}! You win a warm scarf. Do you want it?", "user3"),
        ("Then a warm scarf goes to {user2}. Do you want it?", "user2"),
    ):
        heard = ears.hear(text.format(**names))
        assert heard is not None
        people.hear(heard)
        assert people.known.whom("whose turn") == whose


def test_the_circle_follows_the_seats_and_not_the_lot(raffle: DeclaredActivity) -> None:
    games = (world(raffle, seed).game for seed in range(20))
    game = next(one for one in games if one.players == ("user3", "user1", "user2"))
    assert game.circle == PLAYERS
    found = []
    for spoken_to in (None, *PLAYERS):
        game.addressed = spoken_to
        found.append(game.whom("next in circle"))
    assert found == ["user1", "user2", "user3", "user1"]
    again = game_from(raffle.declaration, PLAYERS, memory_of(game))
    assert again is not None
    assert (again.players, again.circle) == (game.players, PLAYERS)
    strange = replace(memory_of(game), circle=("user1", "user1", "user2"))
    assert game_from(raffle.declaration, PLAYERS, strange) is None
    game.here = ("user3", "user1")
    game.addressed = "user1"
    assert game.whom("next in circle") == "user3"
