"""The joint state of a game of a declared activity, for the policy, the log and screens."""

from __future__ import annotations

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.model import Fact
from tangy_profiles.declared.situations import IS, NOTHING_SEEN, situation_of
from tangy_profiles.state import FACTS, ActivityState, UserState


def joint_state(game: DeclaredGame) -> ActivityState:
    """Return the joint state s_a: situation, place, person, players, facts, selectors."""
    declaration = game.declaration
    stage, about = game.stage()
    values = tuple(game.value(name, about) for name in stage.sees)
    told = [fact for fact in declaration.facts.values() if fact.values and not fact.built_in]
    own = [fact for fact in told if fact.per_player and fact.kind != "test"]
    users = tuple(
        UserState(one, _doing(game, own, one), "AR" if one in game.queue else "ANR")
        for one in game.players
    )
    named = ((one, game.whom(one)) for one in sorted(declaration.selectors))
    return ActivityState(
        game.step,
        situation_of(declaration, stage.name, values),
        game.place,
        about,
        users,
        game.closed,
        tuple((fact.name, game.value(fact.name, about)) for fact in told),
        tuple((selector, person) for selector, person in named if person is not None),
    )


def _doing(game: DeclaredGame, facts: list[Fact], player: str) -> str:
    """Return a player's facts that differ from their first values, with the names in the file."""
    values = [(fact, game.value(fact.name, player)) for fact in facts]
    return (
        FACTS.join(f"{fact.name}{IS}{value}" for fact, value in values if value != fact.values[0])
        or NOTHING_SEEN
    )
