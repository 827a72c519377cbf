"""Simulated games by a plan of staff."""

from __future__ import annotations

from pathlib import Path
from typing import cast

from tangy_profiles.cards import winning_state
from tangy_profiles.game_rules import GamePlan
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.app.game_commands import GameCommand
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, GameChanged
from tangy_tui.learning.policies import load_policy
from tangy_tui.monitoring.supervision import Event


class Planned:
    """A run of simulated games, with all its events."""

    def __init__(self, folder: Path, users: int = 4) -> None:
        self.workspace = Workspace(folder, users=users)
        policy, _ = load_policy(self.workspace.store, self.workspace.activity)
        self.supervision = self.workspace.supervision(policy, 31)
        self.control: GameController = scripted_controller(self.supervision)
        self.events: list[Event] = []

    @property
    def world(self) -> SimulatedWorld:
        return cast(SimulatedWorld, self.supervision.world)

    def begin(self, plan: GamePlan) -> None:
        self.world.choose(plan)
        self.events = self.control.begin()

    def play(self, calls: int = 1_000) -> None:
        """Play until a number of calls or the end of the game."""
        while not self.supervision.over and len(self.world.called_now) < calls:
            self.events += go_on_by_script(self.control, expert=True)

    def win_twice(self) -> tuple[str, str]:
        """Play until somebody has won; let another card win, too, and return both people."""
        world, winning = self.world, winning_state(self.workspace.activity.user_states)
        while world.tracker.seen != winning:
            self.events += go_on_by_script(self.control, expert=True)
        first = world.tracker.place
        second = next(person for person in world.people if person != first)
        world.vouched |= {second}
        world.tracker.ask(second)
        return first, second

    def do(self, command: GameCommand) -> list[str]:
        """Carry out a command; return the kinds of its events."""
        told = self.control.apply(command)
        return [one.kind if isinstance(one, StaffNote) else str(one.what)  # type: ignore[union-attr]
                for one in told]  # fmt: skip

    def changes(self) -> list[str]:
        return [event.what for event in self.events if isinstance(event, GameChanged)]

    def celebrated(self) -> list[str | None]:
        acted = (event for event in self.events if isinstance(event, Acted))
        return [a.action.target for a in acted if a.action.behaviour.needs and a.outcome.completed]
