"""Calls per minute and the longest wait for help, by pace and number of people.

Run by hand: `python -m tests.bench.calls_and_visits [GAMES]`. Simulated games of at most 40 minutes
for the full card follow the activity's own table, with visits to people who do not ask.
"""

from __future__ import annotations

import sys
from dataclasses import replace

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_sim.worlds.world import SimulatedWorld

LONGEST = 2400.0  # s, of a game
PLAN = GamePlan(("full card",), visits=True)


def played(activity: Activity, people: int, pace: float, seed: int) -> tuple[int, float, float]:
    """Play a game; return the number of calls, its duration and the longest wait, in s."""
    world = SimulatedWorld(activity, [f"u{number}" for number in range(people)], seed=seed)
    world.choose(replace(PLAN, pace=pace))
    world.begin()
    since, longest = dict[str, float](), 0.0
    while not world.over and world.seconds < LONGEST:
        if due := world.due:
            world.change(
                GameChange(game="", steps=0, what=due.what, person=due.person, number=due.number)
            )
            continue
        state = world.observe()
        behaviour = activity.behaviours[activity.expected[state.situation]]
        target = state.attended if behaviour.attends else None
        world.execute(activity.action(behaviour, target, None))
        tracker, now = world.tracker, world.seconds
        waiting = [person for person in tracker.queue if person != tracker.place]
        longest = max([longest, *(now - begun for begun in since.values())])
        since = {person: since.get(person, now) for person in waiting}
    return len(world.called_now), world.seconds, longest


def main(games: int = 10) -> None:
    """Print the table with and without the rule that calls come first."""
    with_rule = load_activity("bingo")
    without = replace(with_rule, rules=replace(with_rule.rules, calls_first=None))
    print(f"{games} games each; calls a minute, longest wait in s; without the rule in brackets")
    for people in (4, 8, 12, 24):
        for pace in (5.0, 10.0, 20.0, 31.0):
            cells = []
            for activity in (with_rule, without):
                found = [played(activity, people, pace, seed) for seed in range(games)]
                calls = 60 * sum(one[0] for one in found) / sum(one[1] for one in found)
                cells.append((calls, max(one[2] for one in found)))
            (calls, wait), (before, waited) = cells
            print(
                f"{people:3} people, {pace:2g} s: {calls:.2f} ({before:.2f}) calls a minute, "
                f"{wait:.0f} ({waited:.0f}) s"
            )


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
