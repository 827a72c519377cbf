"""Lines tell what Tangy says while it says it, and once."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_profiles.game_rules import GamePlan
from tangy_tui.app.game_controller import GameController
from tangy_tui.console.in_progress import ProgressLines
from tangy_tui.interaction.game_events import Acted
from tests.app.test_declared_interruption import live, play

NAMES = {"user1": "Rosa", "user2": "Ben", "user3": "Ann"}


class Told:
    """A live game of trivia, and what its lines tell."""

    def __init__(self, minutes: int = 0) -> None:
        self.clock = SimpleNamespace(seconds=0.0)
        plan = SimpleNamespace(plan=GamePlan(minutes=minutes))
        self.world: DeclaredLiveWorld = live("trivia")
        robot = SimpleNamespace(going="", lets="", asks_about=("", ()))
        game = SimpleNamespace(log=self.clock, changes=plan)
        supervision = SimpleNamespace(world=self.world, game=game, over=False)
        control = SimpleNamespace(robot=robot, supervision=supervision)
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


def test_lines_tell_once_that_the_planned_time_is_over() -> None:
    told = Told(minutes=20)
    for seconds, lines in ((1199.0, 0), (1200.0, 1), (1300.0, 0), (5.0, 0), (1201.0, 1)):
        told.clock.seconds = seconds
        assert len(told.lines.news()) == lines
