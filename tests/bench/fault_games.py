"""How well faults are detected: each kind with each behaviour, false alarms, and pairs of faults.

Each function plays games and counts; `faults.py` runs many, `tests/monitoring` a few.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from random import Random
from typing import Any

from tangy_profiles.behaviour import Action
from tangy_sim.worlds.compliance import Preferences
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import ASKING, KINDS, MOVING_ON, WAITING, FaultKind, Injection
from tangy_tui.experiments.classroom import GUIDED, RANDOM, Course, activity_of
from tangy_tui.experiments.induced import InducingWorld, recovery_of
from tangy_tui.experiments.matching import RIGHT, match_faults
from tangy_tui.experiments.supervised import Supervised, people_of, supervised
from tangy_tui.experiments.sweep import Case, Settings
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.monitoring.fault import OPEN, Fault, Moved
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text.comparison import TO_ITS_END
from tests.support.games import play

REQUESTS = 20
"""The most behaviours until a person who never follows must have been diagnosed."""

TURNS = ("asked", "remedied", "teacher asked", "halted")
"""The recovery moves that count as treating a fault."""


class AimingWorld(InducingWorld):
    """A world that injects given kinds together, once, with a given behaviour (None: any)."""

    kinds: Sequence[str] = ()
    behaviour: str | None = None
    after = 0
    """The steps before which nothing is injected."""
    executed = 0
    """How often the behaviour was about to be carried out."""

    def _induce(self, action: Action) -> None:
        if self.induced or self.behaviour not in (None, action.behaviour.name):
            return
        self.executed += 1
        ends = self.behaviour is None and action.behaviour.ends
        if self.tracker.step < self.after or ends:  # too late to recover
            return
        kinds = [KINDS[name] for name in self.kinds]
        if all(self.can_show(kind, action) for kind in kinds) and apart(kinds, action):
            for name in self.kinds:
                self.bring_about(name)


def apart(kinds: Sequence[FaultKind], action: Action) -> bool:
    """Return whether faults of several kinds stay distinguishable in the same action.

    A robot that cannot move never arrives, which hides other failures; and while the link is lost,
    momentary events cannot be observed.
    """
    held = any(kind.holds for kind in kinds) and action.behaviour.drives
    deaf = any(kind.holds and kind.blinds for kind in kinds)
    return not any(
        (held and kind.shows == MOVING_ON) or (deaf and kind.shows in (MOVING_ON, WAITING))
        for kind in kinds
    )


class HalfHeartedWorld(InducingWorld):
    """A world in which people follow requests only with a probability; there are no faults."""

    follows = 1.0

    def _refuses(self) -> bool:
        chance = self.__dict__.setdefault("_follow", Random("follow")).random
        if self.tracker.place in self.tracker.queue and chance() >= self.follows:
            self._refused = True
            return True
        return super()._refuses()


def complying(workspace: Supervised, share: float | None) -> Preferences | None:
    """Return people who comply with this probability (None: by their own preferences)."""
    if share is None:
        return None
    strategies = activity_of(workspace.activity).strategies
    return {person: dict.fromkeys(strategies, share) for person in people_of(workspace)}


# --------------------------------------------------------------------- kinds and behaviours


def matrix(settings: Settings, case: Case) -> list[dict[str, Any]]:
    """Inject a kind with each behaviour in turn: a case is (kind, first seed, seeds).

    Settings: `activity`, `users`, and `complies` (a probability, or None for the usual ones).

    Returns:
        A row for each behaviour: in how many games it was `executed`, the fault `came`,
            was `detected` in the same behaviour, with the right `class` and `cause`, and the number
            of `false` alarms.
    """
    name, seed, seeds = case
    activity = activity_of(settings["activity"])
    with supervised(Course(settings["activity"], settings["users"], GUIDED, 1)) as workspace:
        return [
            _cell(workspace, settings, name, behaviour, seed, seeds)
            for behaviour in activity.behaviours
        ]


def _cell(
    workspace: Supervised, settings: Settings, name: str, behaviour: str, seed: int, seeds: int
) -> dict[str, Any]:
    world, game = _aiming(workspace, settings, f"{name}/{behaviour}", seed)
    world.kinds, world.behaviour = (name,), behaviour
    right_class = recovery_of(KINDS[name], workspace.book)
    count = Counter[str]()
    for number in range(seeds):
        world.after, world.executed = 3 * (number % 5), 0
        play(game, stops=lambda game: _settled(game, world))
        count["executed"] += world.executed > 0
        if not world.induced:
            continue
        (one,) = world.induced
        matches = match_faults(world.induced, game.faults)
        told = [match.fault for match in matches.of(one)]
        if KINDS[name].shows != ASKING:
            told = [fault for fault in told if fault.step == one.step]
        if not one.could_show:
            continue
        count["came"] += 1
        count["detected"] += bool(told)
        count["class"] += any(fault.recovery == right_class for fault in told)
        count["cause"] += any(fault.code == one.kind.code for fault in told)
        count["false"] += matches.false_alarms
        for fault in told:
            if fault.code != one.kind.code:
                count[f"told: {fault.code}"] += 1
    return {"kind": name, "behaviour": behaviour, **count}


def _aiming(
    workspace: Supervised, settings: Settings, salt: str, seed: int
) -> tuple[AimingWorld, Supervision]:
    number = Random(f"{salt}/{seed}").randrange(1_000_000_000)
    world = AimingWorld(
        activity_of(workspace.activity),
        people_of(workspace),
        seed=number,
        preferences=complying(workspace, settings.get("complies")),
    )
    return world, workspace.games(world, number)


def _settled(game: Supervision, world: AimingWorld) -> bool:
    """Return whether the outcome of the injected fault is known."""
    if not world.induced:
        return False
    first = world.induced[0]
    if game.question is not None or game.halted is not None:
        return True
    wait = REQUESTS if first.kind.shows == ASKING else 1
    told = any(fault.code == first.kind.code for fault in game.faults)
    waits = first.kind.name in world.present and not first.could_show
    return not waits and (told or game.steps >= first.step + wait)


# --------------------------------------------------------------------------- false alarms


def alarms(settings: Settings, case: Case) -> dict[str, Any]:
    """Play games without faults: a case is (seed of the demonstrations, first seed, games).

    Settings as for `matrix`, and `follows`: the probability that a request is followed.

    `games`, `steps`, the count of each diagnosed code, and how often Tangy only asked.
        `games`, `steps`, how often each code was diagnosed, and how often Tangy only asked.
    """
    lesson, seed, games = case
    count: Counter[str] = Counter()
    steps = asked = 0
    with supervised(Course(settings["activity"], settings["users"], RANDOM, lesson)) as workspace:
        world = HalfHeartedWorld(
            activity_of(workspace.activity),
            people_of(workspace),
            seed=seed,
            preferences=complying(workspace, settings.get("complies")),
        )
        world.follows = settings.get("follows", 1.0)
        game = workspace.games(world, seed)
        for _ in range(games):
            play(game)
            steps += game.steps
            asked += sum(fault.asks_only for fault in game.faults)
            count.update(fault.code for fault in game.faults if not fault.asks_only)
    return {"games": games, "steps": steps, "asked": asked, "codes": dict(count)}


# --------------------------------------------------------------------------- several at once


def pairs(settings: Settings, case: Case) -> dict[str, Any]:
    """Inject a critical kind and another one at once: a case is (critical, other, seed, seeds).

    Returns:
        In how many games both `came`, both were `diagnosed`, the critical one was
        treated `first`, and both were `ended` (over, or tolerated as planned).
    """
    critical, other, seed, seeds = case
    count = Counter[str]()
    with supervised(Course(settings["activity"], settings["users"], GUIDED, 1)) as workspace:
        world, game = _aiming(workspace, settings, f"{critical}/{other}", seed)
        world.kinds = (critical, other)
        for number in range(seeds):
            world.after = 4 * (number % 5)
            events = play(game)
            if len(world.induced) < 2 or not all(one.could_show for one in world.induced):
                continue
            count["came"] += 1
            told = {
                match.induced.kind.name: match.fault
                for match in reversed(match_faults(world.induced, game.faults).matches)
                if match.verdict == RIGHT and match.induced is not None
            }
            if len(told) < 2:
                continue
            count["diagnosed"] += 1
            turns = _turns(events)
            first, second = told[critical], told[other]
            count["first"] += first.id in turns and second.id not in turns[: turns.index(first.id)]
            count["ended"] += first.status != OPEN and second.status != OPEN
    return {"critical": critical, "other": other, **count}


def _turns(events: Sequence[Event]) -> list[str]:
    """Return the ids of the faults in the order of their treatment."""
    return [e.fault.id for e in events if isinstance(e, Moved) and e.move.kind in TURNS]


def crowd(settings: Settings, case: Case) -> list[dict[str, Any]]:
    """Play games in which any kind may occur at any step: a case is (seed, games, chance)."""
    seed, games, chance = case
    played: list[dict[str, Any]] = []
    with supervised(Course(settings["activity"], settings["users"], GUIDED, 1)) as workspace:
        world = FaultyWorld(
            activity_of(workspace.activity),
            people_of(workspace),
            seed=seed,
            injections=[Injection(kind, chance=chance) for kind in KINDS.values()],
        )
        game = workspace.games(world, seed)
        for _ in range(games):
            events = play(game)
            stopped = next(event.stopped for event in events if isinstance(event, GameEnded))
            faults: list[Fault] = [fault for fault in game.faults if not fault.asks_only]
            played.append(
                {
                    "came": len(world.came),
                    "faults": len(faults),
                    "critical": sum(fault.critical for fault in faults),
                    "open": sum(fault.status == OPEN for fault in faults),
                    "steps": game.steps,
                    "ended": TO_ITS_END if stopped is None else stopped,
                }
            )
    return played


def added(rows: Sequence[Mapping[str, Any]], name: str) -> int:
    """Sum one of the counts over rows."""
    return sum(row.get(name, 0) for row in rows)
