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
from tangy_tui.text.games import begun_words, ended_words, game_lines


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
