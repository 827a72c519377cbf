"""Typed observations of staff set the fact that their words name."""

from __future__ import annotations

import pytest

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.typed_observations import TypedObservation, meant, sayable
from tests.support.declared import declared

PLAYERS = ("user1", "user2", "user3")


def _game(name: str, *done: str) -> DeclaredGame:
    game = DeclaredGame(declared(name).declaration, PLAYERS)
    for behaviour in done:
        game.execute(behaviour, game.whom("whose turn"))
    return game


@pytest.mark.parametrize("said", ["b", "B", "Earth", "the earth"])
def test_an_answer_is_typed_as_letter_or_words(said: str) -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    found = meant(game, "user1", said)
    assert found is not None and (found.fact, found.who) == ("answer", "user1")
    game.observe(*found)
    assert game.value("answer", "user1") == "right"


def test_words_without_a_name_belong_to_the_player_in_turn() -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    assert meant(game, None, "mars") == TypedObservation("answer", "user1", "mars")


@pytest.mark.parametrize("said", ["jupiter", "", "?", "none of them"])
def test_words_outside_the_options_are_ignored(said: str) -> None:
    assert meant(_game("trivia", "welcome everyone", "ask question"), "user1", said) is None


@pytest.mark.parametrize(
    ("activity", "said", "fact", "raw"),
    [
        ("exercises", "joins", "joins", "yes"),
        ("exercises", "is tired", "tired", "yes"),
        ("exercises", "not tired", "tired", "no"),
        ("exercises", "joins no", "joins", "no"),
        ("reminiscence", "sad", "mood", "sad"),
        ("reminiscence", "mood is well", "mood", "well"),
        ("reminiscence", "long", "story", "long"),
        ("memory", "match", "cards", "match"),
        ("memory", "asks for help", "asking", "yes"),
    ],
)
def test_a_fact_or_a_value_is_enough(activity: str, said: str, fact: str, raw: str) -> None:
    found = meant(_game(activity), "user2", said)
    assert found is not None and (found.fact, found.raw) == (fact, raw)


def test_a_fact_of_the_group_belongs_to_nobody() -> None:
    assert meant(_game("memory"), "user2", "miss") == TypedObservation("cards", None, "miss")


def test_the_suggestions_are_the_options_and_the_facts() -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    assert sayable(game) == ["Mars", "Earth", "Saturn"]
    assert sayable(_game("exercises")) == ["joins", "tired"]


def test_options_are_suggested_only_while_their_question_is_open() -> None:
    assert sayable(_game("trivia", "welcome everyone")) == []
    game = _game("trivia", "welcome everyone", "ask question")
    assert game.observe("answer", game.players[game.turn], "Mars")
    assert sayable(game) == ["Mars", "Earth", "Saturn"], "a person may correct themselves"
    game.execute("tell answer", game.players[game.turn])
    assert sayable(game) == []
