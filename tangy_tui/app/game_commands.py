"""What staff can do in a game, and what they are told: closed sets, the same for every door.

A screen's key, a line and a sentence that was heard become one of these commands; the controller
carries it out (see `game_controller`) and answers with events of the game, or with a `StaffNote`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

Autonomy = Literal["alone", "unsure", "each"]
AUTONOMY: tuple[Autonomy, ...] = get_args(Autonomy)
"""How much Tangy does of itself: all of it, or it asks about what it is less sure of, or always."""

Direction = Literal["forward", "back", "left", "right", "still"]
DIRECTIONS: tuple[Direction, ...] = get_args(Direction)

Phase = Literal["idle", "running", "paused", "stopped", "asking", "halted", "staff"]
"""How a game stands. Without a game it is idle; `staff` drive by hand, or say what comes next."""

LONGEST_DRIVE = 5.0  # s that one command drives by hand
TWISTS: dict[Direction, tuple[float, float]] = {
    "forward": (0.3, 0.0),
    "back": (-0.1, 0.0),
    "left": (0.0, 0.6),
    "right": (0.0, -0.6),
    "still": (0.0, 0.0),
}
"""m/s and rad/s: slower than it drives by itself, and slowest where it does not see."""

TAKEN_OVER = "took over"
"""What a question is about that staff wanted to be asked; others are about a fault, by its id."""


@dataclass(frozen=True, slots=True)
class Pause:
    """Pause after the current behaviour."""


@dataclass(frozen=True, slots=True)
class GoOn:
    """Go on after a pause; after a STOP this is what lets the robot move again."""


@dataclass(frozen=True, slots=True)
class OneStep:
    """Do one thing, and pause."""


@dataclass(frozen=True, slots=True)
class StopRobot:
    """Stop the robot now, whatever it does; `by` somebody else than who runs the games."""

    by: str = ""


@dataclass(frozen=True, slots=True)
class TakeOver:
    """Hand control to staff as soon as the current behaviour is over."""


@dataclass(frozen=True, slots=True)
class GiveBack:
    """Hand control back to Tangy."""


@dataclass(frozen=True, slots=True)
class SetAutonomy:
    """Turn the dial of how much Tangy does of itself."""

    level: Autonomy


@dataclass(frozen=True, slots=True)
class CallAgain:
    """Say and show the last number once more."""


@dataclass(frozen=True, slots=True)
class TakeBackCall:
    """Take a call back, by its label, else the last one: it counts as not called."""

    label: str = ""


@dataclass(frozen=True, slots=True)
class SetPace:
    """Let so many s pass from one call to the next."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ChangePace:
    """Call faster (1) or slower (-1), by a step."""

    by: Literal[1, -1]


@dataclass(frozen=True, slots=True)
class ClaimCard:
    """Check a card against all called numbers; `person` is the id of its owner."""

    card: int
    person: str = ""


@dataclass(frozen=True, slots=True)
class ChoosePatterns:
    """Choose the patterns that follow the current one, or those of the next game."""

    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class LetWin:
    """Allow several winners, and visits to people who did not ask; None changes nothing."""

    several: bool | None = None
    visits: bool | None = None


@dataclass(frozen=True, slots=True)
class ComesIn:
    """Take a person, by id, for being here from now on."""

    person: str


@dataclass(frozen=True, slots=True)
class GoesAway:
    """Take a person, by id, for having left."""

    person: str


@dataclass(frozen=True, slots=True)
class AskFor:
    """Ask for help for somebody, by id, who cannot ask."""

    person: str


@dataclass(frozen=True, slots=True)
class Tell:
    """Tell what a person, by id, says or does; None: the one whom the game waits for.

    `sure` is the likelihood that it is so, `source` where it comes from.
    """

    person: str | None
    words: str
    sure: float = 1.0
    source: str = "staff"


@dataclass(frozen=True, slots=True)
class VoidResponse:
    """Let the last response of a person, by id, not count: it was otherwise than it was seen."""

    person: str


@dataclass(frozen=True, slots=True)
class Drive:
    """Drive by hand for so many s, at most `LONGEST_DRIVE`."""

    direction: Direction
    seconds: float = 1.0


@dataclass(frozen=True, slots=True)
class Confirm:
    """Answer what Tangy proposes to do next: do it, or let staff say what else."""

    yes: bool


@dataclass(frozen=True, slots=True)
class Acknowledge:
    """Say that a fault, by id, was seen; without one that which halts Tangy."""

    fault: str = ""


@dataclass(frozen=True, slots=True)
class CallExpert:
    """Note that the expert is called about it."""


@dataclass(frozen=True, slots=True)
class Reached:
    """Say that the expert was reached."""


@dataclass(frozen=True, slots=True)
class Clear:
    """Say that it is over, so that Tangy goes on."""


@dataclass(frozen=True, slots=True)
class Accept:
    """Say that what Tangy asks about is all right."""


@dataclass(frozen=True, slots=True)
class EndGame:
    """End the game; the robot stands."""


PlanCommand: TypeAlias = (
    TakeBackCall | SetPace | ChangePace | ClaimCard | ChoosePatterns | LetWin | ComesIn | GoesAway
)
"""What staff change in a game beside what Tangy does; see `GamePlanControls`."""

GameCommand: TypeAlias = (
    PlanCommand
    | Pause
    | GoOn
    | OneStep
    | StopRobot
    | TakeOver
    | GiveBack
    | SetAutonomy
    | CallAgain
    | AskFor
    | Tell
    | VoidResponse
    | Drive
    | Confirm
    | Acknowledge
    | CallExpert
    | Reached
    | Clear
    | Accept
    | EndGame
)

AT_ONCE = (
    StopRobot,
    Pause,
    GoOn,
    OneStep,
    TakeOver,
    GiveBack,
    SetAutonomy,
    SetPace,
    ChangePace,
    AskFor,
    Tell,
    Confirm,
)
"""What does not wait for its turn."""


WITHOUT_GAME = (
    StopRobot,
    Pause,
    GoOn,
    SetAutonomy,
    SetPace,
    ChangePace,
    ChoosePatterns,
    LetWin,
    ComesIn,
    GoesAway,
)
"""What can be done before a game and after it, too."""

NoteKind = Literal[
    "paused",
    "goes on",
    "one step",
    "stopped",
    "takes over",
    "given back",
    "autonomy",
    "call again",
    "call taken back",
    "pace",
    "claim right",
    "claim wrong",
    "patterns",
    "several",
    "one winner",
    "visits",
    "no visits",
    "here before",
    "away before",
    "last one",
    "not playing",
    "comes",
    "goes",
    "asked for",
    "told",
    "voided",
    "driven",
    "ended",
    "seen before",
    "reached",
    # what cannot be done, and why
    "stopped first",
    "asks first",
    "halted first",
    "no game",
    "no robot",
    "nothing called",
    "not told",
    "nothing to tell",
    "no cards",
    "no such card",
    "whose card",
    "not called",
    "nothing to void",
    "not halted",
    "nobody named",
    "not seen yet",
    "nothing asked",
    "not acceptable",
    "cannot",
]
"""What staff are told of a command."""


@dataclass(frozen=True, slots=True)
class StaffNote:
    """What came of a command, where it is no event of the game; `about` names what it is about."""

    kind: NoteKind
    about: str = ""
    words: str = ""
    """Words of the activity that it quotes."""


@dataclass(frozen=True, slots=True)
class Proposal:
    """What Tangy would do next, for whom, by which share of the votes: staff are asked first."""

    behaviour: str
    target: str | None
    share: float
    seen: int = 0
    """How often it was shown in this situation."""
