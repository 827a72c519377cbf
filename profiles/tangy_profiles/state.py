"""The vocabulary of the activity state s_a: who is where, who asks for help, how each is doing.

Named tuples rather than dataclasses: a simulated game makes one of these at every step, and the
simulator is measured in steps per second.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

Request = Literal["ANR", "AR"]
"""The assistance request state s_h: assistance not required, or required."""

FRONT = "front"
"""The place in front of the group; every other place is the id of the person the robot is with."""


VARIABLES = (
    "robot's place",
    "activity",
    "end",
    "stage",
    "request",
    "what was asked about",
    "card",
    "others' requests",
)
"""What a behaviour can change, as its effects are learnt and compared."""


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

    step: int
    situation: Situation
    place: str
    attended: str | None
    users: tuple[UserState, ...]
    closed: str | None = None

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

    def to_json(self) -> dict[str, Any]:
        """Return the state as the log keeps it."""
        return {
            "step": self.step,
            "situation": list(self.situation),
            "place": self.place,
            "attended": self.attended,
            "users": [list(user) for user in self.users],
            "closed": self.closed,
        }

    @classmethod
    def from_json(cls, body: Mapping[str, Any]) -> ActivityState:
        """Read a state that `to_json` wrote."""
        return cls(
            int(body["step"]),
            Situation(*body["situation"]),
            str(body["place"]),
            body["attended"],
            tuple(UserState(*user) for user in body["users"]),
            body["closed"],
        )


class Response(NamedTuple):
    """What a person did about a request that was put to them with a persuasive strategy.

    `followed`: what was asked for was seen done before the next behaviour.
    `complied`: it was done within the activity's patience window; this is the Bernoulli outcome
    of Eq. 2. `seconds` is how long it took.
    """

    person: str
    strategy: str
    followed: bool
    complied: bool
    seconds: float


class Outcome(NamedTuple):
    """What became of an executed action.

    `numbers` are the numbers it was about: the one that was called, or those a person was asked
    to mark or to clear. `seconds` is how long it took in the world's own time.
    """

    completed: bool
    seconds: float
    numbers: tuple[int, ...]
    response: Response | None
