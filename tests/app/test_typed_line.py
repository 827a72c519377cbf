"""Lines that staff type on the screen of a game: several people at once, and keys in words."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.app.command_grammar import command_reader
from tangy_tui.app.game_commands import ComesIn, GoesAway
from tangy_tui.app.game_questions import AsksGame
from tangy_tui.app.inquiry_grammar import WHO_IS_HERE, WHOSE_CARDS
from tangy_tui.app.screen_grammar import NEXT_GAME, Perform
from tangy_tui.app.typed_line import Several, Typed, read_typed
from tangy_tui.app.workspace import Workspace


def typed(workspace: Workspace, line: str, *, can: bool = True) -> Typed | None:
    def find(wanted: str) -> str:
        return workspace.find_person(wanted).id

    return read_typed(line, command_reader(workspace.activity, find), find, lambda action: can)


def test_one_line_can_say_of_several_people_that_they_left_or_came(workspace: Workspace) -> None:
    left = typed(workspace, "left User 1, User 2 and User 4")
    assert left == Several((GoesAway("user1"), GoesAway("user2"), GoesAway("user4")))
    assert typed(workspace, "here User 3 and User 2") == Several(
        (ComesIn("user3"), ComesIn("user2"))
    )
    assert typed(workspace, "left User 3") == GoesAway("user3")


@pytest.mark.parametrize(
    "line",
    [
        "User 1 and User 2 left",
        "User 1 & User 2 have left.",
        "User 1, User 2 have gone to bed",
        "User 1 and User 2 aren't here",
        "User 1 and User 2 had to leave",
        "User 1 and User 2 both left already",
    ],
)
def test_names_may_stand_before_the_word_that_they_left(workspace: Workspace, line: str) -> None:
    assert typed(workspace, line) == Several((GoesAway("user1"), GoesAway("user2")))


@pytest.mark.parametrize(
    "line",
    [
        "User 1 and User 2 are here",
        "User 1 and User 2 have come",
        "User 1 and User 2 came back",
        "here are User 1 and User 2",
    ],
)
def test_names_may_stand_before_the_word_that_they_came(workspace: Workspace, line: str) -> None:
    assert typed(workspace, line) == Several((ComesIn("user1"), ComesIn("user2")))


def test_names_that_nobody_has_may_be_an_answer_in_words(workspace: Workspace) -> None:
    assert typed(workspace, "the cards and the pens are here") is None
    assert typed(workspace, "the markers left") is None


def test_an_unknown_name_is_refused_without_a_list_of_everybody(data_folder: Path) -> None:
    workspace = Workspace(data_folder, users=13)
    for line, said in (
        ("left Xaver", "There is nobody called 'Xaver'."),
        ("left User 1 and Xaver", "There is nobody called 'Xaver'."),
        ("User 1 and Xaver left", "There is nobody called 'Xaver'."),
    ):
        with pytest.raises(TangyError) as refused:
            typed(workspace, line)
        assert str(refused.value) == said
    with pytest.raises(TangyError, match=r"called 'User 20': did you mean 'User 2'"):
        typed(workspace, "left User 20")
    workspace.close()


@pytest.mark.parametrize(
    ("words", "action"),
    [
        *((one, "whose_card") for one in WHOSE_CARDS),
        *((one, "presence") for one in WHO_IS_HERE),
        *((one, "next") for one in NEXT_GAME),
    ],
)
def test_words_about_cards_people_and_games_do_what_their_keys_do(
    workspace: Workspace, words: str, action: str
) -> None:
    assert typed(workspace, words) == typed(workspace, f"{words.title()}?") == Perform(action)
    answer = AsksGame("new game") if action == "next" else None
    assert typed(workspace, words, can=False) == answer
