"""What Tangy does now, who waits, and when it goes to a person: values for staff who ask why."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, assert_never

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.joint_state import joint_state
from tangy_profiles.planned_game import as_planned
from tangy_profiles.present_moment import as_present
from tangy_tui.app.game_commands import asked_for

if TYPE_CHECKING:
    from tangy_hw.robot_client.help_requests import SignState
    from tangy_profiles.planned_game import PlannedGame
    from tangy_profiles.state import ActivityState
    from tangy_tui.app.claim_controls import ClaimNow
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.robot_controls import PersonWait
    from tangy_tui.app.staff_view import PersonNow
    from tangy_tui.learning.policy import Decision

Holder = Literal[
    "",
    "idle",
    "over",
    "joining",
    "stopped",
    "halted",
    "driving",
    "taking over",
    "question",
    "proposal",
    "confirming",
    "paused",
]
"""What holds the game, so that Tangy does nothing by itself; "" if nothing does."""

VisitReason = Literal["", "unvisited", "all called"]
"""Why Tangy visits people who have not asked."""


@dataclass(frozen=True, slots=True)
class GameMoment:
    """The present moment of a game."""

    holder: Holder = ""
    about: str = ""
    """Who stopped the robot, the name of a fault, the reason for a question, or a behaviour."""
    welcomes: tuple[str, ...] = ()
    """The names of new people, for whom Tangy is being set up."""
    claim: ClaimNow | None = None
    """The last claim, while it is news."""
    calling: str = ""
    """The label of the number that is being called."""
    stepping: bool = False
    """Whether a step is being carried out, also while the game is paused."""
    people: tuple[PersonNow, ...] = ()
    with_robot: PersonNow | None = None
    """The person the robot is with, or on its way to."""
    waiting: tuple[PersonNow, ...] = ()
    """The others who ask, in the order in which Tangy goes to them."""
    calls_first: int = 0
    """How many numbers come before the next visit."""
    calls_between: bool = False
    """Whether numbers may come between two visits."""
    by_staff: frozenset[str] = frozenset()
    """The people who wait without a sign, as staff asked for them or a game was resumed."""
    visits: VisitReason = ""
    visiting: tuple[str, ...] = ()
    """The people who get a visit without a request."""
    unvisited: int = 0
    """After how many numbers a person who does not ask gets a visit; 0: never."""
    looking: str = ""
    """The person whose card is being read."""
    waits_for: PersonWait | None = None
    """For whom Tangy waits, as they are to respond or have time to act."""
    rests: bool = False
    """Whether Tangy waits for the time of the next call."""
    won: bool = False
    """Whether somebody has won, and the game only has to end or go on for another pattern."""
    plays_on: str = ""
    """The label of the pattern for which the game goes on after a win; "": none is left."""
    turns: tuple[str, ...] = ()
    """The people in the order of their turns, whose turn it is first; () if nobody takes turns."""
    decision: Decision | None = None
    """Tangy's next decision, and the state in which it is made; None if unknown."""
    state: ActivityState | None = None


@dataclass(frozen=True, slots=True)
class PersonTurn:
    """When Tangy goes to a person, in the present moment of a game."""

    person: PersonNow
    moment: GameMoment
    sign: SignState = ""
    unvisited: int = 0
    """How many numbers were called since the last visit."""
    can_ask: bool = False
    """Whether staff can ask for help on behalf of people."""

    @property
    def before(self) -> tuple[PersonNow, ...]:
        """Who comes before the person, apart from the one with the robot."""
        before = []
        for one in self.moment.waiting:
            if one.id == self.person.id:
                break
            before.append(one)
        return tuple(before)


def game_moment(control: GameController) -> GameMoment:
    """Return the present moment of a controller's game; from any thread, at any time."""
    world, people = control.supervision.world, control.view().people
    holder, about = _holder(control)
    near = next((one for one in people if one.state == "visited"), None)
    near = next((one for one in people if one.state == "comes"), near)
    asking = sorted((one for one in people if one.turn), key=lambda one: one.turn)
    state = None if control.supervision.over else _state(world)
    decision = None if state is None else control.supervision.policy.decide(state.situation)
    moment = GameMoment(
        holder,
        about,
        control.welcomes,
        control.plan.claim,
        control.plan.calling,
        control.stepping,
        people,
        near,
        tuple(one for one in asking if one != near),
        by_staff=control.robot.by_staff,
        waits_for=control.robot.waits_for,
        rests=decision is not None and control.robot.rests(decision),
        turns=turns_from_now(world),
        decision=decision,
        state=state,
    )
    planned = as_planned(world)
    return moment if planned is None or state is None else _with_plan(moment, planned)


def turn_of(control: GameController, person: str) -> PersonTurn | None:
    """Return when Tangy goes to a person, by id; None: the person does not take part."""
    moment = game_moment(control)
    found = next((one for one in moment.people if one.id == person), None)
    if found is None:
        return None
    planned = as_planned(control.supervision.world)
    return PersonTurn(
        found,
        moment,
        control.robot.sign_of(person),
        0 if planned is None else planned.calls_unvisited(person),
        control.robot.there,
    )


def _with_plan(moment: GameMoment, game: PlannedGame) -> GameMoment:
    """Add what decides who comes first in a game with calls."""
    rule, here = game.activity.rules.calls_first, len(game.people) - len(game.away)
    return replace(
        moment,
        calls_first=game.tracker.calls_first,
        calls_between=rule is not None and here > rule.small_group,
        visiting=game.visiting,
        visits="" if not game.visiting else "all called" if game.all_called else "unvisited",
        unvisited=game.activity.rules.unvisited if game.game_plan.visits else 0,
        looking=game.looking,
        won=game.tracker.finished,
        plays_on=plays_on(game),
    )


def plays_on(game: PlannedGame) -> str:
    """Return the label of the pattern for which the game goes on after a win; "" if for none."""
    left = game.patterns.left if game.tracker.finished else ()
    return left[0].label if left else ""


def _holder(control: GameController) -> tuple[Holder, str]:
    """Return what holds the game, and what it is about."""
    game = control.supervision
    match control.phase:
        case "idle":
            return "over" if game.games else "idle", ""
        case "joining":
            return "joining", ""
        case "stopped":
            return "stopped", control.stopped_by
        case "halted":
            return "halted", "" if game.halted is None else game.halted.name
        case "staff":
            return "driving" if control.robot.driving else "taking over", ""
        case "asking":
            if (question := game.question) is not None:
                taken = asked_for(question)
                return ("taking over", "") if taken else ("question", question.reason)
            proposal = control.proposal
            return ("confirming", "") if proposal is None else ("proposal", proposal.behaviour)
        case "paused":
            return "paused", ""
        case "running":
            return "", ""
        case forgotten:
            assert_never(forgotten)


def _state(world: object) -> ActivityState | None:
    """Return the present state without a request to the robot; None if it is unknown."""
    if (planned := as_planned(world)) is not None:
        return planned.tracker.state()
    now = as_present(world)
    game = getattr(world, "game", None) if now is None else now.ahead
    return joint_state(game) if isinstance(game, DeclaredGame) else None


def turns_from_now(world: object) -> tuple[str, ...]:
    """Return the order of turns from now on, in a game declared by facts that has turns."""
    now = as_present(world)
    game = getattr(world, "game", None) if now is None else now.ahead
    if not isinstance(game, DeclaredGame) or not game.declaration.takes_turns:
        return ()
    order = (*game.players[game.turn :], *game.players[: game.turn])
    return tuple(one for one in order if one in game.here)
