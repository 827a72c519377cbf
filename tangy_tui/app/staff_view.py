"""What staff always see of a game, as values: the call, the clock, people, the next step.

It is derived from the world's scene without a request to the robot, so that screens may call it
at any rate while the game runs.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from tangy_profiles.activity import Activity
from tangy_profiles.codec import Count, Sparse
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.planned_game import PlannedGame, as_planned
from tangy_profiles.state import FRONT, ActivityState
from tangy_tui.monitoring.attention import goes_to_people

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame
    from tangy_profiles.scene import Scene
    from tangy_tui.learning.policy import Decision, Policy

PersonState = Literal["visited", "comes", "asks", "away", "plays"]
"""`comes`: the robot is on its way to the person."""


@dataclass(frozen=True, slots=True)
class PersonNow:
    """The state of a person; times since their request and since the last visit in s."""

    id: str
    state: PersonState
    turn: int = 0
    """Their position in the queue of requests, from 1; 0: they have not asked."""
    waits: float | None = None
    unvisited: float | None = None
    doing: str = ""
    counts: tuple[tuple[str, int], ...] = ()
    """Their counts in a game declared by facts, such as a score."""
    their_turn: bool = False
    goes_round: bool = True
    """Whether the robot visits people in this game."""
    claims: Sparse[bool] = False
    """Whether their card wins by a claim, so that the robot goes there first."""
    calls_first: Sparse[Count] = 0
    """How many numbers are called before the robot goes there."""
    has_won: Sparse[bool] = False
    """Whether they have won in this game."""
    unasked: Sparse[bool] = False
    """Whether they get a visit although they have not asked."""


@dataclass(frozen=True, slots=True)
class StaffView:
    """The state of the game for staff; see the module."""

    seconds: float
    """Since the game began, in s."""
    called: tuple[int, ...]
    people: tuple[PersonNow, ...]
    pace: float = 0.0
    paused: float | None = None
    """How long the pause has lasted, in s; None: the game is not paused."""


class StaffWatch:
    """Remembers when people asked and when they were visited."""

    def __init__(self) -> None:
        self._looks = threading.Lock()
        """Guards the times: the threads of game, screen and onlookers all call `look`."""
        self._clear()

    def _clear(self) -> None:
        self._began: float | None = None
        self._ended: float | None = None
        self._paused: float | None = None
        self._asks: dict[str, float] = {}
        self._visited: dict[str, float] = {}

    def begin(self, now: float, waits: Mapping[str, float] | None = None) -> None:
        """Start the clock of a game at a time in s; who still waits has waited since they asked.

        `waits` is how long (s) people have waited who asked before the robot was switched on.
        """
        asks = {person: since for person, since in self._asks.items() if since <= now}
        self._clear()
        earlier = {person: now - wait for person, wait in (waits or {}).items()}
        self._began, self._asks = now, {**earlier, **asks}

    def end(self, now: float) -> None:
        """Stop the clock at a time in s: the game is over. Later calls change nothing."""
        if self._ended is None:
            self._ended = now

    def pause(self, now: float) -> bool:
        """Begin a pause at a time in s; return False if the game is already paused."""
        begins, self._paused = self._paused is None, now if self._paused is None else self._paused
        return begins

    def go_on(self) -> None:
        """End a pause."""
        self._paused = None

    def resume(self, now: float, past: PastGame, activity: Activity) -> None:
        """Resume a game at a time in s; restore its clock, its waits, and the times of visits."""
        ends = dict[str, float]()
        for step, over in zip(past.steps, past.clock, strict=True):
            after = step.after
            if after is not None and after.place != FRONT:  # others are helped without a visit
                ends[after.place] = over
        began = now - past.seconds
        self.begin(began)
        self._visited = {person: began + end for person, end in ends.items()}
        self._asks = {person: began + at for person, at in past.asked(activity).items()}

    def look(self, scene: Scene, people: Sequence[str], now: float, world: object) -> StaffView:
        """Update the times at a time in s, and return the state for staff."""
        with self._looks:
            return self._look(scene, people, now, world)

    def _look(self, scene: Scene, people: Sequence[str], now: float, world: object) -> StaffView:
        clock, now = now, now if self._ended is None else min(now, self._ended)
        over = self._ended is not None  # then a wait goes on, also if no request shows it
        for person in [one for one in self._asks if one not in scene.requests and not over]:
            del self._asks[person]
        for person in scene.requests:
            self._asks.setdefault(person, clock)
        planned = world if isinstance(world, PlannedGame) else None
        there = planned is None or planned.arrived
        if scene.place != FRONT and there:
            self._visited[scene.place] = now
        robot = scene.place if there else "", "" if planned is None else planned.bound_for
        return StaffView(
            0.0 if self._began is None else max(0.0, now - self._began),
            scene.called,
            tuple(
                _with_facts(
                    _with_plan(
                        self._person(person, scene, (now, clock), robot), planned, over=over
                    ),
                    world,
                    over=over,
                )
                for person in people
            ),
            0.0 if planned is None else planned.pace,
            None if self._paused is None or self._ended is not None else now - self._paused,
        )

    def _person(
        self, person: str, scene: Scene, times: tuple[float, float], robot: tuple[str, str]
    ) -> PersonNow:
        """Describe a person at a time in the game, and at the time now, in s."""
        now, clock = times
        asks = self._asks.get(person) if person in scene.requests else None
        visited = self._visited.get(person)
        state: PersonState = "asks" if person in scene.requests else "plays"
        if person in scene.away:
            state = "away"
        elif person in robot:
            state = "visited" if person == robot[0] else "comes"
        turn = scene.requests.index(person) + 1 if person in scene.requests else 0
        return PersonNow(
            person,
            state,
            turn,
            None if asks is None else clock - asks,
            None if visited is None else now - visited,
            scene.doing.get(person, ""),
        )


def _with_plan(person: PersonNow, world: PlannedGame | None, *, over: bool) -> PersonNow:
    """Add whether a person has won, and why one who asks is first or has to wait for calls."""
    if world is not None and person.id in world.has_won:
        person = replace(person, has_won=True)
    if world is None or not person.turn or over:
        return person
    calls = world.tracker.calls_first if person.turn == 1 else 0
    claims, unasked = person.id in world.vouched, person.id in world.visiting
    return replace(person, claims=claims, calls_first=calls, unasked=unasked)


def _with_facts(person: PersonNow, world: object, *, over: bool) -> PersonNow:
    """Add what a game declared by facts counts for a person; `over`: nobody has the turn."""
    game = getattr(world, "game", None)
    if not isinstance(game, DeclaredGame):
        return person
    declared = game.declaration
    counts = tuple(
        (fact.name, round(game.number(fact, person.id)))
        for fact in declared.facts.values()
        if fact.kind == "count" and fact.per_player
    )
    turn = not over and declared.takes_turns and game.players[game.turn] == person.id
    return replace(
        person,
        counts=counts,
        their_turn=turn,
        goes_round=goes_to_people(getattr(world, "activity", None)),
    )


def next_step(world: object, policy: Policy) -> tuple[Decision, ActivityState] | None:
    """Return Tangy's next decision in the present state, None if it is unknown."""
    if (game := as_planned(world)) is None:
        return None
    state = game.tracker.state()
    return policy.decide(state.situation), state
