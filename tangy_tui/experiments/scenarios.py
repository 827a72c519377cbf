"""The documents of the three scenarios: results, the paper's results, and provenance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from tangy_sim.worlds import faulty_world
from tangy_tui.experiments import (
    algorithms,
    incremental,
    mistakes,
    other_choices,
    persuading,
    published,
    recovering,
    supervised,
    teachers,
    typing,
)
from tangy_tui.experiments.classroom import SEED_SPACE, activity_of
from tangy_tui.experiments.provenance import code_digest, versions
from tangy_tui.experiments.sweep import Piece, Where

A_GROUP_OF = 5
"""One in this many seeds has its own five teachers."""

A_SHARE_OF = 4
"""One in this many seeds is taught with every rate of mistakes in every place."""


@dataclass(frozen=True)
class Learning:
    """The parameters of Scenario 1: seeds, numbers of people in guided games, and whether to type.

    `typed_steps` ends the typed game after this many steps (None: a whole game).
    """

    activity: str
    seeds: int
    users: Sequence[int]
    seed: int
    typing: bool = True
    typed_steps: int | None = None

    @property
    def all_seeds(self) -> range:
        """All seeds."""
        return range(self.seed * SEED_SPACE, self.seed * SEED_SPACE + self.seeds)


@dataclass(frozen=True)
class PersuasionScenario:
    """The parameters of Scenario 2: people in a group, people in all, and the first seed."""

    activity: str
    users: int
    people: int
    seed: int


@dataclass(frozen=True)
class Recovering:
    """The parameters of Scenario 3: people, games, and the seed of games and faults.

    `load` is the number of processes that keep the machine busy beside games on the bench.
    """

    activity: str
    users: int
    games: int
    seed: int
    load: int = 0


def learning(asked: Learning, where: Where) -> dict[str, Any]:
    """Run Scenario 1 and return its document (shares from 0 to 1, times in minutes)."""
    seeds = asked.all_seeds
    typed = None
    if asked.typing:  # first, while the cores are idle
        typed = typing.run(asked.activity, [asked.seed], where, steps=asked.typed_steps)
    until = incremental.run(asked.activity, asked.users, seeds, where)
    taught = teachers.run(asked.activity, seeds[: -(-len(seeds) // A_GROUP_OF)], where)
    wrong = mistakes.run(asked.activity, seeds[: -(-len(seeds) // A_SHARE_OF)], where)
    return {
        "experiment": 1,
        "seeds": asked.seeds,
        "guided": until["guided"],
        "random": until["random"],
        "behaviours_per_demonstration": until["behaviours"]["mean"],
        "behaviours": until["behaviours"],
        "flagged_after_each": until["flagged_after_each"],
        "teachers": {**taught, "with_mistakes": wrong},
        "minutes_to_teach": typed and typed["minutes"],
        "typing": typed,
        "paper": dict(published.SCENARIO_ONE),
        "settings": {
            "activity": activity_of(asked.activity).title,
            "first seed": seeds[0],
            "seeds": asked.seeds,
            "people in games by chance": published.USERS,
            "people in guided games": ", ".join(map(str, asked.users)),
            "games by chance at most": incremental.MOST_GAMES,
        },
        **_provenance(),
    }


def persuasion(asked: PersuasionScenario, where: Where) -> dict[str, Any]:
    """Run Scenario 2 and return its document (shares from 0 to 1)."""
    strategies = len(activity_of(asked.activity).strategies)
    groups = -(-asked.people // asked.users)
    played = persuading.run(asked.activity, asked.users, groups, asked.seed, where)
    compared = algorithms.run(strategies, asked.people, asked.seed, where)
    people = min(asked.people, other_choices.ENOUGH)
    others = other_choices.run(asked.activity, people, asked.seed, where)
    return {
        "experiment": 2,
        **played,
        **compared,
        "other_choices": others,
        "paper": dict(published.SCENARIO_TWO),
        "settings": {
            "activity": activity_of(asked.activity).title,
            "seed": asked.seed,
            "people": groups * asked.users,
            "people in a group": asked.users,
            "P(complying) with the preferred strategy": played["preferred"],
            "P(complying) with another": played["other"],
            "convergence": f"{persuading.CONVERGED} optimal strategies in a row",
            "share kept by forgetting": algorithms.KEEP,
            "earlier people": f"{algorithms.EARLIER}, met {algorithms.MET} times each",
        },
        **_provenance(),
    }


def recovery(
    asked: Recovering,
    where: Where,
    *,
    bench: Piece | None = None,
    a_piece: int = recovering.GAMES_A_PIECE,
) -> dict[str, Any]:
    """Run Scenario 3 and return its document (times in the world's s).

    Args:
        asked: the parameters of the scenario.
        where: where the work is done and stored.
        bench: plays the games on the bench, with simulated devices under the real hardware layer;
            without it, everything is simulated.
        a_piece: games with the same people.
    """
    run = partial(recovering.run, asked.activity, asked.users, asked.games, asked.seed, where)
    name = f"bench-load-{asked.load}" if asked.load else "bench"
    played = run() if bench is None else run(name=name, piece=bench, a_piece=a_piece)
    return {
        "experiment": 3,
        "simulated": bench is None,
        **played,
        "paper": dict(published.SCENARIO_THREE),
        "settings": {
            "activity": activity_of(asked.activity).title,
            "seed": asked.seed,
            "games": asked.games,
            "people": asked.users,
            "demonstrations": f"{supervised.DEMONSTRATIONS}, guided",
            "games with the same people": a_piece,
            "busy processes beside them": asked.load,
            "P(people at the table help)": faulty_world.HELPS,
            "P(one turn finds the place)": faulty_world.FINDS_ITSELF,
            "P(a restart helps)": faulty_world.STARTS_AGAIN,
            "experts": "come in 5 minutes and mend what was diagnosed",
            "teachers": "scripted: say what the activity expects",
        },
        **_provenance(),
    }


def _provenance() -> dict[str, Any]:
    return {"versions": versions(), "code": code_digest()}
