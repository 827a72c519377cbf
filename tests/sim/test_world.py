"""The simulated world: reproducible games, independent random streams, and rules."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.behaviour import Action
from tangy_profiles.person import load_people
from tangy_profiles.state import FRONT, ActivityState, Outcome
from tangy_sim.worlds.users import UserModel, load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.world import World

BINGO = load_activity("bingo")
USERS = load_users()
IDS = tuple(person.id for person in load_people(8))

Taken = tuple[ActivityState, Action, Outcome, ActivityState]


def expected(world: World) -> Action:
    state = world.observe()
    behaviour = world.activity.behaviours[world.activity.expected[state.situation]]
    return world.activity.action(behaviour, state.attended if behaviour.attends else None, None)


def game(world: SimulatedWorld) -> Iterator[Taken]:
    """Play the expected behaviours of the current game, step by step."""
    while not world.over:
        state, action = world.observe(), expected(world)
        yield state, action, world.execute(action), world.observe()


def world(seed: int, users: int = 4, model: UserModel = USERS) -> SimulatedWorld:
    return SimulatedWorld(BINGO, IDS[:users], seed=seed, users=model)


def test_a_simulated_world_is_a_world() -> None:
    made: World = world(1)
    assert made.people == IDS[:4]
    assert made.observe().stage == "start"


# ------------------------------------------------------------------------- the course of games


@pytest.mark.parametrize("users", range(1, 9))
def test_one_to_eight_people_play_games_that_end_with_a_win(users: int) -> None:
    made = world(8, users)
    for _ in range(12):
        taken = list(game(made))
        assert [t[1].behaviour.name for t in taken[-2:]] == ["celebrate", "valediction"]
        assert {t[0].situation for t in taken} <= set(BINGO.situations)
        assert all(t[2].completed for t in taken)
        assert len(taken) < 200
        made.begin()


@pytest.mark.parametrize("free_centre", [False, True])
@pytest.mark.parametrize("pattern", ["row", "column", "diagonal", "four corners"])
def test_a_win_is_a_called_and_marked_line_of_the_pattern(free_centre: bool, pattern: str) -> None:
    deck = replace(BINGO.deck, free_centre=free_centre, patterns=(pattern,))
    activity = replace(BINGO, deck=deck)
    made = SimulatedWorld(activity, IDS[:4], seed=9, users=USERS)
    for _ in range(8):
        winner = None
        for state, action, _, _ in game(made):
            if action.behaviour.name == "celebrate":
                winner = state.attended
                break
            card = made.scene().card
        assert card is not None
        assert card.person == winner
        called = made.scene().called
        lines = [
            [card.numbers[c] for c in range(25) if line >> c & ~deck.free >> c & 1]
            for line in deck.lines
            if card.marked & line == line
        ]
        assert any(set(line) <= set(called) for line in lines)
        made.begin()


def test_a_read_card_shows_the_numbers_called_so_far() -> None:
    made = world(10)
    cards = 0
    for _ in range(60):
        for state, _, _, _ in game(made):
            scene = made.scene()
            assert scene.place == made.observe().place
            assert len(set(scene.called)) == len(scene.called)
            if scene.card is not None:
                cards += 1
                cells = sum(1 << c for c, n in enumerate(scene.card.numbers) if n in scene.called)
                assert scene.card.called == cells
                assert scene.card.person == scene.place != FRONT
            assert state.step >= 0
        made.begin()
    assert cards > 100


def test_a_person_with_a_full_line_of_marks_asks_for_help() -> None:
    made = world(11)
    for _ in range(60):
        for _ in game(made):
            for player in made.players.values():
                if any(player.marked & line == line for line in BINGO.deck.lines):
                    assert made.over or player.id in made.scene().requests
        made.begin()


def test_no_request_is_shown_after_the_goodbye() -> None:
    made, asked = world(14), 0
    for _ in range(20):
        for _ in game(made):
            pass
        asked += bool(made.tracker.queue)
        assert made.scene().requests == () and "asks for help" not in made.scene().doing.values()
        made.begin()
    assert asked


def test_nobody_asks_before_the_greeting() -> None:
    made = world(12, model=replace(USERS, ask=9.0))
    joke = BINGO.action(BINGO.behaviours["joke"], None, None)
    for _ in range(30):
        made.execute(joke)
        assert made.scene().requests == ()
    made.execute(expected(made))
    made.execute(expected(made))
    assert len(made.scene().requests) == 4


def test_corrections_mend_the_error_on_the_card() -> None:
    made = world(13)
    mended = 0
    for _ in range(80):
        while not made.over:
            card, action = made.scene().card, expected(made)
            outcome = made.execute(action)
            wrong = {"remove markers": 1, "mark numbers": -1}.get(action.behaviour.name)
            if wrong is not None and card is not None:
                errors = card.marked & ~card.called if wrong > 0 else card.called & ~card.marked
                assert outcome.numbers == tuple(
                    n for c, n in enumerate(card.numbers) if errors >> c & 1
                )
                player = made.players[card.person]
                assert player.marked == card.marked ^ errors
                assert outcome.response is not None
                assert outcome.response.person == card.person
                mended += 1
        made.begin()
    assert mended > 100


def test_requests_arrive_during_visits_too() -> None:
    made = world(14)
    onward = 0
    for _ in range(60):
        names = [(s.place, a.behaviour.name) for s, a, _, _ in game(made)]
        onward += sum(place != FRONT and name == "navigate to user" for place, name in names)
        made.begin()
    assert onward > 20


def test_perfect_people_ask_only_when_they_have_won() -> None:
    made = world(15, model=replace(USERS, miss=0, slip=0, ask=0, occluded=0))
    for _ in range(30):
        seen = {t[0].situation.user_state for t in game(made)}
        assert seen == {"occluded", "bingo"}
        made.begin()


@pytest.mark.parametrize("occluded", [0.0, 1.0])
def test_a_card_is_out_of_view_on_arrival_by_the_user_model(occluded: float) -> None:
    made = world(16, model=replace(USERS, occluded=occluded))
    for _ in range(30):
        for _, action, _, after in game(made):
            if action.behaviour.name == "navigate to user":
                assert (after.situation.user_state == "occluded") == bool(occluded)
        made.begin()


def test_a_visit_takes_longer_than_a_call() -> None:
    made = world(17)
    for _ in range(20):
        for state, _, outcome, after in game(made):
            away = (state.place, after.place) != (FRONT, FRONT)
            assert outcome.seconds == pytest.approx(31.0 * (3.42 if away else 1))
        made.begin()


def test_calls_after_the_last_number_draw_none() -> None:
    made = world(18, model=replace(USERS, miss=1, slip=0, ask=0))
    made.execute(expected(made))
    call = BINGO.action(BINGO.behaviours["call number"], None, None)
    numbers = [made.execute(call).numbers for _ in range(80)]
    assert sorted(n for drawn in numbers for n in drawn) == list(range(1, 76))
    assert numbers[75:] == [()] * 5


# --------------------------------------------------------------------- any actions of a teacher


@given(
    st.integers(0, 99),
    st.integers(1, 8),
    st.lists(
        st.tuples(st.sampled_from(tuple(BINGO.behaviours)), st.sampled_from((None, *IDS))),
        max_size=60,
    ),
)
def test_any_sequence_of_behaviours_leaves_a_consistent_world(
    seed: int, users: int, wishes: list[tuple[str, str | None]]
) -> None:
    made = world(seed, users, USERS.teaching())
    for name, target in wishes:
        before, over = made.observe(), made.over
        outcome = made.execute(BINGO.action(BINGO.behaviours[name], target, None))
        state, scene = made.observe(), made.scene()
        assert made.over == (over or name == "valediction")
        if over:
            assert (outcome, state) == (Outcome(False, 0.0, (), None), before)
        assert state.step == before.step + (not over)
        assert state.place in (FRONT, *made.people)
        assert set(scene.doing) == set(made.people)
        assert set(scene.requests) == {u.id for u in state.users if u.request == "AR"} or (
            state.attended is None
        )
        assert state.situation in BINGO.situations or state.stage == "end"


def test_a_new_game_begins_at_the_start_with_new_cards() -> None:
    made = world(19)
    first = [player.numbers for player in made.players.values()]
    list(game(made))
    assert made.over
    state = made.begin()
    assert not made.over
    assert (state.step, state.place, state.stage) == (0, FRONT, "start")
    assert made.scene().called == ()
    assert [player.numbers for player in made.players.values()] != first


def test_the_world_plays_a_made_up_activity(
    lanterns: Activity, cover: Callable[[str, int, int], tuple[object, ...]]
) -> None:
    assert cover("lanterns", 1, 5)
    made = SimulatedWorld(lanterns, IDS[:5], seed=3)
    for _ in range(10):
        names = [action.behaviour.name for _, action, _, _ in game(made)]
        assert names[-2:] == ["dim the lights", "wave off"]
        assert names.count("draw lantern") == 20
        made.begin()


def test_an_unnecessary_correction_fails_without_a_request() -> None:
    made = world(3, model=USERS.teaching())
    while made.observe().situation.user_state != "correctly marked":
        if made.over:
            made.begin()
        made.execute(expected(made))
    before = made.observe()
    for name in ("mark numbers", "remove markers"):
        outcome = made.execute(BINGO.action(BINGO.behaviours[name], before.attended, None))
        assert (outcome.completed, outcome.numbers, outcome.response) == (False, (), None)
        assert made.observe().situation == before.situation
