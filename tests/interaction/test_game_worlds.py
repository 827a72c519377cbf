"""Posteriors of people are separate for simulated, bench and live games."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tangy_profiles.codec import encode
from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import (
    BENCH,
    LIVE,
    PLAYED_WORLDS,
    SIMULATED,
    UNKNOWN,
    GameWorld,
    read_game_world,
)
from tangy_profiles.person import Person
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_profiles.store import Store
from tangy_tui.interaction.game_worlds import GameWorlds
from tangy_tui.interaction.memory import PersonModels
from tangy_tui.interaction.record import read_records
from tests.support.append_body import append_body

STATE = encode(ActivityState(0, Situation("s", "ANR", "u"), FRONT, None, ()))
STRATEGIES = ("praise", "neutral")


def game(store: Store, id: str, world: GameWorld | None, complied: int, refused: int = 0) -> None:
    """Log a game with responses of one person to praise."""
    body = {"game": id, "number": 1, "activity": "a", "policy": "", "seed": 1, "people": ["p"]}
    append_body(store, "game begun", body if world is None else {**body, "world": world})
    for did in [True] * complied + [False] * refused:
        told = {"game": id, "followed": did, "seconds": 1.0}
        append_body(store, "response", told, person="p", strategy="praise", complied=did)


def believed(store: Store, world: GameWorld | None = None) -> tuple[float, float]:
    belief = PersonModels(store, STRATEGIES, world=world).recall("p").beliefs["praise"]
    return belief.alpha, belief.beta


def test_each_world_has_its_own_posteriors(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "s", SIMULATED, 5, 1)
        game(store, "b", BENCH, 2)
        game(store, "l", LIVE, 0, 3)
        assert [believed(store, world) for world in PLAYED_WORLDS] == [(6, 2), (3, 1), (1, 4)]


def test_staff_can_set_the_world_of_a_game(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "a", None, 5, 1)
        game(store, "b", LIVE, 2)
        worlds = GameWorlds(store)
        worlds.set("a", LIVE, "Ada")
        worlds.set("b", BENCH)
        worlds.set("b", BENCH)  # no change: nothing is logged
        assert dict(worlds.all) == dict(GameWorlds(store).all) == {"a": LIVE, "b": BENCH}
        assert [event.body["world"] for event in store.events("game world set")] == [LIVE, BENCH]
        assert [believed(store, world) for world in PLAYED_WORLDS] == [(1, 1), (3, 1), (6, 2)]


def test_the_world_of_the_last_game_is_the_default(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        assert GameWorlds(store).last == SIMULATED
        game(store, "l", LIVE, 1)
        game(store, "s", SIMULATED, 4)
        assert believed(store) == believed(store, SIMULATED) == (5, 1)
        game(store, "m", LIVE, 1)
        assert believed(store) == (3, 1)


def test_a_forgetting_method_uses_only_its_own_world(tmp_path: Path) -> None:
    forgetting = PersuasionConfig("thompson", "uniform", 0.9, "interaction")
    with Store.open(tmp_path) as store:
        game(store, "l", LIVE, 3)
        before = PersonModels(store, STRATEGIES, forgetting, world=LIVE).recall("p").beliefs
        game(store, "s", SIMULATED, 0, 9)
        assert PersonModels(store, STRATEGIES, forgetting, world=LIVE).recall("p").beliefs == before


def test_the_prior_from_others_uses_only_the_same_world(tmp_path: Path) -> None:
    people = PersuasionConfig("thompson", "people")
    with Store.open(tmp_path) as store:
        game(store, "s", SIMULATED, 9)
        fresh = PersonModels(store, STRATEGIES, people, world=LIVE).recall("q").prior
        game(store, "t", SIMULATED, 9)
        assert PersonModels(store, STRATEGIES, people, world=LIVE).recall("q").prior == fresh


def test_feedback_without_a_game_belongs_to_the_shown_world(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "s", SIMULATED, 1)
        PersonModels(store, STRATEGIES, world=LIVE).feedback.give("p", "praise", True)
        assert believed(store, LIVE) == (2, 1)
        assert believed(store, SIMULATED) == (2, 1)
        PersonModels(store, STRATEGIES, world=SIMULATED).feedback.give("p", "praise", False)
        assert believed(store, LIVE) == (2, 1)
        assert believed(store, SIMULATED) == (2, 2)


def test_a_void_response_counts_in_no_world(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "l", LIVE, 2)
        memory = PersonModels(store, STRATEGIES, world=LIVE)
        memory.feedback.void("p", memory.history("p")[0].seq)
        assert believed(store, LIVE) == (2, 1)
        assert believed(store, SIMULATED) == (1, 1)


def test_a_record_of_one_world_keeps_the_numbers_of_the_whole_log(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "s", SIMULATED, 2)
        game(store, "l", LIVE, 1)
        person = Person("p", "Rosa")
        (live,) = read_records(store, PersonModels(store, STRATEGIES, world=LIVE), [person])
        assert (live.world, [entry.number for entry in live.history]) == (LIVE, [3])
        (bench,) = read_records(store, PersonModels(store, STRATEGIES, world=BENCH), [person])
        assert (bench.history, bench.seen) == ((), None)


@pytest.mark.parametrize(
    ("calls", "hurried", "world"),
    [
        ([31.0, 31.0, 31.0], True, SIMULATED),
        ([31.0, 31.0, 31.0], False, SIMULATED),
        ([], False, UNKNOWN),
        ([31.0], True, UNKNOWN),
        ([33.2, 33.4, 31.9], True, BENCH),
        ([33.2, 33.4, 31.9], False, UNKNOWN),
    ],
)
def test_the_times_of_an_old_game_tell_its_world(
    tmp_path: Path, calls: list[float], hurried: bool, world: GameWorld
) -> None:
    clock = [datetime(2026, 1, 1, tzinfo=UTC)]
    with Store.open(tmp_path, now=lambda: clock[0]) as store:
        game(store, "old", None, 1)
        for seconds in calls:
            clock[0] += timedelta(seconds=0.5 if hurried else seconds)
            body = {
                "game": "old", "behaviour": "b", "target": None, "numbers": [1],
                "seconds": seconds, "state": STATE,
            }  # fmt: skip
            append_body(store, "game step", body)
        assert GameWorlds(store).all == {"old": world}
        game(store, "new", BENCH, 0)
        assert believed(store, world) == (2, 1)


def test_a_game_of_unknown_world_counts_in_none_and_is_asked_about_once(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "old", None, 3)
        game(store, "older", None, 2)
        game(store, "new", LIVE, 1)
        assert [believed(store, world) for world in PLAYED_WORLDS] == [(1, 1), (1, 1), (2, 1)]
        assert GameWorlds(store).unasked == ["old", "older"]
        GameWorlds(store).settle(["old"], UNKNOWN, "Ada")
        GameWorlds(store).settle(["older"], LIVE, "Ada")
        assert GameWorlds(store).unasked == []
        assert GameWorlds(store).all == {"old": UNKNOWN, "older": LIVE, "new": LIVE}
        assert believed(store, LIVE) == (4, 1)


def test_the_newest_game_of_known_world_sets_the_default(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        game(store, "l", LIVE, 1)
        game(store, "old", None, 4)
        assert GameWorlds(store).last == LIVE


def test_an_unknown_world_is_refused_with_a_suggestion() -> None:
    assert read_game_world(" Live ") == LIVE
    with pytest.raises(TangyError, match="bench"):
        read_game_world("bnech")
