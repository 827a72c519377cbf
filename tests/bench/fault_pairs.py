"""Pairs of all kinds of fault, twice each: missed, misnamed, repeated or false diagnoses.

Run by hand: `python -m tests.bench.fault_pairs [--seed N] [--bench PAIRS [--first N] [--last N]]`.
In the first game of a pair both come in one step, in the second one comes while Tangy recovers from
the other. All pairs are simulated (about a minute); --bench plays that number of pairs, drawn by
the seed, on the bench instead, each in one game, alternately in the first and in the second way, or
only the games from number --first to --last of them. Each bench game begins with the data folder
of a newly taught robot, so that it can be replayed alone; the folder of a game with a wrong
diagnosis is kept, and printed. A fault is missed if
it could show and was not named; it is repeated if a second diagnosis has its code but it came
once. A person who never complies is reported in each visit, which counts once; so does a request
that a person left unanswered and that Tangy finds again in a later visit. A person who refuses may
have a fault of the same kind as somebody else: they are counted apart. A diagnosis that neither of
the two faults explains is a false alarm.
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
from shutil import copytree, rmtree
from tempfile import TemporaryDirectory, gettempdir

from tangy_profiles.fault_file import load_faults
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS, read_injection
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.robot_opening import open_bench
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.policy import Policy
from tangy_tui.learning.scripted_teacher import SCRIPTED
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.scoring import score_game, share_interval
from tangy_tui.monitoring.supervision import Event, Supervision
from tests.bench.fault_latency import teach

ANEW = "never-complies"
STEPS = (3, 9)  # of the first fault, drawn at random


@dataclass
class PairGame:
    """A game with faults: what came, and the errors in its diagnoses."""

    at: tuple[str, ...]
    seed: int
    could_show: int = 0
    named: int = 0
    wrong: list[str] = field(default_factory=list)
    stopped: str | None = None
    events: list[Event] = field(default_factory=list, repr=False)
    places: list[tuple[float, str]] = field(default_factory=list, repr=False)
    """The robot's places, each with its time in the game (s)."""

    @property
    def fine(self) -> bool:
        """Whether its log has nothing worth reading."""
        return not self.wrong and self.stopped is None

    def __str__(self) -> str:
        told = f"seed {self.seed}: {self.named} of {self.could_show} named"
        return ", ".join((*self.at, told, *self.wrong, self.stopped or ""))


def ways(pair: tuple[str, str], step: int, number: int) -> tuple[str, str]:
    """Return the injections of a pair in its first (0) or second (1) game."""
    first, second = pair if number == 0 else pair[::-1]
    return f"{first}@{step}", f"{second}@{step}" if number == 0 else f"{second}@recovery"


def judged(game: Supervision, one: PairGame) -> PairGame:
    """Note which faults were missed, misnamed, repeated or false."""
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
    refuse = {fault.person for fault in game.faults if fault.code == ANEW}
    told = Counter(
        (fault.code, fault.person if fault.person in refuse else None)
        for number, fault in enumerate(game.faults)
        if not fault.asks_only and not any(left_at(one, fault) for one in game.faults[:number])
    )
    for (code, _), times in told.items():
        if code != ANEW and came_often[code] and times > came_often[code]:
            one.wrong.append(f"told {times} times: {code}")
    one.wrong += [f"false alarm {code}" for code in score.false_alarms]
    return one


def left_at(earlier: Fault, fault: Fault) -> bool:
    """Return whether Tangy gave up on a person's fault that a later visit finds again."""
    same = (earlier.code, earlier.person) == (fault.code, fault.person)
    return same and any(move.kind == "left" for move in earlier.moves)


def play(control: GameController, one: PairGame) -> PairGame:
    """Play a game to its end, with scripted people."""
    game = control.supervision
    one.events += control.begin()
    while not game.over:
        one.events += go_on_by_script(control, expert=True)
        one.places.append((game.seconds, game.world.scene().place))
    one.stopped = next(event.stopped for event in one.events if isinstance(event, GameEnded))
    return judged(game, one)


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
                yield play(scripted_controller(game), PairGame(at, seed))


def drawn(pairs: Sequence[tuple[str, str]], chance: Random) -> list[PairGame]:
    """Draw one game of each pair for the bench."""
    return [
        PairGame(ways(pair, chance.randint(*STEPS), number % 2), chance.randrange(1_000_000))
        for number, pair in enumerate(pairs)
    ]


def on_the_bench(one: PairGame, folder: Path) -> PairGame:
    """Play a game with simulated devices, as fast as possible, with a folder's data."""
    with closing(Workspace(folder)) as workspace:
        policy, _ = load_policy(workspace.store, workspace.activity)
        with open_bench(
            workspace,
            seed=one.seed,
            stepped=True,
            book=load_faults(workspace.robot),
            injections=[read_injection(text) for text in one.at],
            kind=BenchedWorld,
        ) as world:
            game = workspace.supervision(policy, 1, asks=True, world=world)
            return play(GameController(game, SCRIPTED, robot=world, paced=False), one)


def on_benches(taught: Path, games: Sequence[PairGame], keep: Path) -> Iterator[PairGame]:
    """Play games on the bench, each with a copy of a newly taught robot's data.

    A copy is kept if its log is worth reading.
    """
    for one in games:
        folder = keep / f"{'+'.join(one.at)}-{one.seed}"
        rmtree(folder, ignore_errors=True)
        copytree(taught, folder)
        yield on_the_bench(one, folder)
        if one.fine:
            rmtree(folder)
        else:
            print(f"  to read it: tangy log --data {folder}", flush=True)


def main() -> None:
    """Play, and print the errors and the totals."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bench", type=int, default=0)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--last", type=int)
    parser.add_argument("--keep", type=Path, default=Path(gettempdir(), "tangy-pairs"))
    given = parser.parse_args()
    chance = Random(f"{given.seed}/pairs")
    pairs = list(combinations(KINDS, 2))
    played: list[PairGame] = []
    with TemporaryDirectory() as folder, closing(Workspace(Path(folder))) as workspace:
        policy = teach(workspace)
        if given.bench:
            some = drawn(chance.sample(pairs, given.bench), chance)[given.first - 1 : given.last]
            workspace.close()
            games = on_benches(Path(folder), some, given.keep)
        else:
            games = simulated(workspace, policy, pairs, chance)
        for one in games:
            played.append(one)
            if given.bench or not one.fine:
                print(one, flush=True)
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
