"""Typed observations of staff set the fact that their words name."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tangy_profiles.activity import read_activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.judging import judged
from tangy_profiles.declared.player_reports import PlayerReport, read_report
from tangy_profiles.declared.typed_observations import TypedObservation, meant, sayable
from tests.support.declared import declared

PLAYERS = ("user1", "user2", "user3")
ACTIVITIES = Path(__file__).parents[1] / "support" / "activities"


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
    assert sayable(game) == ["Mars", "Earth", "Saturn", "right", "wrong"]
    assert sayable(_game("exercises")) == ["joins", "tired"]


def test_options_are_suggested_only_while_their_question_is_open() -> None:
    assert sayable(_game("trivia", "welcome everyone")) == []
    game = _game("trivia", "welcome everyone", "ask question")
    assert game.observe("answer", game.players[game.turn], "Mars")
    assert sayable(game) == ["Mars", "Earth", "Saturn", "right", "wrong"], (
        "a person may correct themselves"
    )
    game.execute("tell answer", game.players[game.turn])
    assert sayable(game) == []


@pytest.mark.parametrize(
    ("said", "value"),
    [
        ("right", "right"),
        ("it is right", "right"),
        ("Correct!", "right"),
        ("answer right", "right"),
        ("answer is not right", "wrong"),
        ("not right", "wrong"),
        ("not wrong", "right"),
        ("wrong", "wrong"),
    ],
)
def test_staff_can_say_that_an_answer_was_right_or_wrong(said: str, value: str) -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    told = read_report(game, "user1", said, 1.0)
    assert told is not None and told.counts and told.by_staff
    assert told.judgement == value
    game.observe(*told.meant)
    assert game.value("answer", "user1") == value


def test_no_answer_is_no_verdict() -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    assert meant(game, "user1", "none") is None
    assert meant(game, "user1", "answer none") is None
    fact = game.declaration.facts["answer"]
    assert judged(fact, game.declaration.items, game.row, "=none", 1.0) is None


def test_an_answer_that_was_not_clear_is_not_judged() -> None:
    game = _game("trivia", "welcome everyone", "ask question")
    told = read_report(game, "user1", "earth", 0.5)
    assert told == PlayerReport(TypedObservation("answer", "user1", "earth"), True, "", False)


def test_a_value_that_is_denied_is_not_observed() -> None:
    assert meant(_game("reminiscence"), "user1", "not sad") is None
    assert meant(_game("exercises"), "user1", "not joins") == TypedObservation(
        "joins", "user1", "no"
    )


def test_words_without_a_name_are_about_the_person_whom_tangy_addresses() -> None:
    game = DeclaredGame(declared("reminiscence").declaration, PLAYERS)
    assert meant(game, None, "sad") == TypedObservation("mood", None, "sad")
    game.execute("open the circle", None)
    game.execute("show a picture", "user2")
    assert meant(game, None, "long") == TypedObservation("story", "user2", "long")
    alone = DeclaredGame(declared("reminiscence").declaration, ("user3",))
    assert meant(alone, None, "sad") == TypedObservation("mood", "user3", "sad")


def _buzz(folder: Path, *changes: tuple[str, str]) -> DeclaredGame:
    """Return a game in which anybody may call out an answer; its first question is asked."""
    for name in ("buzz.toml", "buzz.csv"):
        shutil.copy(ACTIVITIES / name, folder)
    file = folder / "buzz.toml"
    for before, after in changes:
        assert before in file.read_text()
        file.write_text(file.read_text().replace(before, after))
    activity = read_activity(file)
    assert isinstance(activity, DeclaredActivity)
    game = DeclaredGame(activity.declaration, PLAYERS)
    game.execute("welcome all", None)
    return game


def test_a_fact_is_no_free_answer(tmp_path: Path) -> None:
    game = _buzz(tmp_path)
    assert meant(game, "user1", "tired") == TypedObservation("tired", "user1", "yes")
    game.execute("ask all", None)
    assert meant(game, "user1", "tired") == TypedObservation("tired", "user1", "yes")
    assert meant(game, "user1", "tea") == TypedObservation("guess", "user1", "tea")


def test_an_answer_counts_if_the_game_waits_for_those_of_all(tmp_path: Path) -> None:
    every = ("any guess is right", "every guess is right"), ("any guess is wrong", "clock is >=25")
    game = _buzz(tmp_path, *every, ('about = "whose guess is wrong" },\n', 'sees = ["clock"] },\n'))
    for who in PLAYERS:
        early = read_report(game, who, "right", 1.0)
        assert early is not None and not early.counts
    game.execute("ask all", None)
    for who in PLAYERS:
        told = read_report(game, who, "right", 1.0)
        assert told is not None and told.counts
        game.observe(*told.meant)
    assert game.stage()[0].name == "right"
    game.execute("tell it", None)
    late = read_report(game, "user1", "wrong", 1.0)
    assert late is not None and not late.counts


NO_STAGE_READS = (
    ('"any guess is right"], about = "whose guess is right"', '"points is >=1"]'),
    ("points = {", "points = { bands = [1],"),
    ('"any guess is wrong"], about = "whose guess is wrong"', '"clock is >=25"]'),
    ("{name} was the first to be right", "somebody has points"),
    ("{name} was wrong", "nobody said anything"),
)


@pytest.mark.parametrize("by_a_test", [True, False])
def test_an_answer_that_no_stage_reads_counts_at_any_time(tmp_path: Path, by_a_test: bool) -> None:
    changes = [("points is", "any points is"), ("[people]", "[people]")]
    if by_a_test:
        test = 'solved = { kind = "test", when = ["any guess is right"] }\n[people]'
        changes = [("points is >=1", "solved is yes"), ("[people]", test)]
    game = _buzz(tmp_path, *NO_STAGE_READS, *changes)
    early = read_report(game, "user1", "right", 1.0)
    assert early is not None and early.counts is not by_a_test
    game.execute("ask all", None)
    told = read_report(game, "user1", "right", 1.0)
    assert told is not None and told.counts


@pytest.mark.parametrize(
    ("said", "value"), [("False", "right"), ("wrong", "wrong"), ("true", "wrong")]
)
def test_the_right_answer_of_an_item_is_no_verdict_on_it(
    said: str, value: str, tmp_path: Path
) -> None:
    for name in ("buzz.toml", "buzz.csv"):
        shutil.copy(ACTIVITIES / name, tmp_path)
    (tmp_path / "buzz.csv").write_text("ask,answer\nTrue or false: fish fly?,false\n")
    file = tmp_path / "buzz.toml"
    file.write_text(file.read_text().replace("rounds = 4", "rounds = 1"))
    activity = read_activity(file)
    assert isinstance(activity, DeclaredActivity)
    game = DeclaredGame(activity.declaration, PLAYERS)
    for behaviour in ("welcome all", "ask all"):
        game.execute(behaviour, None)
    found = meant(game, "user1", said)
    assert found is not None
    game.observe(*found)
    assert game.value("guess", "user1") == value


def test_an_answer_counts_only_while_its_question_is_open() -> None:
    game = _game("trivia", "welcome everyone")
    early = read_report(game, "user1", "right", 1.0)
    assert early is not None and not early.counts
    game.execute("ask question", "user1")
    other = read_report(game, "user2", "earth", 1.0)
    assert other is not None and not other.counts, "it is the turn of another person"
    game.observe("asking", "user3", "yes")
    asked = read_report(game, "user1", "earth", 1.0)
    assert asked is not None and asked.counts, "also while a person asks for help"
    game.execute("tell answer", "user1")
    late = read_report(game, "user1", "earth", 1.0)
    assert late is not None and not late.counts


def test_a_fact_without_a_name_is_only_assumed_of_the_person_in_turn() -> None:
    told = read_report(_game("exercises"), None, "tired", 1.0)
    assert told is not None and told.whose and not told.counts
    own = read_report(_game("trivia", "welcome everyone", "ask question"), None, "mars", 1.0)
    assert own is not None and own.meant.who == "user1" and own.counts
    heard = read_report(_game("exercises"), None, "tired", 1.0, "speech")
    assert heard is not None and heard.meant.who == "user1"
    named = read_report(_game("exercises"), "user3", "tired", 1.0, "speech")
    assert named == PlayerReport(TypedObservation("tired", "user3", "yes"), True, "", False)


def test_a_fact_of_the_group_needs_no_name() -> None:
    told = read_report(_game("memory"), None, "miss", 1.0)
    assert told == PlayerReport(TypedObservation("cards", None, "miss"), True, "", False)
