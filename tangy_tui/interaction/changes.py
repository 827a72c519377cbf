"""Changes of a game besides its behaviours: logged, applied to the world, and announced."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from tangy_profiles.game_records import ChangeKind, GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.gathering import as_gathering
from tangy_profiles.past_game import PastGame
from tangy_profiles.planned_game import as_planned
from tangy_profiles.state import ActivityState
from tangy_profiles.store import Store
from tangy_tui.interaction.game_events import GameChanged
from tangy_tui.world import World


class GameChanges:
    """The changes of one world's games; without cards, people can only leave and come."""

    def __init__(self, world: World, store: Store) -> None:
        """Change the games of a world, and log the changes."""
        self.world = as_planned(world)
        """The world, if staff can plan more in it than who is present; else None."""
        self.gathering = as_gathering(world)
        self.on_change: Callable[[ActivityState], object] = lambda now: None
        """Called with the state after each change, so that a request it ended is no fault."""
        self._store = store

    @property
    def plan(self) -> GamePlan:
        """The plan that staff chose for the game."""
        return GamePlan() if self.gathering is None else self.gathering.game_plan

    @property
    def logged(self) -> dict[str, Any]:
        """The plan, as logged at the beginning of a game."""
        return asdict(self.plan)

    @property
    def left_out(self) -> tuple[str, ...]:
        """The strategies that staff excluded for everybody."""
        if self.world is None or not self.plan.strength:
            return ()
        return self.world.activity.rules.left_out(self.plan.strength)

    def resume(self, past: PastGame) -> None:
        """Restore the plan of an interrupted game."""
        if self.gathering is not None:
            self.gathering.choose(past.beginning.plan)

    def due(self, game: str, steps: int) -> list[GameChanged]:
        """Make the change that is due before the next behaviour, if any."""
        if self.world is None or (due := self.world.due) is None:
            return []
        return [self.make(game, steps, due.what, person=due.person, number=due.number)]

    def make(self, game: str, steps: int, what: ChangeKind, **about: Any) -> GameChanged:
        """Log a change, apply it to the world, and announce it to the group."""
        change = GameChange(game=game, steps=steps, what=what, **about)
        self._store.append(change)
        said = ""
        if self.world is not None:
            self.world.change(change)
            self.on_change(self.world.tracker.state())
            if said := self._said(change):
                self.world.announce(said)
        elif self.gathering is not None:
            self.gathering.change(change)
            self.on_change(self.gathering.observe())
        return GameChanged(what, change.person, change.number, change.patterns, said)

    def _said(self, change: GameChange) -> str:
        """Return the announcement of a change; "" if there is none."""
        if (world := self.world) is None:
            return ""
        rules, deck = world.activity.rules, world.activity.deck
        match change.what:
            case "played on":
                return rules.play_on.format(pattern=world.patterns.label)
            case "taken back":
                return rules.taken_back.format(call=deck.label(change.number))
            case "all called" | "nobody won" as what:
                sentence = rules.all_called if what == "all called" else rules.nobody_won
                return sentence.format(pattern=world.patterns.label)
            case _:
                return ""
