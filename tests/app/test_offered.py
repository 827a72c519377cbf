"""Help lists the commands that a game takes, and no others."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_hw.robot_client.declared_live_world import DeclaredLiveWorld
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.activity import shipped_activities
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_tui.app.command_grammar import command_reader, read_command
from tangy_tui.app.game_commands import ChoosePatterns, Drive, VoidResponse
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.offered import needs_of, offered
from tangy_tui.app.similar_commands import nearest_commands
from tangy_tui.app.staff_notes import RefusalKind, StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.text.game_help import ROWS, Row, example_words
from tests.hw.links import FakeLink
from tests.support.live_worlds import live_world
from tests.support.teaching import taught_policy

OF_THE_GAME: set[RefusalKind] = {
    "no cards", "no robot", "nobody joins", "nothing to tell", "not in a simulation"
}  # fmt: skip
"""Refusals of what a game never takes."""


class Played:
    """A game of an activity, simulated or with a robot, after its first step."""

    def __init__(self, workspace: Workspace, *, with_robot: bool) -> None:
        self.workspace, activity = workspace, workspace.activity
        self.rules = activity.rules
        world = None
        if with_robot:
            kind = DeclaredLiveWorld if isinstance(activity, DeclaredActivity) else LiveWorld
            world = live_world(workspace, FakeLink(tuple(workspace.names)), kind, pace=0.0)
        supervision = workspace.supervision(taught_policy(workspace), 1, asks=True, world=world)
        self.control = GameController(supervision, "ann", robot=world)
        self.read = command_reader(activity, lambda who: workspace.find_person(who).id)
        self.control.begin()
        self.control.next()

    def refuses(self, row: Row) -> bool:
        """Carry out a line of help, and return whether this game can never take it."""
        name = self.workspace.name(self.control.supervision.world.people[0])
        if row.gives is ChoosePatterns:
            name = next((pattern.name for pattern in self.rules.patterns), "")
        command = self.read(row.typed.split(", ")[0].replace("NAME", name))
        if command is None:
            return True
        assert type(command) is row.gives
        if isinstance(command, Drive):
            command = replace(command, seconds=0.0)
        noted = [one for one in self.control.apply(command) if isinstance(one, StaffNote)]
        return any(one.kind in OF_THE_GAME for one in noted)


@pytest.fixture(params=shipped_activities())
def workspace(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Workspace]:
    with closing(Workspace(tmp_path, activity=request.param, users=2)) as opened:
        yield opened


@pytest.mark.slow
@pytest.mark.parametrize("with_robot", [False, True])
def test_help_lists_what_the_game_takes(workspace: Workspace, *, with_robot: bool) -> None:
    played = Played(workspace, with_robot=with_robot)
    offers = offered(played.control)
    rows = [row for row in ROWS if row.gives not in (None, VoidResponse)]  # nobody was asked yet
    assert [row.typed for row in rows if row.suits(offers)] == [
        row.typed for row in rows if not played.refuses(row)
    ]


@pytest.mark.parametrize("workspace", ["trivia"], indirect=True)
def test_a_quiz_names_no_cards_and_no_pace(workspace: Workspace) -> None:
    control = Played(workspace, with_robot=True).control
    offers, rules = offered(control), workspace.activity.rules
    told = "\n".join(Inquiries(control, workspace.name, None, str).lines("help") or [])
    assert "NAME: " in told and "drive left 2: " in told and "why not NAME: " in told
    told += example_words(rules, offers)
    words = ("card", "17", "B-5", "pace", "number", "called", "void")
    assert not [word for word in words if word in told]
    for typed in ("make it slower please", "card 17", "User 1 has card 17", "several winner"):
        assert not nearest_commands(typed, ["User 1"], rules, offers), typed


def test_a_line_of_help_names_its_command_if_that_needs_something() -> None:
    for row in ROWS:
        command = read_command(row.typed.split(", ")[0].replace("NAME", "user1"), str)
        kind = None if command is None else type(command)
        assert row.gives is not None or not needs_of(kind), row.typed
