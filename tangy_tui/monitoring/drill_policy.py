"""The policy of a drill: the learnt one, or one from quick scripted demonstrations."""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.store import Store
from tangy_sim.worlds.guidance import GuidedWorld
from tangy_sim.worlds.users import load_users
from tangy_tui.learning.effects import Effects, learn_effects
from tangy_tui.learning.policies import last_policy, load_policy
from tangy_tui.learning.policy import ForestSettings, Policy, learn_policy
from tangy_tui.learning.scripted_teacher import MOST_STEPS, SCRIPTED
from tangy_tui.monitoring.accepted import expected_effects

FOREST = ForestSettings(trees=20)
MOST_GAMES = 4
"""The most guided games to demonstrate; usually one is enough."""

PEOPLE = tuple(f"person{number}" for number in range(1, 5))


DrillNote: TypeAlias = Literal["nothing learnt", "unusable", "changed", "gaps"]
"""Why a drill uses scripted demonstrations instead of the learnt policy."""


class DrillPolicy(NamedTuple):
    """A policy, its expected effects, and why it is not the learnt policy (None: it is)."""

    policy: Policy
    effects: Effects
    note: DrillNote | None = None


def policy_for_drill(store: Store, activity: Activity) -> DrillPolicy:
    """Return the latest policy if it is sure in every situation, else a quickly learnt one.

    Nothing is logged: the demonstrations of the drill are discarded.

    Raises:
        TangyError: neither exists, because the activity does not declare the expected behaviours.
    """
    why: DrillNote = "nothing learnt"
    if last_policy(store, activity.name) is not None:
        try:
            policy, notices = load_policy(store, activity)
        except TangyError:
            why = "unusable"
        else:
            sure = all(policy.decide(situation).sure for situation in activity.situations)
            if sure and not notices:
                return DrillPolicy(policy, expected_effects(store, activity, policy))
            why = "changed" if sure else "gaps"
    if not activity.expected:
        raise TangyError(f"Teach Tangy {activity.title} first, then rehearse.")
    policy, effects = _taught_quickly(activity)
    return DrillPolicy(policy, effects, why)


def _taught_quickly(activity: Activity) -> tuple[Policy, Effects]:
    shown: list[Demonstration] = []
    missing = set(activity.expected)
    while missing and len(shown) < MOST_GAMES:
        shown.append(_demonstrate(activity, len(shown) + 1))
        missing -= {step.state.situation for step in shown[-1].steps}
    return learn_policy(activity, shown, settings=FOREST), learn_effects(activity, shown)


def _demonstrate(activity: Activity, seed: int) -> Demonstration:
    """Demonstrate one guided game by the activity's expected behaviours."""
    world = GuidedWorld(activity, PEOPLE, seed=seed, users=load_users().teaching())
    state = world.begin()
    steps: list[Step] = []
    while not world.over and len(steps) < MOST_STEPS:
        expected = activity.expected.get(state.situation)
        if expected is None:
            raise TangyError(f"Nothing is expected for {' / '.join(state.situation)}.")
        behaviour = activity.behaviour(expected)
        target = state.attended if behaviour.attends else None
        outcome = world.execute(activity.action(behaviour, target, None))
        after = world.observe()
        steps.append(Step(behaviour.name, target, state, after, outcome.completed))
        state = after
    return Demonstration(f"drill-{seed}", activity.name, SCRIPTED, seed, PEOPLE, tuple(steps), True)
