"""Tries out an activity: one simulated game by the behaviours that its file expects."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.acts import Act
from tangy_profiles.declared.speech import media
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_profiles.state import EVERYBODY

MOST_STEPS = 500


@dataclass(frozen=True, slots=True)
class TriedStep:
    """One step of the game: situation, behaviour, target, speech, and people's actions."""

    number: int
    situation: str
    behaviour: str
    whom: str
    said: str
    doing: dict[str, str]
    """What people did, in words."""
    silent: tuple[str, ...] = ()
    """The people who said nothing, once for each time Tangy asked them again."""
    facts: tuple[Act, ...] = ()
    """What people did, as changes of facts."""
    media: tuple[str, ...] = ()
    """The names of the files that Tangy shows and plays."""


def tried_game(activity: Activity, users: int, seed: int) -> Iterator[TriedStep]:
    """Play one game by the activity's expected behaviours.

    Raises:
        TangyError: a situation has no expected behaviour, or the game does not end.
    """
    from tangy_sim.worlds.declared_world import DeclaredWorld

    if not isinstance(activity, DeclaredActivity):
        raise TangyError(f"{activity.title} has cards: see it with tangy demo.")
    people = {one.id: one.name for one in load_people(users)}
    names = dict.fromkeys(activity.teams, "") or people
    names = {id: name or id for id, name in names.items()}
    world = DeclaredWorld(activity, tuple(names), seed=seed)
    for number in range(1, MOST_STEPS + 1):
        state = world.observe()
        expected = activity.expected.get(state.situation)
        about = names.get(state.attended or "", "")
        situation = activity.told_of(state.situation, about)
        if expected is None:
            raise TangyError(f"{activity.source}: nothing is expected here: {situation}.")
        behaviour = activity.behaviours[expected]
        selector = activity.expected_selector(state.situation)
        whom = dict(state.whom).get(selector or "") or (
            None if selector else first_addressee(behaviour, state)
        )
        action = activity.action(behaviour, whom, None)
        outcome = world.execute(action)
        said, _ = activity.words_of(action, outcome, lambda id: names.get(id, id))
        did = {
            names.get(id, EVERYBODY): ", ".join(map(world.words_of, acts))
            for id, acts in world.happened.items()
        }
        changed = tuple(act for acts in world.happened.values() for act in acts)
        silent = tuple(names.get(one.person, "") for one in outcome.unclear if one.asked_again)
        person = names.get(whom or "", "")
        files = (Path(one.path).name for one in media(world.game, expected) if one is not None)
        yield TriedStep(
            number, situation, expected, person, said, did, silent, changed, tuple(files)
        )
        if world.over:
            return
    raise TangyError(f"{activity.title}: the game did not end within {MOST_STEPS} steps.")
