"""Staff read the number by which reports and the log name a game."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_tui.app.game_view import view_of
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameBegun, GameEnded
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.games import read_games
from tangy_tui.text.games import (
    TYPE_GO_ON,
    begun_words,
    ended_words,
    game_lines,
    resumed_words,
)


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


def test_a_game_has_the_number_of_the_log_in_each_session(
    workspace: Workspace, learnt: Policy
) -> None:
    for number in (1, 2, 3):
        control = scripted_controller(workspace.supervision(learnt, 5))
        begun = control.begin()[0]
        assert isinstance(begun, GameBegun)
        assert game_lines(begun, control.supervision, str) == [begun_words(number)]
        game = read_games(workspace.store)[-1]
        assert (game.id, game.number) == (begun.game, number)
        view = view_of(control)
        assert view is not None and view.number == number


def test_a_single_step_is_counted_as_one() -> None:
    assert ended_words(GameEnded("g", 1, "It was left.")) == (
        "The game stopped after 1 step. It was left."
    )
    assert ended_words(GameEnded("g", 1, None)) == "The game is over after 1 step."
    assert ended_words(GameEnded("g", 2, None)) == "The game is over after 2 steps."


def test_staff_read_calls_and_time_instead_of_steps() -> None:
    assert ended_words(GameEnded("g", 40, None), 23) == "The game is over after 23 calls."
    assert ended_words(GameEnded("g", 2, None), 0) == "The game is over."
    assert ended_words(GameEnded("g", 1, "It was left."), 0) == "The game stopped. It was left."
    again = resumed_words(1, 23, 723.0, TYPE_GO_ON)
    assert again == (
        "Game 1 is back where it was: 23 numbers called, 12:03 played. It is paused. Type: go on"
    )
    assert resumed_words(2, 0, 61.0, "") == "Game 2 is back where it was: 1:01 played."
