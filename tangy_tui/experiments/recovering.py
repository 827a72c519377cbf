"""Scenario 3: does Tangy detect faults in games, and choose the right recovery?

Four people play games with a learnt policy, with faults induced in the proportions of Table II.
Diagnoses and recoveries are what Tangy did; the induced faults are only the ground truth.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any

from tangy_profiles.fault_file import load_faults
from tangy_profiles.robot import load_robot
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.experiments import published
from tangy_tui.experiments.classroom import GUIDED, Course, about, activity_of
from tangy_tui.experiments.estimates import spread
from tangy_tui.experiments.induced import (
    Induced,
    Inducer,
    InducingWorld,
    Planned,
    draw_plan,
    in_proportion,
    recovery_of,
)
from tangy_tui.experiments.matching import (
    AGAIN,
    RIGHT,
    DiagnosisMatch,
    MatchCounts,
    match_faults,
    seconds_to_recover,
)
from tangy_tui.experiments.supervised import people_of, supervised
from tangy_tui.experiments.sweep import Case, Piece, Settings, Sweep, Where
from tangy_tui.interaction.game_events import GameEnded
from tangy_tui.interaction.tally import Tally
from tangy_tui.monitoring.scoring import share_document
from tangy_tui.monitoring.supervision import Event, Supervision
from tangy_tui.text import comparison

GAMES_A_PIECE = 20
"""Games with the same people; the next ones are unknown to Tangy."""


def plan_of(games: int, seed: int, piece: int = GAMES_A_PIECE) -> list[list[Planned]]:
    """Return the faults to induce in each game, in the paper's proportions.

    Args:
        games: the number of games.
        seed: seed of the random generators.
        piece: games with the same people, which get their share of the faults.
    """
    book = load_faults(load_robot())
    mix = {row["recovery"]: row["instances"] for row in published.SCENARIO_THREE["faults"]}
    plan: list[list[Planned]] = []
    counts = in_proportion(mix, published.SCENARIO_THREE["games"], games)
    for first in range(0, games, piece):  # each piece gets its share
        some = min(piece, games - first)
        share = {
            name: round(count * (first + some) / games) - round(count * first / games)
            for name, count in counts.items()
        }
        plan += draw_plan(share, some, seed * 1_000 + first // piece, book)
    return plan


def play(settings: Settings, case: Case) -> dict[str, Any]:
    """Play games with one group of people: a case is (seed, first game, games, games in all).

    Returns:
        `games`, each with its faults, and `rows` as in `tangy play --json`.
    """
    seed, first, some, games = case
    plan = plan_of(games, seed)[first : first + some]
    course = Course(settings["activity"], settings["users"], GUIDED, 1)
    activity = activity_of(settings["activity"])
    number = seed * 1_000_000 + first
    with supervised(course) as workspace:
        world = InducingWorld(
            activity, people_of(workspace), seed=number, plan=plan, robot=workspace.robot
        )
        return play_games(workspace.games(world, number), world.inducer, first, some)


def play_games(game: Supervision, inducer: Inducer, first: int, some: int) -> dict[str, Any]:
    """Play `some` games, from number `first` (from 0), and return them as `play` does."""
    tally = Tally()
    played = [_game(game, inducer, tally, first + at + 1) for at in range(some)]
    document = tally.to_json(game.world.activity.situations, game.persuasion.beliefs)
    return {
        "games": played,
        "rows": document["rows"],
        "interactions": tally.interactions,
        "not_come": [planned.kind.name for planned in inducer.due],
    }


def _game(game: Supervision, inducer: Inducer, tally: Tally, number: int) -> dict[str, Any]:
    control = scripted_controller(game)
    events: list[Event] = control.begin()
    while not game.over:
        inducer.held = game.question is not None
        events += go_on_by_script(control, expert=True)
    tally.add(events)
    stopped = next(event.stopped for event in events if isinstance(event, GameEnded))
    matches = match_faults(inducer.induced, game.faults)
    return {
        "number": number,
        "steps": game.steps,
        "minutes": game.seconds / 60,
        "ended": comparison.TO_ITS_END if stopped is None else stopped,
        "induced": [_induced(one, game, matches) for one in inducer.induced],
        "faults": [_diagnosed(match, game) for match in matches.matches],
        "asked": matches.asked,
    }


def _induced(one: Induced, game: Supervision, matches: MatchCounts) -> dict[str, Any]:
    told = matches.of(one)
    recovery = recovery_of(one.kind, game.book)
    return {
        "kind": one.kind.name,
        "recovery": recovery,
        "step": one.step,
        "could_show": one.could_show,
        "missed": one in matches.missed,
        "at_once": any(match.fault.step == one.step for match in told),
        "right_class": any(match.fault.recovery == recovery for match in told),
        "right_cause": any(match.verdict == RIGHT for match in told),
    }


def _diagnosed(match: DiagnosisMatch, game: Supervision) -> dict[str, Any]:
    fault, induced = match.fault, match.induced
    right = recovery_of(induced.kind, game.book) if induced is not None else None
    recovered = fault.succeeded and len(fault.ladder) == 1
    return {
        "code": fault.code,
        "step": fault.step,
        "minute": fault.seconds / 60,
        "criticality": "critical" if fault.critical else "non-critical",
        "recovery": fault.recovery,
        "verdict": match.verdict,
        "of": induced.kind.name if induced is not None else None,
        "called_for": right,
        "status": fault.status,
        "success": fault.recovery == right and match.verdict in (RIGHT, AGAIN) and recovered,
        "ladder": list(fault.ladder),
        "seconds": seconds_to_recover(fault),
    }


def run(
    activity: str,
    users: int,
    games: int,
    seed: int,
    where: Where,
    *,
    name: str = "recovering",
    piece: Piece = play,
    a_piece: int = GAMES_A_PIECE,
) -> dict[str, Any]:
    """Play games with induced faults, and return the results of Scenario 3.

    Args:
        activity: the activity.
        users: the number of people.
        games: the number of games.
        seed: seed of the random generators.
        where: where the work is done and stored.
        name: the name of the sweep, under which its pieces are stored.
        piece: plays one piece of the games.
        a_piece: games in one piece.

    Raises:
        TangyError: the activity does not declare the expected behaviours.
    """
    cases = [
        (seed, first, min(a_piece, games - first), games) for first in range(0, games, a_piece)
    ]
    settings = {**about(activity), "users": users}
    return _document(Sweep(name, piece, settings, cases).run(where), users)


def _document(pieces: Sequence[Mapping[str, Any]], users: int) -> dict[str, Any]:
    games = list(chain.from_iterable(piece["games"] for piece in pieces))
    induced = [one for game in games for one in game["induced"]]
    faults = [fault for game in games for fault in game["faults"]]
    steps = [game["steps"] for game in games]
    return {
        "games": len(games),
        "rows": _rows(pieces),
        "behaviours_per_game": sum(steps) / len(games),
        "interactions_per_user_game": sum(p["interactions"] for p in pieces) / len(games) / users,
        "faults": [_class_row(row, induced, faults) for row in published.SCENARIO_THREE["faults"]],
        "induced": sum(one["could_show"] for one in induced),
        "recall": share_document([one["right_cause"] for one in induced if one["could_show"]]),
        "precision": share_document([fault["verdict"] in (RIGHT, AGAIN) for fault in faults]),
        "did_not_come_about": [
            *chain.from_iterable(piece["not_come"] for piece in pieces),
            *(one["kind"] for one in induced if not one["could_show"]),
        ],
        "missed": sum(one["missed"] for one in induced),
        "false_alarms": sum(fault["of"] is None for fault in faults),
        "asked": sum(game["asked"] for game in games),
        "kinds": _kinds([one for one in induced if one["could_show"]]),
        "finished": sum(game["ended"] == comparison.TO_ITS_END for game in games),
        "stopped": [game["ended"] for game in games if game["ended"] != comparison.TO_ITS_END],
        "ended": dict(Counter(game["ended"] for game in games).most_common()),
        "logs": list(dict.fromkeys(game["log"] for game in games if "log" in game)),
        "each_game": games,
    }


def _class_row(
    row: Mapping[str, Any],
    induced: Iterable[Mapping[str, Any]],
    faults: Iterable[Mapping[str, Any]],
) -> dict[str, Any]:
    """Return the row of a class of recovery: induced, diagnosed, and recovered faults."""
    recovery = row["recovery"]
    some = [one for one in induced if one["recovery"] == recovery and one["could_show"]]
    mine = [fault for fault in faults if fault["called_for"] == recovery]
    seconds = sorted(f["seconds"] for f in mine if f["success"] and f["seconds"] is not None)
    return {
        "criticality": row["criticality"],
        "recovery": recovery,
        "induced": len(some),
        "instances": len(mine),
        "success": sum(fault["success"] for fault in mine) / len(mine) if mine else None,
        "again": sum(fault["verdict"] == AGAIN for fault in mine),
        "missed": sum(one["missed"] for one in some),
        "escalated": sum(len(fault["ladder"]) > 1 for fault in mine),
        "seconds_to_recover": spread(seconds),
    }


def _kinds(induced: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return, for each kind that occurred, how often it was diagnosed."""
    found = []
    for name, kind in KINDS.items():
        some = [one for one in induced if one["kind"] == name]
        if some:
            found.append(
                {
                    "kind": name,
                    "words": kind.words,
                    "recovery": some[0]["recovery"],
                    "induced": len(some),
                    "at_once": sum(one["at_once"] for one in some),
                    "right_class": sum(one["right_class"] for one in some),
                    "right_cause": sum(one["right_cause"] for one in some),
                }
            )
    return found


def _rows(pieces: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Sum the rows of all pieces, in order of first occurrence."""
    names = ("stage", "request", "user_state", "behaviour")
    total: Counter[tuple[str, ...]] = Counter()
    right: Counter[tuple[str, ...]] = Counter()
    for row in chain.from_iterable(piece["rows"] for piece in pieces):
        key = tuple(row[name] for name in names)
        total[key] += row["instances"]
        right[key] += round(row["instances"] * row["success"])
    return [
        {**dict(zip(names, key, strict=True)), "instances": n, "success": right[key] / n}
        for key, n in total.items()
    ]
