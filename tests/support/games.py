"""Supervised games: played to their end or to a point, and their events."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from tangy_profiles.state import FRONT
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, GameEnded
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.supervision import Event, Supervision


def world_of(game: Supervision) -> FaultyWorld:
    """Return the simulated world of a game."""
    assert isinstance(game.world, FaultyWorld)
    return game.world


def play(
    game: Supervision,
    *,
    expert: bool = True,
    stops: Callable[[Supervision], object] = lambda _: False,
) -> list[Event]:
    """Play one game with scripted people to its end, or until a condition is true."""
    control = scripted_controller(game)
    events = control.begin()
    while not (game.over or stops(game)):
        events += go_on_by_script(control, expert=expert)
    return events


def watched_game(workspace: Workspace, learnt: Policy) -> GameController:
    """Return a game after five steps that other consoles may watch."""
    control = scripted_controller(workspace.supervision(learnt, 5))
    control.begin()
    while control.supervision.steps < 5:
        go_on_by_script(control, expert=False)
    workspace.door.attach(control)
    workspace.door.open()
    return control


def until(
    game: Supervision, stops: Callable[[Supervision], object], most: int = 400
) -> list[Event]:
    """Take steps until a condition is true; nobody clears or answers anything."""
    events: list[Event] = []
    for _ in range(most):
        if stops(game):
            return events
        events += game.step()
    raise AssertionError("It never came to that.")


def codes(events: list[Event]) -> list[str]:
    """Return the codes of the diagnosed faults, in order."""
    return [event.fault.code for event in events if isinstance(event, Diagnosed)]


def moves(events: list[Event], code: str = "") -> list[str]:
    """Return the moves about faults (of a code), in order."""
    return [e.move.kind for e in events if isinstance(e, Moved) and code in ("", e.fault.code)]


def acts(events: list[Event]) -> list[Acted]:
    """Return the behaviours that were executed."""
    return [event for event in events if isinstance(event, Acted)]


def ended(events: Sequence[object]) -> GameEnded:
    """Return how a game ended."""
    return next(event for event in events if isinstance(event, GameEnded))


class VainRequest(NamedTuple):
    """A request that was not followed: in which visit, to whom, and how."""

    visit: int
    person: str
    strategy: str


def vain_requests(events: list[Event]) -> list[VainRequest]:
    """Return the requests that were not followed, in order.

    A request aloud was followed if its fault has recovered right after it.
    """
    found: list[VainRequest] = []
    visit, aloud = 0, ""
    for event in events:
        if isinstance(event, Acted):
            visit += event.state.place != event.after.place
            response = event.outcome.response
            asks = event.action.behaviour.persuades and not event.action.behaviour.only_talks
            if asks and event.after.place != FRONT and not (response and response.followed):
                found.append(VainRequest(visit, event.after.place, str(event.action.strategy)))
        elif isinstance(event, Moved) and event.move.kind == "asked" and event.fault.person:
            found.append(VainRequest(visit, event.fault.person, "aloud"))
            aloud = event.fault.id
            continue
        elif (
            isinstance(event, Moved) and event.move.kind == "recovered" and event.fault.id == aloud
        ):
            found.pop()
        aloud = ""
    return found
