"""Several winners: after a win Tangy goes to those who may have won as well, and then it ends."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import cast

import pytest

from tangy_profiles.game_rules import GamePlan
from tangy_profiles.state import FRONT
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, GameChanged, GameEnded
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.supervision import Event


class Won:
    """A game for twelve people with several winners: one has the pattern, and nobody asks."""

    def __init__(self, folder: Path, learnt: Policy, patterns: tuple[str, ...] = ()) -> None:
        self.workspace = Workspace(folder, users=12)
        supervision = self.workspace.supervision(learnt, 31)
        self.world = cast(SimulatedWorld, supervision.world)
        self.world.users = replace(self.world.users, miss=0.0, ask=1e-9, slip=0.0)
        self.world.choose(GamePlan(patterns, several=True))
        self.supervision = supervision
        self.control = scripted_controller(supervision)
        self.events: list[Event] = self.control.begin()
        while not (
            won := [p for p, card in self.world.known_cards.items() if self.world.wins(card)]
        ):
            self.step()
        self.winner = won[0]
        self.others = [person for person in self.world.people if person not in won]
        """Whose cards do not win."""
        self.since = len(self.events)

    def ask(self, *people: str) -> None:
        """Let the winner ask, and then others."""
        for person in (self.winner, *people):
            self.world.tracker.ask(person)

    def step(self) -> None:
        self.events += go_on_by_script(self.control, expert=True)

    def play(self, *, asks: str = "") -> None:
        """Play on; after the first change a person asks again whenever Tangy is elsewhere."""
        while not self.supervision.over:
            if asks and self.changes() and self.world.tracker.place != asks:
                self.world.tracker.ask(asks)
            self.step()

    def changes(self) -> list[str]:
        return [e.what for e in self.events[self.since :] if isinstance(e, GameChanged)]

    def visited(self) -> list[str]:
        """The people to whom Tangy went after the win, in order."""
        acted = [event for event in self.events[self.since :] if isinstance(event, Acted)]
        went = [a.after.place for a in acted if a.after.place not in (FRONT, a.state.place)]
        assert went.pop(0) == self.winner
        return went


def ended_well(game: Won) -> bool:
    last = game.events[-1]
    return isinstance(last, GameEnded) and last.stopped is None


def test_those_whose_card_does_not_win_do_not_delay_the_end(taught: Path, learnt: Policy) -> None:
    game = Won(taught, learnt)
    game.ask(*game.others[:3])
    game.play()
    assert game.changes() == [] and game.visited() == [] and ended_well(game)
    game.workspace.close()


def test_a_person_who_asks_after_the_win_does_not_delay_the_end(
    taught: Path, learnt: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    game = Won(taught, learnt)
    monkeypatch.setattr(SimulatedWorld, "known_cards", property(lambda world: {}))
    first, second, late, *_ = game.others
    game.ask(first, second)
    game.play(asks=late)
    assert game.changes() == ["others first", "won"] and ended_well(game)
    assert game.visited() == [first, second, game.winner]
    game.workspace.close()


def test_a_person_who_asks_again_after_their_visit_does_not_delay_the_end(
    taught: Path, learnt: Policy, monkeypatch: pytest.MonkeyPatch
) -> None:
    game = Won(taught, learnt)
    monkeypatch.setattr(SimulatedWorld, "known_cards", property(lambda world: {}))
    first = game.others[0]
    game.ask(first)
    game.play(asks=first)
    assert game.visited() == [first, game.winner] and ended_well(game)
    game.workspace.close()


def test_a_card_that_wins_comes_before_the_others_who_ask(taught: Path, learnt: Policy) -> None:
    game = Won(taught, learnt)
    loser, claims, *_ = game.others
    game.ask(loser, claims)
    game.world.vouched |= {claims}
    game.play()
    assert game.visited() == [claims] and ended_well(game)
    game.workspace.close()


def test_the_next_pattern_begins_and_requests_stay(taught: Path, learnt: Policy) -> None:
    game = Won(taught, learnt, ("line", "two lines"))
    game.ask(*game.others[:2])
    while "played on" not in game.changes():
        game.step()
    assert game.changes() == ["played on"]
    assert game.world.tracker.queue[:2] == game.others[:2]
    assert game.world.patterns.played == game.workspace.activity.rules.pattern("two lines").on(
        game.world.own_deck
    )
    game.workspace.close()
