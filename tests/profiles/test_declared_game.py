"""The interpreter of declared activities: only observations and behaviours change facts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.codec import decode, encode
from tangy_profiles.declared.activity import DeclaredActivity, read_declared
from tangy_profiles.declared.checking import expected_moves
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.declared.memory import GameMemory, game_from, memory_of
from tangy_profiles.declared.model import FactCondition
from tangy_profiles.declared.progress import ProgressWatch
from tangy_profiles.declared.speech import filled, media, person_on_screen, words
from tangy_profiles.game_records import ChangeKind, GameChange
from tangy_sim.worlds.declared_world import DeclaredWorld
from tests.support.declared import DECLARED, declared
from tests.support.media import guess_the_sound

PLAYERS = ("ann", "ben", "cat")


@pytest.fixture
def trivia() -> DeclaredActivity:
    activity = load_activity("trivia")
    assert isinstance(activity, DeclaredActivity)
    return activity


@pytest.fixture
def game(trivia: DeclaredActivity) -> DeclaredGame:
    game = DeclaredGame(trivia.declaration, PLAYERS, (2, 0, 1))
    game.execute("welcome everyone", None)
    game.execute("ask question", "ann")
    return game


def test_the_turn_of_the_next_person_is_progress_until_everybody_had_it() -> None:
    game = DeclaredGame(declared("memory").declaration, PLAYERS, tuple(range(5)))
    watch, led = ProgressWatch(game), list[str]()
    for name in ("lay out cards", "name a pair", *["pass the turn"] * 6):
        game.now += 3.0
        watch.begin(game)
        assert game.execute(name, "ann" if name == "name a pair" else None).completed
        watch.done(game)
        led.append(watch.end(game))
    two_misses = led[4:]  # of ann, ben, and cat, each of whom had a turn at this count
    assert led[:4] == ["on"] * 4 and two_misses == ["on", "on", "back", "back"]


@pytest.mark.parametrize("answer", ["b", "B", "eight", "Eight!"])
def test_a_right_answer_by_letter_or_words_is_right(game: DeclaredGame, answer: str) -> None:
    assert game.observe("answer", "ann", answer)
    assert game.seen() == ("judge", ("right", "no"))


def test_another_option_is_wrong(game: DeclaredGame) -> None:
    assert game.observe("answer", "ann", "ten")
    assert game.value("answer", "ann") == "wrong"


@pytest.mark.parametrize(("answer", "certainty"), [("b", 0.5), ("eleventy", 1.0), ("", 1.0)])
def test_an_uncertain_answer_is_never_judged(
    game: DeclaredGame, answer: str, certainty: float
) -> None:
    assert not game.observe("answer", "ann", answer, certainty)
    assert game.value("answer", "ann") == "none"


def test_an_answer_of_another_person_does_not_count_for_the_turn(game: DeclaredGame) -> None:
    game.observe("answer", "ben", "eight")
    assert game.stage()[0].name == "listen"


def test_requests_are_served_in_the_order_in_which_they_came(game: DeclaredGame) -> None:
    game.observe("asking", "cat", "yes")
    game.observe("asking", "ben", "yes")
    stage, about = game.stage()
    assert (stage.name, about) == ("repeat", "cat")
    game.execute("repeat question", "cat")
    assert (game.queue, game.closed) == (["ben"], "cat")


def test_a_timer_is_observed_in_bands(game: DeclaredGame) -> None:
    assert game.seen() == ("listen", ("<20", "no"))
    game.now += 20
    assert game.seen() == ("listen", (">=20", "no"))


def test_turns_go_round_and_scores_are_each_players_own(game: DeclaredGame) -> None:
    game.observe("answer", "ann", "b")
    game.execute("confirm answer", "ann")
    score = game.declaration.facts["score"]
    assert [game.number(score, one) for one in PLAYERS] == [1, 0, 0]
    assert game.whom("whose turn") == "ben"


def test_a_copy_of_a_game_is_independent(game: DeclaredGame) -> None:
    before = joint_state(game)
    other = game.copy()
    other.observe("asking", "ben", "yes")
    other.observe("answer", "ann", "b")
    other.execute("confirm answer", "ann")
    assert joint_state(game) == before


def test_the_activity_lists_every_situation_of_its_games(
    trivia: DeclaredActivity, game: DeclaredGame
) -> None:
    assert joint_state(game).situation in trivia.situations
    assert len(trivia.situations) == 13


@pytest.mark.parametrize("name", DECLARED)
def test_every_text_can_be_prerendered_before_a_game(name: str) -> None:
    activity = declared(name)
    for behaviour in activity.behaviours.values():
        for template in (*behaviour.speech.values(), behaviour.image):
            text = activity.fill(template, "Rosa", ())
            assert "{" not in text
            assert bool(text) is ("{" not in template.replace("{name}", ""))


def test_turns_skip_absent_players(game: DeclaredGame) -> None:
    assert game.observe("here", "ann", "no")
    assert (game.whom("whose turn"), game.here) == ("ben", ("ben", "cat"))
    game.execute("tell answer", "ben")
    game.execute("tell answer", "cat")
    assert game.whom("whose turn") == "ben"
    assert game.observe("here", "ann", "yes")
    game.execute("tell answer", "cat")
    assert game.whom("whose turn") == "cat"
    game.execute("tell answer", "cat")
    assert game.whom("whose turn") == "ann"


def test_only_one_counts_only_present_players(game: DeclaredGame) -> None:
    one = FactCondition("only one", "answer", "is", "right")
    held = [game.holds(one, None)]
    for player in ("ann", "ben"):
        game.observe("answer", player, "eight")
        held.append(game.holds(one, None))
    game.observe("here", "ann", "no")
    assert [*held, game.holds(one, None)] == [False, True, False, True]


def test_absent_players_cannot_ask_answer_or_score(game: DeclaredGame) -> None:
    game.observe("asking", "ben", "yes")
    game.observe("here", "ben", "no")
    assert game.queue == [] and not game.observe("asking", "ben", "yes")
    assert not game.observe("answer", "ben", "eight")
    scores = "The scores: {score of each}."
    assert filled(game, scores, None) == "The scores: \x02ann\x03 0 and \x02cat\x03 0."
    every = FactCondition("every", "answer", "is", "right")
    for one in ("ann", "cat"):
        assert not game.holds(every, None)
        game.observe("answer", one, "eight")
    assert game.holds(every, None)


@pytest.mark.parametrize(
    ("hint", "text", "said"),
    [
        ("Sit up.", "{hint}. Well done.", "Sit up. Well done."),
        ("Sit up.", "{hint}!", "Sit up!"),
        ("Sit up!", "Now: {hint}.", "Now: Sit up!"),
        ("Sit up.", "{hint}...", "Sit up...."),
        ("Sit up.", "{hint} Well done.", "Sit up. Well done."),
        ("Sit up", "{hint}.", "Sit up."),
    ],
)
def test_a_sentence_in_a_text_has_one_full_stop(
    hint: str, text: str, said: str, trivia: DeclaredActivity
) -> None:
    items = replace(trivia.declaration.items, columns=("hint",), rows=((hint,),))
    game = DeclaredGame(replace(trivia.declaration, items=items), PLAYERS, (0,))
    game.execute("ask question", "ann")
    assert filled(game, text, None) == said


def test_the_screen_names_the_person_asked_while_their_question_stays(game: DeclaredGame) -> None:
    game.execute("allow time", None)
    assert person_on_screen(game, None) == "ann", "she has the time"
    assert person_on_screen(game, "ben") == "ben", "he is spoken to"
    game.execute("confirm answer", "ann")
    assert person_on_screen(game, None) is None, "nobody is asked"


def test_the_next_item_is_possible_while_items_are_left(game: DeclaredGame) -> None:
    while game.rounds_left:
        assert game.execute("ask question", "ann").completed
    asked = game.round
    assert not game.allows("ask question", "ann")
    assert not game.execute("ask question", "ann").completed
    assert game.round == asked


def test_scores_of_many_people_are_a_list_on_the_screen() -> None:
    people = [f"p{n}" for n in range(7)]
    game = DeclaredGame(declared("trivia").declaration, people)
    text = filled(game, "{score of each}", None, shown=True)
    assert text.count("\u00a00") == 7 and ", " in text and "  " not in text


def test_a_behaviour_differs_if_it_changes_more_than_a_timer(game: DeclaredGame) -> None:
    changes = {"allow time": False, "give hint": True, "confirm answer": True, "tell scores": True}
    for behaviour, differs in changes.items():
        before = game.copy()
        game.execute(behaviour, "ann")
        assert game.differs(before) is differs, behaviour
    before = game.copy()
    game.now += 60
    game.execute("allow time", None)
    assert not game.differs(before)


def test_the_screen_keeps_a_question_until_it_shows_something_else(
    trivia: DeclaredActivity,
) -> None:
    game = DeclaredGame(trivia.declaration, PLAYERS)

    def shown(behaviour: str, whom: str | None = None) -> str:
        before = game.copy()
        game.execute(behaviour, whom)
        return words(game, before, behaviour, "plain", whom)[1]

    question = shown("ask question", "ann")
    assert question.startswith("Which")
    assert shown("allow time") == shown("give hint", "ann") == question
    logged = decode(GameMemory, encode(memory_of(game)))
    again = game_from(game.declaration, PLAYERS, logged)
    assert again is not None and again.screen == game.screen == ("ask question", "ann", "ann")
    assert shown("confirm answer", "ann") == shown("allow time") != question
    assert shown("tell scores").split("  ")[1] == "\x02ben\x03:\u00a00", "a line for each"
    assert shown("close quiz") == game.declaration.title


def test_the_screen_keeps_the_player_of_its_text() -> None:
    raffle = read_declared(Path(__file__).parents[1] / "support/activities/raffle.toml")
    game = DeclaredGame(raffle.declaration, PLAYERS)
    shown = ""
    for behaviour in ("open the raffle", "draw a lot", "pass it on", "hand over"):
        before, whom = game.copy(), game.whom("whose turn")
        game.execute(behaviour, None if behaviour == "open the raffle" else whom)
        earlier, shown = shown, words(game, before, behaviour, "plain", whom)[1]
    assert "wins" in shown and shown == earlier
    assert f"\x02{game.whom('whose turn')}\x03" not in shown, "it is another one's turn now"


def test_the_next_item_clears_the_screen(tmp_path: Path) -> None:
    activity = read_declared(guess_the_sound(tmp_path))
    game = DeclaredGame(activity.declaration, PLAYERS)
    game.execute("play a sound", "ann")
    assert game.screen is None
    game.execute("show what it was", "ann")
    picture, sound = media(game, "let them listen")
    assert picture is not None and sound is None
    game.execute("play a sound", "ben")
    assert media(game, "play a sound")[0] is None


def test_the_last_player_cannot_leave(game: DeclaredGame) -> None:
    for one in ("cat", "ann"):
        assert game.observe("here", one, "no")
    assert not game.observe("here", "ben", "no")
    assert not game.observe("here", "dora", "no")
    assert game.here == ("ben",)


@pytest.mark.parametrize("name", DECLARED)
def test_games_end_despite_players_who_leave_and_return(name: str) -> None:
    activity, draw = declared(name), Random(f"{name}/leaving")
    players = activity.teams or PLAYERS
    for seed in range(5):
        world = DeclaredWorld(activity, players, seed=seed)
        shown, steps = expected_moves(activity), 0
        while not world.over and steps < 300:
            what: ChangeKind = "left" if draw.random() < 0.4 else "came"
            world.change(GameChange(game="g", steps=0, what=what, person=draw.choice(players)))
            move = shown.move(world.game)
            assert move is not None and move[1] not in world.away
            steps += 1
            world.execute(activity.action(activity.behaviours[move[0]], move[1], None))
        assert world.over
