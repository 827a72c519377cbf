"""Typed commands of staff in a game: every command has words, and words mean one command."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import COMMAND_WORDS
from tangy_tui.app.claim_grammar import CHECK
from tangy_tui.app.command_grammar import (
    FIXED,
    command_reader,
    read_answer,
    read_command,
    read_help,
)
from tangy_tui.app.game_commands import (
    AUTONOMY,
    DIRECTIONS,
    AskFor,
    ChoosePatterns,
    ClaimCard,
    ComesIn,
    Confirm,
    Drive,
    EndGame,
    GameCommand,
    GoesAway,
    HasCard,
    LetWin,
    SetAutonomy,
    SetPace,
    StopRobot,
    TakeBackCall,
    Tell,
    VoidResponse,
)
from tangy_tui.app.inquiry_grammar import INQUIRIES, WHO_IS_HERE, WHOSE_CARDS, read_inquiry
from tangy_tui.app.screen_grammar import Perform, read_screen
from tangy_tui.app.teaching_grammar import AgainFrom, Leave, read_teaching
from tangy_tui.learning.teaching_events import Next, Redo, Undo
from tangy_tui.learning.verification import Reply, StopCommand
from tangy_tui.text.game_help import ROWS

BINGO = load_activity("bingo")
LANTERNS = Path(__file__).parent.parent / "lanterns.toml"


def find(wanted: str) -> str:
    if wanted.casefold() != "rosa":
        raise TangyError(f"There is nobody called {wanted!r}.")
    return "user2"


def read(text: str) -> GameCommand | None:
    return read_command(text, find, {"bingo"}, BINGO.rules)


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("Stop the robot!", StopRobot()),
        ("please stop the bingo", StopRobot()),
        ("stop", StopRobot()),
        ("  Call   BACK. ", TakeBackCall()),
        ("ask for Rosa", AskFor("user2")),
        ("help for rosa", AskFor("user2")),
        ("Rosa has card 17", HasCard("user2", 17)),
        ("rosa holds the card number 5.", HasCard("user2", 5)),
        ("card 17 is Rosa's", HasCard("user2", 17)),
        ("card 17 belongs to Rosa", HasCard("user2", 17)),
        ("void Rosa", VoidResponse("user2")),
        ("Rosa: B", Tell("user2", "B")),
        ("rosa says the honey", Tell("user2", "the honey")),
        ("nobody here says honey", None),
        ("answer: honey", Tell(None, "honey")),
        ("the answer is honey", Tell(None, "honey")),
        ("answer the question", None),
        ("take back B-5", TakeBackCall("B-5")),
        ("pace 20", SetPace(20)),
        ("Pace 7.5 seconds", SetPace(7.5)),
        ("bingo 17", ClaimCard(17)),
        ("Bingo 17 Rosa", ClaimCard(17, "user2")),
        ("bingo rosa", ClaimCard(0, "user2")),
        ("bingo for Rosa", ClaimCard(0, "user2")),
        ("Rosa has bingo!", ClaimCard(0, "user2")),
        ("rosa says Bingo", ClaimCard(0, "user2")),
        ("nobody has bingo", None),
        ("play for two lines, full card", ChoosePatterns(("two lines", "full card"))),
        ("play on for an X", ChoosePatterns(("x",))),
        ("here Rosa", ComesIn("user2")),
        ("Rosa is here now", ComesIn("user2")),
        ("rosa came back", ComesIn("user2")),
        ("Rosa has left", GoesAway("user2")),
        ("Rosa went home", GoesAway("user2")),
        ("Rosa is leaving now", GoesAway("user2")),
        ("Rosa is not here", GoesAway("user2")),
        ("Rosa isn't here", GoesAway("user2")),
        ("Rosa's gone", GoesAway("user2")),
        ("Rosa went to the toilet", GoesAway("user2")),
        ("Rosa has to go", GoesAway("user2")),
        ("Rosa's here", ComesIn("user2")),
        ("Rosa arrives", ComesIn("user2")),
        ("here comes Rosa", ComesIn("user2")),
        ("Rosa has come", ComesIn("user2")),
        ("nobody left", None),
        ("drive left", Drive("left", 1.0)),
        ("drive forward 2.5 s", Drive("forward", 2.5)),
        ("autonomy each", SetAutonomy("each")),
        ("call a number", None),
        ("stop teasing her", None),
        ("", None),
    ],
)
def test_words_are_read_as_their_command(text: str, command: GameCommand | None) -> None:
    assert read(text) == command


@pytest.mark.parametrize(
    "text",
    [
        "end the game", "End the game, please.", "please finish the game", "let's end our bingo",
        "let us finish the game here", "end game", "can you end the game for today?",
    ],
)  # fmt: skip
def test_plain_words_end_the_game_unless_tangy_asks_what_to_do(text: str) -> None:
    assert command_reader(BINGO, find)(text) == EndGame()
    assert command_reader(BINGO, find, lambda: True)(text) is None


@pytest.mark.parametrize("text", ["don't end the game yet", "end the visit", "end the trivia"])
def test_other_words_about_an_end_are_no_command(text: str) -> None:
    assert command_reader(BINGO, find)(text) is None


@pytest.mark.parametrize(
    ("text", "several"),
    [
        *(("one winner please", False), ("only one winner today.", False)),
        *(("please let only one person win", False), ("just one winner", False)),
        *(("everybody wins", True), ("let everyone win please", True)),
        *(("everybody who has it wins", True), ("we want several winners", True)),
    ],
)
def test_how_many_win_is_read_in_plain_words(text: str, *, several: bool) -> None:
    assert read(text) == LetWin(several=several)


@pytest.mark.parametrize("text", ["who wins", "everybody wants to win", "one more", "has all won"])
def test_other_words_about_a_win_change_no_rule(text: str) -> None:
    assert not isinstance(read(text), LetWin)


@pytest.mark.parametrize("words", sorted(FIXED))
def test_fixed_commands_are_read_in_any_case(words: str) -> None:
    assert read(words.upper()) == FIXED[words]


def test_every_command_has_words_and_is_in_the_help() -> None:
    typed = {type(command) for command in FIXED.values()} | {
        type(read(text)) for text in ("stop", "autonomy each", "ask for Rosa", "void Rosa",
                                      "Rosa: B", "drive left", "pace 9", "bingo 1", "play for x",
                                      "here rosa", "left rosa", "add Berta", "Rosa has card 7",
                                      "plan 20 minutes")
    }  # fmt: skip
    assert typed == set(get_args(GameCommand)) - {Confirm}  # Confirm has the keys Y and N
    helped = " ".join(row.typed for row in ROWS)
    assert all(word in helped for word in ("stop", "pause", "take over", "ask for", "void", "end"))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("ask for Nobody", "There is nobody called 'Nobody'."),
        ("autonomy often", f"There is no autonomy 'often': {', '.join(AUTONOMY)}."),
        ("drive up", f"Tangy cannot drive 'up': {', '.join(DIRECTIONS)}."),
        ("drive left 60", "One line drives for 5 s at most."),
        ("pace 90", "The pace is from 5 to 60 s."),
        (
            "bingo seventeen",
            "'seventeen' is no number of a card. Say it as in: bingo 17.",
        ),
        ("bingo", "'bingo' alone is no number of a card. Say it as in: bingo 17."),
        ("left Nobody", "There is nobody called 'Nobody'."),
        ("Nobody has card 17", "There is nobody called 'Nobody'."),
    ],
)
def test_an_incomplete_command_is_refused_in_one_sentence(text: str, said: str) -> None:
    with pytest.raises(TangyError, match=said.replace(".", r"\.")):
        read(text)


@given(st.text(max_size=60))
def test_any_text_is_read_ignored_or_refused(text: str) -> None:
    try:
        read(text)
    except TangyError as error:
        assert str(error).isprintable()


@pytest.mark.parametrize(
    ("typed", "word"),
    [
        ("undo", Undo()), ("REDO", Redo()), ("next", Next()), ("quit", Leave()),
        ("again 7", AgainFrom(7)), ("show again from step 12", AgainFrom(12)),
        ("again", AgainFrom(None)), ("again n", AgainFrom(None)),
        ("seen", "shown"), ("why", "why"), ("?", "help"), ("where", "where"),
        ("stop the robot", StopCommand("stop the robot")),
        ("next number", None), ("tell a joke", None), ("go to rosa", None),
    ],
)  # fmt: skip
def test_teaching_words_mean_the_same_on_screens_and_by_lines(typed: str, word: object) -> None:
    assert read_teaching(typed, {"bingo"}) == word


def test_an_answer_is_yes_no_or_a_number() -> None:
    assert read_answer(" YES ") == Reply(yes=True) and read_answer("n") == Reply(yes=False)
    assert read_answer("3") == Reply(yes=False, alternative=3)
    for other in ("", "perhaps", "99999", "-1", "²", "٣"):
        assert read_answer(other) is None


@pytest.mark.parametrize("activity", ["bingo", str(LANTERNS)])
def test_no_phrase_of_an_activity_is_read_as_another_command(activity: str) -> None:
    profile = load_activity(activity)
    phrases = [phrase for one in profile.behaviours.values() for phrase in one.phrases]
    title = profile.title.casefold().split()
    taken = [one for one in phrases if read_teaching(one, title) or read_inquiry(one)]
    in_games = [one for one in phrases if read_command(one, str, title) is not None]
    assert (taken, in_games) == ([], [])


@pytest.mark.parametrize(
    "text",
    [
        *("why", "Why?", "why that", "What are you doing?", "what is Tangy doing now"),
        *("what is happening now", "what's going on", "What happens next?", "what next"),
        *("why are you waiting", "why do you do that?", "what does the robot do next"),
        *("what are you waiting for", "what will you do now"),
    ],
)
def test_questions_about_what_tangy_does_ask_why(text: str) -> None:
    assert read(text) is None
    assert read_inquiry(text) == "why"
    assert read_screen(text) == Perform("why")


@pytest.mark.parametrize(
    "text",
    [
        *("why don't you go to Rosa", "why don\u2019t you help Rosa", "will you go to Rosa"),
        *("why not visit Rosa", "how about you go to Rosa", "would you please help Rosa"),
    ],
)
def test_a_proposal_to_go_to_a_person_asks_for_help_there(text: str) -> None:
    assert read_help(text, find) == AskFor("user2")


@pytest.mark.parametrize("text", ["what should i do", "what is wrong with Rosa", "why did she win"])
def test_other_questions_do_not_ask_why(text: str) -> None:
    assert read_inquiry(text) != "why"


def test_messages_are_asked_for_by_their_word() -> None:
    assert read_screen("messages") == Perform("messages")
    assert read("messages") is None


def test_no_command_of_staff_begins_with_a_word_that_may_be_a_claim() -> None:
    listed = [part for row in ROWS for part in re.split(r"[,;] ", row.typed)]
    commands = [*FIXED, *listed, *INQUIRIES, *WHO_IS_HERE, *WHOSE_CARDS, "stop"]
    first = {one.split()[0].strip(":,") for one in commands}
    assert first - COMMAND_WORDS <= {"NAME", "?", CHECK}
    assert BINGO.rules.claim not in COMMAND_WORDS
