"""Which commands staff are offered: not each of them makes sense in each game."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

from tangy_profiles.planned_game import as_planned
from tangy_tui.app.game_commands import (
    AskFor,
    CallAgain,
    ChangePace,
    ChoosePatterns,
    ClaimCard,
    Drive,
    GameCommand,
    HasCard,
    Joins,
    LetWin,
    PlanTime,
    SetPace,
    TakeBackCall,
    Tell,
    VoidResponse,
)
from tangy_tui.app.game_moment import turns_from_now
from tangy_tui.monitoring.attention import goes_to_people

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController

Need: TypeAlias = Literal[
    "calls", "claims", "patterns", "robot", "joining", "reports", "responses", "turns"
]
"""What a game must have for a command: numbers that are called, cards that are claimed to win,
patterns to choose from, a robot (or the bench), people who may join, things that people do and that
staff report, responses to what Tangy asks people to do, and visits or turns."""

EVERYTHING: frozenset[Need] = frozenset(get_args(Need))

NEEDS: Mapping[type[GameCommand], frozenset[Need]] = {
    CallAgain: frozenset({"calls", "robot"}),
    **dict.fromkeys((TakeBackCall, SetPace, ChangePace, LetWin), frozenset({"calls"})),
    ClaimCard: frozenset({"claims"}),
    HasCard: frozenset({"claims", "robot"}),
    ChoosePatterns: frozenset({"patterns"}),
    **dict.fromkeys((AskFor, Drive, PlanTime), frozenset({"robot"})),
    Joins: frozenset({"joining"}),
    Tell: frozenset({"reports"}),
    VoidResponse: frozenset({"responses"}),
}
"""The needs of commands that some games refuse whenever they are given."""


def needs_of(kind: type[GameCommand] | None) -> frozenset[Need]:
    """Return what a game must have for a kind of command (None: for a question, nothing)."""
    return frozenset() if kind is None else NEEDS.get(kind, frozenset())


def offered(control: GameController) -> Collection[Need]:
    """Return what the present game has."""
    world = control.supervision.world
    activity, robot = world.activity, control.robot
    rules, joins = activity.rules, control.admission is not None and not activity.teams
    has: dict[Need, bool] = {
        "calls": as_planned(world) is not None,
        "claims": bool(rules.claim),
        "patterns": bool(rules.patterns),
        "robot": robot.there,
        "joining": joins,
        "reports": robot.takes_reports,
        "responses": any(one.persuades for one in activity.behaviours.values()),
        "turns": goes_to_people(activity) or bool(turns_from_now(world)),
    }
    return frozenset(need for need, there in has.items() if there)
