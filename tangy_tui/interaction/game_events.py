"""The events of a game, a closed set; each is logged before it is reported."""

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
    """An interrupted game continues after this many steps."""

    game: str
    number: int
    steps: int
    state: ActivityState


@dataclass(frozen=True, slots=True)
class Acted:
    """One step of a game: observation, decision, action, and outcome.

    `right`: the world carried out the behaviour, and it is the one that the activity expects in
    this situation, if it expects any.
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
    """Tangy does not act, but asks a teacher what to do.

    `reason` says why, and `remedy` what would help if nobody answers. `fault` is the id of the
    fault in question; "" if the policy is not sure.
    """

    state: ActivityState
    decision: Decision
    reason: str
    remedy: str
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Taught:
    """A teacher answered; Tangy carried out the answer and learnt it."""

    teacher: str
    lesson: Lesson


@dataclass(frozen=True, slots=True)
class DoneOnce:
    """A teacher's answer about a fault was carried out once, but not learnt.

    The policy is sure of another behaviour (`instead`) in this situation.
    """

    teacher: str
    instead: str


@dataclass(frozen=True, slots=True)
class GameEnded:
    """The game is over: played to its end, or stopped for a reason that is given in words.

    `pauses` is how often the robot waited for late data, and for how many s in all. `due` is the
    behaviour expected instead of the one that ended the game, "" if the end was due.
    """

    game: str
    steps: int
    stopped: str | None
    pauses: tuple[int, float] = (0, 0.0)
    due: str = ""
    rounds_left: int = 0


@dataclass(frozen=True, slots=True)
class GameChanged:
    """A change of the game besides its behaviours; `said` is its announcement to the group."""

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
