"""What happens in a game, as it is told: a closed set, each after it is in the log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from tangy_profiles.behaviour import Action
from tangy_profiles.beliefs import Beta
from tangy_profiles.game_records import ChangeKind
from tangy_profiles.state import ActivityState, Outcome, Response
from tangy_tui.interaction.persuasion import StrategyChoice
from tangy_tui.learning.online_learning import Lesson
from tangy_tui.learning.policy import Decision


@dataclass(frozen=True, slots=True)
class GameBegun:
    """A game has begun."""

    game: str
    number: int
    state: ActivityState


@dataclass(frozen=True, slots=True)
class ResumedGame:
    """A game that was interrupted goes on, after so many steps."""

    game: str
    number: int
    steps: int
    state: ActivityState


@dataclass(frozen=True, slots=True)
class Acted:
    """One step of a game: observation, decision, action, and outcome.

    `right` says whether the behaviour is the one that the activity expects there (None where it
    expects nothing) and whether the world could carry it out.
    """

    number: int
    state: ActivityState
    decision: Decision
    choice: StrategyChoice | None
    action: Action
    outcome: Outcome
    after: ActivityState
    speech: str
    image: str
    right: bool


@dataclass(frozen=True, slots=True)
class BeliefUpdated:
    """A person's response, with the updated posterior."""

    response: Response
    belief: Beta


@dataclass(frozen=True, slots=True)
class Unsure:
    """Tangy does not act, it asks: a teacher is to say what to do here.

    `reason` says why, and `remedy` what would help if nobody answers. `fault` is the id of the
    fault about which it asks, if it is not the policy that is not sure.
    """

    state: ActivityState
    decision: Decision
    reason: str
    remedy: str
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Taught:
    """A teacher answered, Tangy did it, and learnt from it what to do here from now on."""

    teacher: str
    lesson: Lesson


@dataclass(frozen=True, slots=True)
class DoneOnce:
    """A teacher's answer was acted upon, but not learnt: it holds for this fault, this once.

    Tangy is sure of what to do in such a situation when nothing is wrong (`instead`).
    """

    teacher: str
    instead: str


@dataclass(frozen=True, slots=True)
class GameEnded:
    """The game is over: played to its end, or stopped for a reason that a person can read.

    `pauses` is how often the robot waited for late data in it, and for how many s.
    """

    game: str
    steps: int
    stopped: str | None
    pauses: tuple[int, float] = (0, 0.0)


@dataclass(frozen=True, slots=True)
class GameChanged:
    """Something changed in the game beside its behaviours; `said` is what the group is told."""

    what: ChangeKind
    person: str = ""
    number: int = 0
    patterns: tuple[str, ...] = ()
    said: str = ""


GameEvent: TypeAlias = (
    GameBegun
    | ResumedGame
    | Acted
    | BeliefUpdated
    | Unsure
    | Taught
    | DoneOnce
    | GameChanged
    | GameEnded
)
