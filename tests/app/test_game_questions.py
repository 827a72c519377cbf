"""What staff ask or want in a game in words of their own, and Tangy's answers."""

from __future__ import annotations

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import GamePlan
from tangy_tui.app.command_grammar import command_reader, read_command
from tangy_tui.app.game_commands import (
    CallAgain,
    ChangePace,
    EndGame,
    GoesAway,
    GoOn,
    Pause,
    StopRobot,
)
from tangy_tui.app.game_questions import AsksGame, read_game_question, read_saying
from tangy_tui.app.request_grammar import read_request, without_courtesy
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.typed_line import read_typed
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.text import game_answers as text
from tangy_tui.text.planned_time import SIMULATED_TIME
from tangy_tui.text.staff_lines import NOTHING_WRONG
from tests.bench.staff_lines import BINGO, NAMES, counts_of, find
from tests.support.planned_games import Planned

PEOPLE = {"user1": "Ada", "user2": "Otto", "user3": "Rosa", "user4": "Emil"}


def asked(planned: Planned, line: str) -> list[str]:
    lines = Inquiries(planned.control, PEOPLE.__getitem__, None, nobody).lines(line)
    return [] if lines is None else lines


def nobody(wanted: str) -> str:
    raise TangyError(f"There is nobody called {wanted!r}.")


def test_most_lines_in_words_of_their_own_are_understood() -> None:
    for name in ("from_staff", "development"):
        counts = counts_of(name)
        assert counts["nothing"] == 0 and counts["wrong"] <= 4, name
        assert counts["right"] > 5 * counts["offered"], name


@pytest.mark.parametrize(
    ("line", "topic"),
    [
        ("and what was the last number then?", "last call"),
        ("how many numbers have been called", "calls"),
        ("is the battery nearly dead", "battery"),
        ("who is taking part", "playing"),
        ("what must I do", "todo"),
        ("how do we leave the game", "end"),
    ],
)
def test_questions_are_read_by_what_they_are_about(line: str, topic: str) -> None:
    assert read_game_question(line) == AsksGame(topic)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "line",
    [
        *("what is the next number", "call one more number", "which numbers are on the card"),
        *("who needs no help", "the battery is empty", "has card 17 been checked", "where is Ada"),
        *("play the last song", "who is playing next", "do what I do"),
    ],
)
def test_other_words_are_no_question_about_the_game(line: str) -> None:
    assert read_game_question(line) is None
    assert read_request(line) is None


@pytest.mark.parametrize(
    ("line", "command"),
    [
        ("could you go a bit slower for everybody", ChangePace(-1)),
        ("not too fast for them, please", ChangePace(-1)),
        ("that was much too slow", ChangePace(1)),
        ("can we take a short break now", Pause()),
        ("please say the last number once more", CallAgain()),
        ("we have not heard that number", CallAgain()),
        ("Otto needs the toilet", GoesAway("otto")),
    ],
)
def test_requests_in_free_wording_become_commands(line: str, command: object) -> None:
    assert command_reader(BINGO, find)(line) == command


@pytest.mark.parametrize(
    "line",
    [
        *("not fast enough", "you go so fast", "do not go slower", "when is the break"),
        *("let us not take a break", "call the numbers again", "call one more number"),
        *("why are you too fast", "was that too fast"),
    ],
)
def test_their_opposites_and_questions_become_none(line: str) -> None:
    assert read_request(line) is None


def test_free_wording_is_an_answer_while_tangy_asks() -> None:
    assert command_reader(BINGO, find, lambda: True)("say that number again") is None
    for line in ("good game", "come over here", "nobody has bingo", "speak louder"):
        free = read_typed(line, lambda line: None, find, lambda id: True, BINGO.rules)
        assert isinstance(free, AsksGame), line
        assert read_typed(line, lambda line: None, find, lambda id: True, asks=True) is None


def test_please_changes_no_command() -> None:
    for line, command in (("go on please", GoOn()), ("please pause, Tangy", Pause())):
        assert read_command(line, find) == command
    assert read_command("please, left Otto please", find) == GoesAway("otto")
    assert read_command("end, thank you", find) in (EndGame(), StopRobot())
    assert without_courtesy("please") == "please"


