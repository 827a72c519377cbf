"""The activity state s_a: where everybody is, who asks for help, and each person's activity.

Named tuples instead of dataclasses, because a simulated game makes one at every step, and the
simulator's speed is measured in steps per second.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, get_args

from tangy_profiles.codec import Count, Sparse

Request = Literal["ANR", "AR"]
"""The assistance request state s_h: assistance not required, or required."""

FACTS = "; "
"""Separates the facts of a situation, in an activity declared by facts."""
EVERYBODY = "everybody"
"""The target of a command for the whole group."""

FRONT = "front"
"""The place in front of the group; other places are the id of the person the robot is with."""


Variable = Literal[
    "robot's place",
    "activity",
    "end",
    "stage",
    "request",
    "what was asked about",
    "card",
    "others' requests",
]
"""Features that a behaviour can change, for learning and comparing its effects."""
VARIABLES: tuple[Variable, ...] = get_args(Variable)

Progress = Literal["on", "waits", "none", "back"]
"""Where a behaviour led a game.

On; nowhere, but time alone will change the situation; nowhere; or back to a state in which the game
has been since people last did something.
"""


LARGEST_STEP = 10**12
"""An upper bound of the steps of a game."""


class UserState(NamedTuple):
    """One person as the robot sees them: id, user activity state s_ua, request state s_h."""

    id: str
    activity: str
    request: Request


class Situation(NamedTuple):
    """The attended-user triple: the input of the policy (a row of Table II)."""

    stage: str
    request: Request
    user_state: str


class ActivityState(NamedTuple):
    """The whole joint state s_a^p at step k.

    `attended` is the person at the head of the first-come queue of requests (or none); the queue is
    kept by rule and never learnt. `situation` is the part of the state that the policy sees.
    `closed` is the person whose request the last behaviour closed: without it, a request that
    stayed open would look like one that was closed and immediately reopened.
    """

    step: Count
    situation: Situation
    place: str
    attended: str | None
    users: tuple[UserState, ...]
    closed: str | None = None
    facts: Sparse[tuple[tuple[str, str], ...]] = ()
    """In an activity declared by facts: each fact with its value."""
    whom: Sparse[tuple[tuple[str, str], ...]] = ()
    """In such an activity: each selector that names a person now, with the person."""

    @property
    def stage(self) -> str:
        """The activity stage, by the tracker's rules."""
        return self.situation.stage

    def user(self, id: str) -> UserState:
        """Return one person's state.

        Raises:
            KeyError: nobody with that id takes part.
        """
        for user in self.users:
            if user.id == id:
                return user
        raise KeyError(id)

    def invalid_reason(self) -> str:
        """Return an inconsistency as the tail of a sentence; "" if there is none."""
        ids = [user.id for user in self.users]
        if len(set(ids)) < len(ids):
            return "has somebody twice"
        there = self.attended is None or self.attended in ids
        return "" if there else "has somebody 'attended' who is not among the 'users'"

    @classmethod
    def decode_quickly(cls, value: Any) -> ActivityState | None:
        """Decode a valid state quickly, as most of a log consists of states.

        Returns:
            The state, or None if the codec must check it in detail.
        """
        try:
            if "facts" in value or "whom" in value:
                return None
            stage, request, activity = value["situation"]
            users, ids = [], set()
            for user in value["users"]:
                id, doing, asks = user
                if not (type(user) is list and type(id) is type(doing) is str):
                    return None
                users.append(UserState(id, doing, asks))
                ids.add(id)
            step, place = value["step"], value["place"]
            attended, closed = value["attended"], value["closed"]
            fits = (
                type(value["situation"]) is type(value["users"]) is list
                and type(stage) is type(activity) is type(place) is str
                and request in ("ANR", "AR")
                and all(user.request in ("ANR", "AR") for user in users)
                and type(step) is int
                and 0 <= step < LARGEST_STEP
                and len(ids) == len(users)
                and (attended is None or attended in ids)
                and (closed is None or type(closed) is str)
            )
        except (TypeError, KeyError, ValueError):
            return None
        situation = Situation(stage, request, activity)
        return cls(step, situation, place, attended, tuple(users), closed) if fits else None


class Response(NamedTuple):
    """A person's response to a request made with a persuasive strategy.

    `followed`: the requested action was observed before the next behaviour. `complied`: it was done
    within the activity's patience window; this is the Bernoulli outcome of Eq. 2. `seconds` is how
    long it took.
    """

    person: str
    strategy: str
    followed: bool
    complied: bool
    seconds: float


class UnclearAnswer(NamedTuple):
    """An answer that was too uncertain to be judged; `asked_again`: the question was repeated."""

    person: str
    fact: str
    said: str
    certainty: float
    source: str
    asked_again: bool


class Outcome(NamedTuple):
    """The outcome of an executed action.

    `numbers` are the numbers involved: the called one, or those a person was asked to mark or to
    clear. `seconds` is its duration in the world's own time. `speech` and `image` are texts that
    the world chose itself ("": those of the action), with people by their ids.
    """

    completed: bool
    seconds: float
    numbers: tuple[int, ...]
    response: Response | None
    speech: str = ""
    image: str = ""
    unclear: tuple[UnclearAnswer, ...] = ()
    """The answers that were not judged, in order."""
    progress: Progress | None = None
    """Where it led the game, people's acts included; None if only the states can tell."""
    rounds_left: int = 0
    """How many rounds were still to come when the action ended the game."""
    cut_short: bool = False
    """Whether the robot stopped by itself, because the program was silent for a moment."""
    obsolete: bool = False
    """Whether the robot did nothing, because it found another state than Tangy had decided on."""
