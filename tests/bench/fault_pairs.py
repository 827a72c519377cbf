"""Pairs of all kinds of fault, twice each: which were missed, named wrong, told twice, or false.

Run by hand: `python -m tests.bench.fault_pairs [--seed N] [--bench PAIRS]`. In the first game of a
pair both come at one step, in the second one comes while Tangy recovers from the other. All pairs
are simulated (about a minute); with --bench so many pairs, drawn by the seed, are played on the
bench instead, each in one game, by turns in the first and in the second way. A fault is missed if
it could show and was not named; it is told twice if a second diagnosis has its code while it came
once. Who never complies is told of in each visit, which counts once; so does what Tangy asked a
person for in vain, and finds again in a later visit. What neither of the two calls for is a false
alarm.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from itertools import combinations
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tangy_profiles.fault_file import load_faults
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS, read_injection
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.scoring import score_game, share_interval
from tangy_tui.monitoring.supervision import Supervision
from tests.bench.fault_latency import teach

ANEW = "never-complies"
STEPS = (3, 9)  # of the first fault, by chance


@dataclass
class PairGame:
    """A game with a pair of faults: what came, and what was wrong about its diagnoses."""

    pair: tuple[str, str]
    at: tuple[str, str]
    seed: int
    could_show: int = 0
    named: int = 0
    wrong: list[str] = field(default_factory=list)
    stopped: str | None = None


def ways(pair: tuple[str, str], step: int, number: int) -> tuple[str, str]:
    """Return the injections of a pair in its first (0) or second (1) game."""
    first, second = pair if number == 0 else pair[::-1]
    return f"{first}@{step}", f"{second}@{step}" if number == 0 else f"{second}@recovery"


def judged(game: Supervision, one: PairGame) -> PairGame:
    """Note what was missed, called something else, told twice or false."""
    world = game.world
    assert isinstance(world, FaultyWorld | BenchedWorld)
    score = score_game(1, world.injection_log.all, game.faults, game.book)
    for came in score.injections:
        if came.could_show is None:
            continue
        one.could_show += 1
        one.named += came.named is not None
        if came.named is None:
            one.wrong.append(f"missed {came.kind} (called {came.called or 'nothing'})")
    came_often = Counter(came.kind.code for came in world.injection_log.all)
    told = Counter(
        fault.code
        for number, fault in enumerate(game.faults)
        if not fault.asks_only and not any(left_at(one, fault) for one in game.faults[:number])
    )
    for code, times in told.items():
        if code != ANEW and came_often[code] and times > came_often[code]:
            one.wrong.append(f"told {times} times: {code}")
    one.wrong += [f"false alarm {code}" for code in score.false_alarms]
    return one


def left_at(earlier: Fault, fault: Fault) -> bool:
    """Say whether a person was left in peace about a fault that a later visit finds again."""
    same = (earlier.code, earlier.person) == (fault.code, fault.person)
    return same and any(move.kind == "left" for move in earlier.moves)


def play(control: GameController, one: PairGame) -> PairGame:
    """Play a game to its end, with scripted people."""
    control.begin()
    while not control.supervision.over:
        events = go_on_by_script(control, expert=True)
        for event in events:
            if isinstance(event, GameEnded):
                one.stopped = event.stopped
    return judged(control.supervision, one)


def simulated(
    workspace: Workspace, policy: Policy, pairs: Sequence[tuple[str, str]], chance: Random
) -> Iterator[PairGame]:
    """Play both games of each pair in the simulated room."""
    for pair in pairs:
        for number in (0, 1):
            at = ways(pair, chance.randint(*STEPS), number)
            seed = chance.randrange(1_000_000)
            game = workspace.supervision(policy, seed, asks=True, injections=at)
            with workspace.store.transaction():
                yield play(scripted_controller(game), PairGame(pair, at, seed))


def on_the_bench(
    workspace: Workspace, policy: Policy, pairs: Sequence[tuple[str, str]], chance: Random
) -> Iterator[PairGame]:
    """Play one game of each pair with simulated devices, as fast as they can be computed."""
    book = load_faults(workspace.robot)
    for number, pair in enumerate(pairs):
        at = ways(pair, chance.randint(*STEPS), number % 2)
        seed = chance.randrange(1_000_000)
        with open_bench(
            workspace,
            seed=seed,
            stepped=True,
            book=book,
            injections=[read_injection(text) for text in at],
            kind=BenchedWorld,
        ) as world:
            game = workspace.supervision(policy, 1, asks=True, world=world)
            control = GameController(game, SCRIPTED, robot=world, paced=False)
            yield play(control, PairGame(pair, at, seed))


def main() -> None:
    """Play, and print what was wrong, and the sums."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bench", type=int, default=0)
    given = parser.parse_args()
    chance = Random(f"{given.seed}/pairs")
    pairs = list(combinations(KINDS, 2))
    played: list[PairGame] = []
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        policy = teach(workspace)
        if given.bench:
            games = on_the_bench(workspace, policy, chance.sample(pairs, given.bench), chance)
        else:
            games = simulated(workspace, policy, pairs, chance)
        for one in games:
            played.append(one)
            if given.bench or one.wrong or one.stopped is not None:
                told = f"seed {one.seed}: {one.named} of {one.could_show} named"
                print(*one.at, told, *one.wrong, one.stopped or "", sep=", ", flush=True)
    could, named = sum(one.could_show for one in played), sum(one.named for one in played)
    low, high = share_interval(named / could, could)
    kinds = Counter(words.split(" (")[0] for one in played for words in one.wrong)
    print(
        f"{len(played)} games, {could} faults could show, {named} named "
        f"({low:.3f} to {high:.3f}), {sum(one.could_show == 2 for one in played)} games with both; "
        f"{sum(bool(one.wrong) for one in played)} games with something wrong, "
        f"{sum(one.stopped is not None for one in played)} not played to their end"
    )
    for words, count in kinds.most_common():
        print(f"  {count} x {words}")


if __name__ == "__main__":
    main()