@pytest.mark.parametrize(
    "line",
    [
        *("Somebody fell down!", "Otto has fallen", "an old lady is lying on the floor"),
        *("help, she collapsed", "Ada fainted", "one of the residents fell off the chair"),
    ],
)
def test_the_robot_stands_still_if_somebody_fell(line: str) -> None:
    assert command_reader(BINGO, find)(line) == StopRobot()
    assert command_reader(BINGO, find, lambda: True)(line) == StopRobot()


@pytest.mark.parametrize(
    "line",
    ["Ada fell asleep", "the card fell down", "has anybody fallen", "Otto has fallen asleep"],
)
def test_other_falls_do_not_stop_it(line: str) -> None:
    assert command_reader(BINGO, find)(line) != StopRobot()


def test_who_wants_no_more_may_be_left_out() -> None:
    for line in ("Ada is so tired", "Ada does not want to play any more", "Ada feels unwell"):
        assert "left Ada" in nearest_commands(line, NAMES, BINGO.rules), line
    assert nearest_commands("way too fast today", NAMES, BINGO.rules)[:1] == ("slower",)


def test_calls_are_told_by_their_labels(planned: Planned) -> None:
    planned.begin(GamePlan())
    assert asked(planned, "what was the last number") == [text.NOTHING_CALLED]
    planned.play(calls=3)
    label, called = planned.world.activity.deck.label, planned.world.called_now
    last = f"The last call was {label(called[-1])}. It was call {len(called)}."
    assert asked(planned, "which number did you call last?") == [last]
    told = asked(planned, "which numbers have been called")
    assert all(label(number) in told[0] for number in called) and told[1] == last
    assert asked(planned, f"was {called[-1]} called already?") == [
        f"Yes: Tangy called {label(called[-1])}. It was call {len(called)}, the last one."
    ]
    other = next(n for n in planned.world.activity.deck.numbers if n not in called)
    assert asked(planned, f"have we had {label(other)}") == [
        f"No: Tangy has not called {label(other)} yet."
    ]
    assert asked(planned, "has B-99 been called") == ["There is no B-99 in this game."]


def test_people_are_counted_and_those_without_a_visit_are_named(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.control.apply(GoesAway("user4"))
    assert asked(planned, "how many people are playing?") == [
        "3 people play: Ada, Otto and Rosa.",
        "Not here: Emil.",
    ]
    assert asked(planned, "who has not been helped yet?")[0].startswith("Tangy has visited nobody")
    planned.play()
    visited = [one.id for one in planned.control.view().people if one.unvisited is not None]
    told = asked(planned, "who was not visited yet")[0]
    assert visited and not any(PEOPLE[one] in told for one in visited)


def test_with_nothing_to_do_staff_hear_so_and_what_tangy_does(planned: Planned) -> None:
    planned.begin(GamePlan())
    told = asked(planned, "what should I do now?")
    assert told[0] == f"{NOTHING_WRONG} {text.NOTHING_TO_DO}" and len(told) > 1
    assert asked(planned, "what should i do") == asked(planned, "what") == told
    planned.control.apply(Pause())
    told = asked(planned, "what do I do")
    assert text.NOTHING_TO_DO not in told[0] and "paused" in told[1]
    planned.control.apply(StopRobot())  # somebody may have fallen
    told = asked(planned, "what do I do")
    assert NOTHING_WRONG not in told and "stopped" in told[0]


def test_where_tangy_is_the_time_the_battery_and_sayings_get_an_answer(planned: Planned) -> None:
    planned.begin(GamePlan())
    assert asked(planned, "where are you?")[0] == "Tangy is at the front."
    assert asked(planned, "how full is the battery") == [text.NO_BATTERY]
    (clock,) = asked(planned, "what time is it")
    assert clock.startswith("It is ") and SIMULATED_TIME not in clock
    assert asked(planned, "how do I end this?") == [text.HOW_TO_END]
    assert asked(planned, "thank you") == [text.WELCOME]
    assert asked(planned, "did you hear me?") == [text.HEARS]
    assert asked(planned, "was a mistake, no bingo") == [*text.NO_CLAIM]
    assert asked(planned, "speak a bit louder please") == [*text.VOICE]
    assert asked(planned, "start a new round") == [text.NEXT_LATER]


def test_another_game_is_begun_as_by_its_key() -> None:
    line = "can we begin another round please"
    assert read_saying(line, find) == AsksGame("new game")
    assert read_typed(line, lambda line: None, find, lambda id: True) == Perform("next")
    asked = read_typed(line, lambda line: None, find, lambda id: False)
    assert asked == AsksGame("new game")
