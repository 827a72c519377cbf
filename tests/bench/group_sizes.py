"""Guided teaching and games of declared activities for groups of each size.

`python -m tests.bench.group_sizes [--games 100] [--seeds 3] [--most 12] [FILE ...]`

For each activity and number of people: how many guided games of the scripted teacher it takes
until a search of all games finds nothing left to show, then how many of the games end, and how
often Tangy would have asked in them. Each is counted over the seeds; the worst one is printed.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from tangy_profiles.activity import load_activity, read_activity, shipped_activities
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.demonstrated_moves import UNDECIDED, DemonstratedMoves
from tangy_profiles.declared.search import explore_demonstrated
from tangy_profiles.declared.whom import first_addressee
from tangy_profiles.state import ActivityState
from tangy_sim.worlds.declared_guidance import GuidedDeclaredWorld
from tangy_sim.worlds.declared_world import DeclaredWorld

MOST_STEPS, MOST_TAUGHT = 2_000, 4


class Row(NamedTuple):
    """The result of a group: guided games until all was shown, open ones, games, questions."""

    taught: int
    left: int
    whole: bool
    finished: int
    asked: int


def whom(activity: DeclaredActivity, state: ActivityState, name: str) -> str | None:
    """Return the addressee that the file expects for a behaviour (None: the group)."""
    selector = activity.expected_selector(state.situation)
    if selector is None:
        return first_addressee(activity.behaviours[name], state)
    return None if selector == "group" else dict(state.whom).get(selector)


def teach(
    activity: DeclaredActivity, people: Sequence[str], seed: int
) -> tuple[DemonstratedMoves, Row]:
    """Show guided games, four at most, until a search finds nothing that was not shown."""
    taught, games = DemonstratedMoves(activity.behaviours), 0
    while True:
        games += 1
        world = GuidedDeclaredWorld(activity, people, seed=seed + games, shown=taught)
        for _ in range(MOST_STEPS):
            if world.over:
                break
            state = world.observe()
            name = activity.expected[state.situation]
            world.execute(
                activity.action(activity.behaviours[name], whom(activity, state, name), None)
            )
        taught = world.taught
        found = explore_demonstrated(activity.declaration, people[:2], taught)
        if not found.open or games == MOST_TAUGHT:
            return taught, Row(games, len(found.open), found.whole, 0, 0)


def play(
    activity: DeclaredActivity,
    people: Sequence[str],
    taught: DemonstratedMoves,
    games: int,
    seed: int,
) -> tuple[int, int]:
    """Play games by the demonstrations; return how many end, and how many questions there were.

    The teacher answers a question, and the answer is learnt.
    """
    finished = asked = 0
    world = DeclaredWorld(activity, people, seed=seed)
    for number in range(games):
        if number:
            world.begin()
        for _ in range(MOST_STEPS):
            if world.over:
                break
            state, move = world.observe(), taught.move(world.game)
            if move is None or move[0] == UNDECIDED:
                asked += 1
                name = activity.expected[state.situation]
                move = name, whom(activity, state, name)
                taught.show(state, *move)
            world.execute(activity.action(activity.behaviours[move[0]], move[1] or None, None))
        finished += world.over
    return finished, asked


def rows(activity: DeclaredActivity, sizes: Sequence[int], games: int, seeds: int) -> Iterator[str]:
    """Yield a row for each size of the group, as it is measured."""
    for size in sizes:
        people = activity.teams or tuple(f"user{number}" for number in range(1, size + 1))
        found: list[Row] = []
        for seed in range(1, seeds + 1):
            taught, row = teach(activity, people, 100 * seed)
            # the games follow what was shown in a demonstration of two games
            ended, asked = play(activity, people, taught, games, 1000 + seed)
            found.append(row._replace(finished=ended, asked=asked))
        worst = Row(
            max(one.taught for one in found),
            max(one.left for one in found),
            all(one.whole for one in found),
            min(one.finished for one in found),
            max(one.asked for one in found),
        )
        searched = "" if worst.whole else " (search not whole)"
        yield (
            f"| {activity.name} | {size} | {worst.taught} | {worst.left}{searched} "
            f"| {worst.finished} of {games} | {worst.asked} |"
        )
        if activity.teams:
            return


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--games", type=int, default=100)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--sizes", type=int, nargs="*", default=list(range(1, 13)))
    chosen = parser.parse_args()
    activities = (
        [read_activity(path) for path in chosen.files]
        if chosen.files
        else [load_activity(name) for name in shipped_activities()]
    )
    print("| activity | people | guided games | left to show | games that end | questions |")
    print("|---|---|---|---|---|---|")
    for activity in activities:
        if isinstance(activity, DeclaredActivity):
            for line in rows(activity, chosen.sizes, chosen.games, chosen.seeds):
                print(line, flush=True)


if __name__ == "__main__":
    main()
