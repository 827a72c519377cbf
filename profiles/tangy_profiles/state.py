"""The vocabulary of the activity state s_a: who is where, who asks for help, how each is doing.

Named tuples rather than dataclasses: a simulated game makes one of these at every step, and the
simulator is measured in steps per second.
"""

from __future__ import annotations

from typing import Any, Literal, NamedTuple, get_args

from tangy_profiles.codec import Count, Sparse

Request = Literal["ANR", "AR"]
"""The assistance request state s_h: assistance not required, or required."""

FACTS = "; "
"""Between the facts of a situation, where an activity is declared by facts."""
EVERYBODY = "everybody"
"""The target of a command for the whole group."""

FRONT = "front"
"""The place in front of the group; every other place is the id of the person the robot is with."""


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


LARGEST_STEP = 10**12
"""No game has so many steps."""


class UserState(NamedTuple):
    """One person as the robot sees them: id, user activity state s_ua, request state s_h."""

    id: str
    activity: str
    request: Request


class Situation(NamedTuple):
    """The attended-user triple: all that the policy looks at (a row of Table II)."""

    stage: str
    request: Request
    user_state: str


class ActivityState(NamedTuple):
    """The whole joint state s_a^p at step k.

    `attended` is the person at the head of the first-come queue of requests (or none); the queue
    is kept by rule and never learnt. `situation` is the part of the state that the policy sees.
    `closed` is the person whose request the last behaviour closed: without it, a request that
    stayed open and one that was closed and made anew at once would look alike.
    """

    step: Count
    situation: Situation
    place: str
    attended: str | None
    users: tuple[UserState, ...]
    closed: str | None = None
    facts: Sparse[tuple[tuple[str, str], ...]] = ()
    """Of an activity declared by facts: each fact with its value."""
    whom: Sparse[tuple[tuple[str, str], ...]] = ()
    """Of such an activity: each selector that names a person now, with the person."""

    @property
    def stage(self) -> str:
        """The activity stage, as the tracker's rules have it."""
        return self.situation.stage

    def user(self, id: str) -> UserState:
        """Return one person's state.

        Raises:
            KeyError: nobody of that id takes part.
        """
        for user in self.users:
            if user.id == id:
                return user
        raise KeyError(id)

    def misfit(self) -> str:
        """Say what does not fit together, as the tail of a sentence ("": nothing)."""
        ids = [user.id for user in self.users]
        if len(set(ids)) < len(ids):
            return "has somebody twice"
        there = self.attended is None or self.attended in ids
        return "" if there else "has somebody 'attended' who is not among the 'users'"

    @classmethod
    def glance(cls, value: Any) -> ActivityState | None:
        """Read a state that is plainly as it should be: most of a log are states.

        Returns:
            The state, or None if the codec must look closely.
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

    `followed`: what was asked for was seen done before the next behaviour.
    `complied`: it was done within the activity's patience window; this is the Bernoulli outcome
    of Eq. 2. `seconds` is how long it took.
    """

    person: str
    strategy: str
    followed: bool
    complied: bool
    seconds: float


class UnclearAnswer(NamedTuple):
    """An answer that was not sure enough to be judged: `asked_again` says if Tangy asked again."""

    person: str
    fact: str
    said: str
    certainty: float
    source: str
    asked_again: bool


class Outcome(NamedTuple):
    """The outcome of an executed action.

    `numbers` are the numbers it was about: the one that was called, or those a person was asked
    to mark or to clear. `seconds` is how long it took in the world's own time. `speech` and `image`
    are the words that a world chose itself ("": those of the action), with people by their ids.
    """

    completed: bool
    seconds: float
    numbers: tuple[int, ...]
    response: Response | None
    speech: str = ""
    image: str = ""
    unclear: tuple[UnclearAnswer, ...] = ()
    """The answers that were not judged, in their order."""
