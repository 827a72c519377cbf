"""Staff report that people and teams leave and return in games declared by facts."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from tangy_profiles.game_records import GameChange
from tangy_profiles.store import Store
from tangy_sim.worlds.declared_world import DeclaredWorld
from tangy_tui.app.game_commands import ComesIn, GoesAway, PlanCommand, SetPace
from tangy_tui.app.plan_controls import GamePlanControls
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.interaction.changes import GameChanges
from tangy_tui.monitoring.supervision import Supervision
from tests.support.declared import declared


class Room:
    """A game that staff change, and its log."""

    def __init__(self, folder: Path, name: str, players: tuple[str, ...]) -> None:
        self.world = DeclaredWorld(declared(name), players, seed=1)
        self.store = Store.open(folder)
        self.changes = GameChanges(self.world, self.store)
        game = SimpleNamespace(changes=self.changes, change=self.change)
        self.running = SimpleNamespace(over=False, game=game)
        self.controls = GamePlanControls(
            cast(Supervision, self.running), lambda *_, **what: None, "test"
        )

    def change(self, what: Any, **about: Any) -> object:
        return self.changes.make("g", 0, what, **about)

    def do(self, command: PlanCommand) -> str:
        (note,) = self.controls.do(command)
        assert isinstance(note, StaffNote)
        return note.kind


@pytest.fixture
def room(tmp_path: Path) -> Iterator[Room]:
    made = Room(tmp_path, "trivia", ("user1", "user2", "user3"))
    yield made
    made.store.close()


def test_leaving_and_returning_are_logged(room: Room) -> None:
    assert room.do(GoesAway("user1")) == "goes"
    assert room.do(GoesAway("user1")) == "away before"
    assert room.world.game.here == ("user2", "user3")
    assert room.do(ComesIn("user1")) == "comes"
    assert room.do(ComesIn("user1")) == "here before"
    assert room.world.away == frozenset()
    logged = [(one.record.what, one.record.person) for one in room.store.events(GameChange)]
    assert logged == [("left", "user1"), ("came", "user1")]


def test_the_last_player_and_strangers_cannot_leave(room: Room) -> None:
    assert room.do(GoesAway("user9")) == "not playing"
    assert [room.do(GoesAway(one)) for one in ("user1", "user2", "user3")] == [
        "goes", "goes", "last one"
    ]  # fmt: skip
    assert room.do(SetPace(20)) == "no cards"


def test_the_next_game_begins_without_absent_people(room: Room) -> None:
    room.do(GoesAway("user1"))
    room.running.over = True
    assert room.do(GoesAway("user2")) == "goes"
    room.world.begin()
    assert room.world.game.here == ("user3",)
    assert room.do(ComesIn("user1")) == "comes"
    room.world.begin()
    assert list(room.world.game.here) == ["user1", "user3"]


def test_a_team_can_leave_like_a_person(tmp_path: Path) -> None:
    room = Room(tmp_path, "team-trivia", declared("team-trivia").teams)
    assert room.do(GoesAway("Reds")) == "goes"
    assert room.world.game.here == ("Blues",)
    room.store.close()
