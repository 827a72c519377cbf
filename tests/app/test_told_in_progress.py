"""Lines tell what Tangy says while it says it, and once."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from types import SimpleNamespace
from typing import cast

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_tui.app.game_controller import GameController
from tangy_tui.console.in_progress import ProgressLines
from tangy_tui.interaction.game_events import Acted
from tests.app.test_declared_interruption import live, play

NOW = datetime(2026, 3, 2, 9, 30, tzinfo=UTC)
NAMES = {"user1": "Rosa", "user2": "Ben", "user3": "Ann"}


class Told:
    """A live game of trivia, and what its lines tell."""

    def __init__(self, minutes: int = 0) -> None:
        self.clock = SimpleNamespace(seconds=0.0)
        self.ends = NOW + timedelta(minutes=minutes) if minutes else None
        self.time = SimpleNamespace(ends=self.ends, left=None, clock=lambda: NOW)
        self.world: DeclaredLiveWorld = live("trivia")
        robot = SimpleNamespace(going="", lets="", asks_about=("", ()))
        game = SimpleNamespace(log=self.clock, game="g1")
        self.game = game
        supervision = SimpleNamespace(world=self.world, game=game, over=False)
        control = SimpleNamespace(robot=robot, supervision=supervision, time=self.time)
        self.lines = ProgressLines(cast(GameController, control), NAMES.__getitem__)
        self.world.begin()

    def done(self) -> list[str]:
        """Return the lines about a step that is over."""
        speech = self.world.saying
        for person, name in NAMES.items():
            speech = speech.replace(person, name)
        acted = cast(Acted, SimpleNamespace(speech=speech))
        return self.lines.step(acted, ["1. begins -> ask", f"   Tangy says: {speech}"])


def test_words_are_told_during_the_step_and_not_again_after_it() -> None:
    told = Told()
    assert told.lines.news() == []
    play(told.world, 1)  # the speech has begun, and the step is not reported yet
    (said,) = told.lines.news()
    assert told.world.saying and said.startswith("Tangy says: ")
    assert told.lines.news() == []
    assert told.done() == ["1. begins -> ask"]


def test_words_of_a_step_that_was_over_at_once_are_told_with_it() -> None:
    told = Told()
    play(told.world, 1)
    assert len(told.done()) == 2
    assert told.lines.news() == []


def test_what_a_resumed_game_still_shows_is_told_once() -> None:
    told = Told()
    assert told.lines.resumed() == []
    told.world.said_before = "\x02user1\x03, question 3?"
    assert [line.endswith("Rosa, question 3?") for line in told.lines.resumed()] == [True]
    assert told.lines.news() == [], "Tangy does not say it now"


def test_lines_tell_once_in_each_game_that_the_planned_time_is_over() -> None:
    told = Told(minutes=20)
    for game, left, lines in (("g1", 1, 0), ("g1", 0, 1), ("g1", -100, 0), ("g2", -120, 1)):
        told.game.game, told.time.left, told.clock.seconds = game, float(left), 100.0
        news = told.lines.news()
        assert len(news) == lines
        assert ("plan 20 minutes" in "".join(news)) is bool(lines)
        assert ("has been over since" in "".join(news)) is (game == "g2")


def test_lines_tell_that_a_newly_planned_time_is_over_as_well() -> None:
    told = Told(minutes=20)
    told.time.left = -1.0
    assert told.ends is not None and len(told.lines.news()) == 1
    told.time.ends = told.ends + timedelta(minutes=10)
    assert len(told.lines.news()) == 1 and not told.lines.news()
