"""Staff at the lines are asked about an interrupted game before another one begins."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tangy_profiles.game_records import GameEnding
from tangy_profiles.game_world import LIVE
from tangy_profiles.past_game import PastGame
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.app.interruption import find_interrupted
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.interrupted import ask_about_interrupted
from tests.app.test_joining import LiveGame


@pytest.fixture
def interrupted(taught: Path) -> Iterator[Workspace]:
    """A workspace whose last live game was interrupted."""
    workspace = Workspace(taught)
    LiveGame(workspace).play(3)
    workspace.close()
    workspace = Workspace(taught)
    yield workspace
    workspace.close()


def asked(workspace: Workspace, *lines: str) -> tuple[GameToPlay | None, list[str]]:
    """Ask, and type lines; return the game to play, and what was written."""
    past, typed, written = find_interrupted(workspace, LIVE), iter(lines), list[str]()
    assert isinstance(past, PastGame)
    chosen = ask_about_interrupted(
        workspace, past, lambda: next(typed, None), written.append, "tangy report"
    )
    return chosen, written


def test_the_game_goes_on_with_somebody_who_has_come(interrupted: Workspace) -> None:
    chosen, _ = asked(interrupted, "perhaps", "add user 2", "add Berta", "go on")
    assert chosen is not None and chosen.past is not None
    people = chosen.past.beginning.people
    assert len(people) == 5 and interrupted.name(people[-1]) == "Berta"
    assert chosen.past.newcomers == people[-1:]


def test_a_game_that_is_discarded_or_ended_is_over(interrupted: Workspace) -> None:
    chosen, written = asked(interrupted, "end")
    assert chosen is None and written[-1] == "tangy report"
    assert find_interrupted(interrupted, LIVE) is None
    LiveGame(interrupted).play(3)
    chosen, _ = asked(interrupted, "discard")
    assert chosen == GameToPlay(None) and find_interrupted(interrupted, LIVE) is None
    assert len(list(interrupted.store.events(GameEnding))) == 2


@pytest.mark.parametrize("lines", [(), ("quit",), ("what?", "Leave.")])
def test_a_game_is_kept_if_staff_leave(interrupted: Workspace, lines: tuple[str, ...]) -> None:
    chosen, _ = asked(interrupted, *lines)
    assert chosen is None and find_interrupted(interrupted, LIVE) is not None
