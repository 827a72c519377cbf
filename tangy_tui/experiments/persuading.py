"""Scenario 2: does Tangy learn which strategy works with which person, and how soon?

Games are facilitated by a policy learnt as in Scenario 1, for four people who each prefer another
strategy. The results are how often the chosen strategy was the best one, by interaction, and how
many others were tried before convergence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from itertools import islice
from math import sqrt
from random import Random
from typing import Any

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_profiles.reading import plain
from tangy_sim.worlds.compliance import preferences_in_turn
from tangy_sim.worlds.users import load_users
from tangy_sim.worlds.world import SimulatedWorld
from tangy_tui.experiments.classroom import (
    GUIDED,
    Course,
    about,
    activity_of,
    covered,
    learnt,
    taught,
)
from tangy_tui.experiments.estimates import summary
from tangy_tui.experiments.sweep import Case, Settings, Sweep, Where
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.policy import Policy

CONVERGED = 10
"""Optimal strategies in a row that count as convergence; the paper does not state its own."""

SHOWN = 60
"""Interactions of each person in Fig. 5."""

LONGEST = 2_000
"""Games after which a person counts as not converged."""

GROUPS_A_PIECE = 5
MOST_GUIDED = 8


LONGEST_GAME = 2_000
"""Behaviours after which a game is considered endless."""


@cache
def policy_of(activity: str, users: int) -> Policy:
    """Learn the policy that facilitates, from guided demonstrations of Scenario 1.

    One demonstration is enough for an activity that can show everything in one game.

    Raises:
        TangyError: some situation never occurs, so that it cannot be demonstrated.
    """
    shown: list[Demonstration] = []
    for demonstration in islice(taught(Course(activity, users, GUIDED, 1)), MOST_GUIDED):
        shown.append(demonstration)
        if covered(activity_of(activity), shown):
            return learnt(activity_of(activity), shown)
    raise TangyError(f"{MOST_GUIDED} guided games do not show all that is expected.")


def check(name: str) -> None:
    """Check that the activity persuades people, before any work is done.

    Raises:
        TangyError: no expected behaviour persuades.
    """
    about(name)  # raises if nothing is expected
    activity = activity_of(name)
    expected = [activity.behaviours[name] for name in activity.expected.values()]
    if not any(behaviour.persuades and behaviour.attends for behaviour in expected):
        raise TangyError(
            plain(f"{activity.title}: nothing that is expected persuades anybody, ")
            + "so there is nothing to learn here."
        )


def play(settings: Settings, case: Case) -> list[dict[str, Any]]:
    """Play games with some groups until everybody has converged: a case is (first seed, groups).

    Returns:
        One document per group: `games`, the number of `interactions` of each person, and for each
            person `optimal`, their first interactions as a text of 1 (the best strategy) and 0, and
            `suboptimal`, the number of other choices before convergence (None: never converged).
    """
    first, groups = case
    return [group(settings, seed) for seed in range(first, first + groups)]


def group(settings: Settings, seed: int) -> dict[str, Any]:
    """Play the games of one group, and return its document (see `play`).

    Raises:
        TangyError: a game does not end.
    """
    activity = activity_of(settings["activity"])
    people = tuple(person.id for person in load_people(settings["users"]))
    preferences = preferences_in_turn(people, tuple(activity.strategies), load_users())
    best = {person: max(liked, key=liked.__getitem__) for person, liked in preferences.items()}
    policy = policy_of(settings["activity"], settings["users"])
    world = SimulatedWorld(activity, people, seed=seed, preferences=preferences)
    persuasion = Persuasion(people, tuple(activity.strategies), Random(f"{seed}/persuasion"))
    optimal: dict[str, list[bool]] = {person: [] for person in people}
    games = 0
    while games < LONGEST and not all(_enough(chosen) for chosen in optimal.values()):
        if games:
            world.begin()
        games += 1
        for _ in range(LONGEST_GAME):
            if world.over:
                break
            state = world.observe()
            behaviour = activity.behaviours[policy.decide(state.situation).behaviour]
            target = state.attended if behaviour.attends else None
            strategy = None
            if behaviour.persuades and target is not None:
                strategy = persuasion.choose(target).strategy
            response = world.execute(activity.action(behaviour, target, strategy)).response
            if response is not None:
                optimal[response.person].append(response.strategy == best[response.person])
                persuasion.update(response)
        if not world.over:
            raise TangyError(f"A game did not end within {LONGEST_GAME} behaviours.")
    return {
        "games": games,
        "interactions": [len(chosen) for chosen in optimal.values()],
        "optimal": ["".join(map(str, map(int, c[:SHOWN]))) for c in optimal.values()],
        "suboptimal": [suboptimal_before_convergence(c) for c in optimal.values()],
    }


def _enough(chosen: Sequence[bool]) -> bool:
    return len(chosen) >= SHOWN and suboptimal_before_convergence(chosen) is not None


def suboptimal_before_convergence(optimal: Sequence[bool], in_a_row: int = CONVERGED) -> int | None:
    """Count the sub-optimal choices before the first run of optimal ones; None without a run."""
    others = run = 0
    for best in optimal:
        run = run + 1 if best else 0
        others += not best
        if run == in_a_row:
            return others
    return None


def run(activity: str, users: int, groups: int, seed: int, where: Where) -> dict[str, Any]:
    """Play with many groups of people, and return the results of Scenario 2.

    Raises:
        TangyError: nobody is ever persuaded in this activity.
    """
    check(activity)
    settings = {**about(activity), "users": users}
    cases = [
        (seed * 1_000_000 + at, min(GROUPS_A_PIECE, groups - at))
        for at in range(0, groups, GROUPS_A_PIECE)
    ]
    pieces = Sweep("persuading", play, settings, cases).run(where)
    return _document(activity, users, [group for piece in pieces for group in piece])


def _shares(runs: Sequence[str]) -> list[float]:
    """Return the share of optimal strategies at each interaction, over the runs of that length."""
    columns = ([run[at] for run in runs if len(run) > at] for at in range(SHOWN))
    return [column.count("1") / len(column) for column in columns if column]


def _document(name: str, users: int, groups: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    activity = activity_of(name)
    people = load_people(users)
    model = load_users()
    ids = [person.id for person in people]
    preferences = preferences_in_turn(ids, tuple(activity.strategies), model)
    everybody = [count for group in groups for count in group["suboptimal"]]
    converged = [count for count in everybody if count is not None]
    games = sum(group["games"] for group in groups)
    for place, person in enumerate(people):
        if not any(group["optimal"][place] for group in groups):
            raise TangyError(
                plain(f"{person.name} was never persuaded in {games} games of {activity.title}, ")
                + "so nothing can be said."
            )
    rates = [sum(group["interactions"]) / group["games"] / users for group in groups]
    interactions = sum(sum(group["interactions"]) for group in groups)
    return {
        "users": [
            {
                "name": person.name,
                "best": max(preferences[person.id], key=preferences[person.id].__getitem__),
                "optimal_share": _shares([group["optimal"][place] for group in groups]),
                "one_run": [int(digit) for digit in groups[0]["optimal"][place]],
            }
            for place, person in enumerate(people)
        ],
        "suboptimal_before_convergence": {
            **summary(converged),
            "converged_means_in_a_row": CONVERGED,
            "never": len(everybody) - len(converged),
            "all": converged,
        },
        "four_users": summary(
            [sum(g["suboptimal"]) / users for g in groups if None not in g["suboptimal"]]
        ),
        "interactions_per_user_game": interactions / (games * users),
        # The sd of a mean over n games scales as 1 / sqrt(n): from one group to twenty games.
        "interactions_sd_of_twenty_games": summary(rates)["sd"] * sqrt(games / len(groups) / 20),
        "games": games,
        "groups": len(groups),
        "preferred": model.preferred,
        "other": model.other,
    }
