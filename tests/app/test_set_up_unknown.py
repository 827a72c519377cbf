"""Lines of the set-up that are no commands: the nearest one is told, and nothing is lost."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from tangy_tui.app.readiness import CHECKS, Check
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.set_up import SetUpLines
from tangy_tui.text import set_up as text
from tangy_tui.text import set_up_lines as told
from tangy_tui.text.control import noted_words


def answers(workspace: Workspace, *lines: str) -> tuple[SetUp, list[str]]:
    """Return the set-up, and what is written after lines, of which the last leaves it."""
    setup, said = SetUp.of(workspace), list[str]()
    typed = iter((*lines, "end"))
    first = len(text.lines_of(setup)) + 1
    SetUpLines(setup, lambda: next(typed, None), said.append).run()
    return setup, said[first:]


@pytest.mark.parametrize(
    ("typed", "near"),
    [
        ("seet User 2 1", "seat"),
        ("begn", "begin"),
        ("acitvity trivia", "activity"),
        ("seat somewhere", "seat"),
        ("time forty", "time"),
        ("rename User 2 Rosa", "rename"),
        ("banana", ""),
    ],
)
def test_the_nearest_command_is_told(workspace: Workspace, typed: str, near: str) -> None:
    setup, said = answers(workspace, "time 40", "left User 3", typed)
    assert said[-1] == told.not_known_words(typed, near)
    assert setup.minutes == 40 and setup.away == {"user3"}


def test_please_and_people_who_come_later_are_understood(workspace: Workspace) -> None:
    setup, said = answers(workspace, "time 40 please", "please, left User 1", "banana please")
    assert setup.minutes == 40 and setup.away == {"user1"}
    assert said[-1] == told.not_known_words("banana", "")
    setup, _ = answers(workspace, "User 2 and User 3 come later")
    assert setup.away == {"user2", "user3"}
    reached = iter(["begin please"])
    assert SetUpLines(setup, lambda: next(reached, None), said.append).run()
    assert "cannot" not in told.not_known_words("begin the fun", "begin")


def test_a_command_of_games_is_known_but_works_later(workspace: Workspace) -> None:
    for typed in ("pause", "call again", "stop", "bingo 17"):
        assert answers(workspace, typed)[1] == [told.in_a_game_words(typed)]


def test_help_and_patterns_are_answered_before_a_game(workspace: Workspace) -> None:
    names = [pattern.name for pattern in workspace.activity.rules.patterns]
    assert answers(workspace, "help", "patterns")[1] == [
        told.help_words(SetUp.of(workspace)),
        told.patterns_to_choose(names),
    ]


def test_a_seat_that_does_not_exist_is_refused(workspace: Workspace) -> None:
    setup, said = answers(workspace, "seat User 2 30", "seat User 2 0")
    assert said == [told.no_seat_words(4)] * 2
    assert setup.seats == ["user1", "user2", "user3", "user4"]


def test_a_line_with_an_unknown_person_is_refused_whole(workspace: Workspace) -> None:
    setup, said = answers(workspace, "left User 1, User 2, nobody")
    assert not setup.away and len(said) == 1 and "'nobody'" in said[0]
    setup, said = answers(workspace, "left User 1 and User 2", "here User 1, nobody and User 2")
    assert setup.away == {"user1", "user2"} and "'nobody'" in said[-1]


def test_every_example_of_a_command_is_understood(workspace: Workspace) -> None:
    for word, example in told.COMMANDS.items():
        if word not in ("begin", "end", "try"):
            typed = example.replace("Rosa to", "User 2 to").replace("Rosa", "User 3")
            _, said = answers(workspace, typed)
            assert said and told.not_known_words(typed, word) not in said, example


def test_a_state_that_no_device_tells_has_words_of_its_own() -> None:
    words = [text.check_words(Check(name, "not told")) for name in CHECKS]
    assert len({*words}) == len(CHECKS)


def test_a_quiz_is_set_up_without_cards(tmp_path: Path) -> None:
    with closing(Workspace(tmp_path, activity="trivia", users=4)) as quiz:
        setup, said = answers(quiz, "help", "pace 20", "words gentle", "play for line", "begn")
        listed = told.help_words(setup)
        assert said[0] == listed and "left Rosa" in listed and "time 40" in listed
        words = ("pace", "play for", "winner", "visits", "gentle", "card")
        assert not [word for word in words if word in listed]
        assert said[1] == noted_words(StaffNote("no cards"), str)
        assert "cannot choose how strongly" in said[2]
        assert "line, full card" not in said[3] and "begin" in said[4]


def test_a_game_of_teams_is_set_up_without_new_people(tmp_path: Path) -> None:
    with closing(Workspace(tmp_path, activity="team-trivia")) as teams:
        listed = told.help_words(SetUp.of(teams))
        assert "guest" not in listed and "left Rosa" in listed
