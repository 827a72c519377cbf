"""A person who refuses every request: Tangy's reports of them, and the outcome of the game.

Run by hand: `python -m tests.bench.refusals [--games N] [--seed N] [--bench] [--unseen] [--keep
DIR]`. One person refuses from about the eighth step on, in the simulated room or with --bench on
the bench. With --unseen a card is out of the camera's view as well. The bench counts whether
Tangy names the refusal, how often it asks in vain, and how long the others wait: from the arrival
at that person until the robot leaves.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass
from itertools import groupby, pairwise
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory, gettempdir

from tangy_profiles.state import FRONT
from tangy_tui.app.scripted_staff import scripted_controller
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.fault import Diagnosed
from tangy_tui.monitoring.scoring import share_interval
from tests.bench.fault_latency import teach
from tests.bench.fault_pairs import ANEW, STEPS, PairGame, on_benches, play
from tests.support.games import vain_requests

UNSEEN = "card-out-of-sight"


@dataclass(frozen=True)
class Refusing:
    """The result of a game with a person who refuses; the longest visit to them in s."""

    person: str
    asked_in_visit: int
    asked_in_game: int
    visits: int
    in_a_row: int
    longest: float


def refusing(one: PairGame) -> Refusing | None:
    """Sum up a game; None if it ended before Tangy gave up on a person."""
    told = [event.fault for event in one.events if isinstance(event, Diagnosed)]
    person = next((fault.person for fault in told if fault.code == ANEW), None)
    if person is None:
        return None
    visits: list[tuple[str, float]] = []  # where the robot was, and until when
    for place, stay in groupby(one.places, key=lambda at: at[1]):
        visits.append((place, list(stay)[-1][0]))
    lasts = [
        (place, until - began) for (_, began), (place, until) in pairwise([(FRONT, 0.0), *visits])
    ]
    mine = [seconds for place, seconds in lasts if place == person]
    people = [place for place, _ in lasts]
    vain = vain_requests(one.events)
    asked = Counter(request.visit for request in vain)
    asked_each = Counter(request.person for request in vain)
    return Refusing(
        person,
        max(asked.values(), default=0),
        max(asked_each.values(), default=0),
        len(mine),
        max(len(list(stay)) for place, stay in groupby(people) if place == person),
        max(mine),
    )


def simulated(
    workspace: Workspace, policy: Policy, games: Sequence[PairGame]
) -> Iterator[PairGame]:
    """Play games in the simulated room."""
    for one in games:
        game = workspace.supervision(policy, one.seed, asks=True, injections=one.at)
        with workspace.store.transaction():
            yield play(scripted_controller(game), one)


def main() -> None:
    """Play, and print the result of each game on the bench, and the totals."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--games", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bench", action="store_true")
    parser.add_argument("--unseen", action="store_true")
    parser.add_argument("--keep", type=Path, default=Path(gettempdir(), "tangy-refusals"))
    given = parser.parse_args()
    chance = Random(f"{given.seed}/refusals")
    games = [
        PairGame(
            (f"{ANEW}@{chance.randint(*STEPS)}", *([UNSEEN] if given.unseen else [])),
            chance.randrange(1_000_000),
        )
        for _ in range(given.games)
    ]
    found: list[tuple[PairGame, Refusing | None]] = []
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        policy = teach(workspace)
        if given.bench:
            workspace.close()
        played = (
            on_benches(Path(folder), games, given.keep)
            if given.bench
            else simulated(workspace, policy, games)
        )
        for one in played:
            found.append((one, refusing(one)))
            if given.bench or not one.fine:
                print(one, found[-1][1], flush=True)
    could = sum(one.could_show for one, _ in found)
    named = sum(one.named for one, _ in found)
    low, high = share_interval(named / could, could)
    told = [mine for _, mine in found if mine is not None]
    print(
        f"{len(found)} games, {could} faults could show, {named} named ({low:.3f} to {high:.3f}); "
        f"refusals in {len(told)}; "
        f"at most {max(one.asked_in_visit for one in told)} requests in vain in a visit, "
        f"{max(one.asked_in_game for one in told)} in a game of anybody; at most "
        f"{max(one.in_a_row for one in told)} visit in a row, {max(o.longest for o in told):.0f} s "
        f"long; {sum(bool(one.wrong) for one, _ in found)} games with something wrong, "
        f"{sum(one.stopped is not None for one, _ in found)} not played to their end"
    )


if __name__ == "__main__":
    main()
