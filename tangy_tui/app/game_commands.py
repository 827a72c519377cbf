"""The commands of staff in a game, the same for every interface.

Keys, typed lines and recognised speech become one of these commands. The controller carries it
out (see `game_controller`) and answers with events of the game, or with a `StaffNote`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

if TYPE_CHECKING:
    from tangy_tui.interaction.game_events import Unsure

Autonomy = Literal["alone", "unsure", "each"]
AUTONOMY: tuple[Autonomy, ...] = get_args(Autonomy)
"""How much Tangy decides by itself: everything, all but what it is unsure of, or nothing."""

Direction = Literal["forward", "back", "left", "right", "still"]
DIRECTIONS: tuple[Direction, ...] = get_args(Direction)

Phase = Literal["idle", "running", "paused", "stopped", "asking", "halted", "staff", "joining"]
"""The phase of a game; idle without a game. `staff`: they drive by hand or choose the next step.
"""

LONGEST_DRIVE = 5.0  # s that one command drives by hand
TWISTS: dict[Direction, tuple[float, float]] = {
    "forward": (0.3, 0.0),
    "back": (-0.1, 0.0),
    "left": (0.0, 0.6),
    "right": (0.0, -0.6),
    "still": (0.0, 0.0),
}
"""m/s and rad/s: slower than autonomous driving, slowest backwards, where the robot is blind."""

TAKEN_OVER = "took over"
"""The subject of a question that staff asked for; other questions name the id of a fault."""


def asked_for(question: Unsure | None) -> bool:
    """Return whether staff asked for a question, so that Tangy could also go on by itself."""
    return question is not None and question.fault == TAKEN_OVER


@dataclass(frozen=True, slots=True)
class Pause:
    """Pause after the current behaviour; `unasked`: the program itself pauses, not staff."""

    unasked: bool = False


@dataclass(frozen=True, slots=True)
class GoOn:
    """Continue after a pause; after a STOP, let the robot move again."""


@dataclass(frozen=True, slots=True)
class OneStep:
    """Carry out one behaviour, then pause."""


@dataclass(frozen=True, slots=True)
class StopRobot:
    """Stop the robot now; `by` names who stopped it, unless that is who runs the games."""

    by: str = ""


@dataclass(frozen=True, slots=True)
class TakeOver:
    """Hand control to staff as soon as the current behaviour ends."""


@dataclass(frozen=True, slots=True)
class GiveBack:
    """Hand control back to Tangy."""


@dataclass(frozen=True, slots=True)
class SetAutonomy:
    """Set the level of autonomy."""

    level: Autonomy


@dataclass(frozen=True, slots=True)
class CallAgain:
    """Say and show the last number once more."""


@dataclass(frozen=True, slots=True)
class TakeBackCall:
    """Take back a call, given by its label, or the last one: it counts as not called."""

    label: str = ""


@dataclass(frozen=True, slots=True)
class SetPace:
    """Set the time between two calls."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ChangePace:
    """Call faster (1) or slower (-1) by one step."""

    by: Literal[1, -1]


@dataclass(frozen=True, slots=True)
class PlanTime:
    """Plan the time of the session: `minutes` from now, or that many more; 0: without a limit.

    Or `until` a time of day (hour, minute).
    """

    minutes: int = 0
    more: bool = False
    until: tuple[int, int] | None = None


@dataclass(frozen=True, slots=True)
class ClaimCard:
    """Check a card against all called numbers; `person` is the id of its owner.

    Card 0 is the person's own, if it is known.
    """

    card: int
    person: str = ""


@dataclass(frozen=True, slots=True)
class HasCard:
    """Tell Tangy which card a person, by id, has; nobody else has it from then on."""

    person: str
    card: int


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
    """Mark a person, by id, as present."""

    person: str


@dataclass(frozen=True, slots=True)
class GoesAway:
    """Mark a person, by id, as absent."""

    person: str


@dataclass(frozen=True, slots=True)
class Joins:
    """Let a new person take part, by name; a guest only today.

    The `seat` and the `table` count from 1; 0: the last seat at the table that has room.
    """

    name: str
    guest: bool = False
    seat: int = 0
    table: int = 0


@dataclass(frozen=True, slots=True)
class AskFor:
    """Ask for help on behalf of a person, by id."""

    person: str


@dataclass(frozen=True, slots=True)
class Tell:
    """Report what a person, by id, says or does; None: the person the game waits for.

    `sure` is the probability that the report is right, `source` its origin.
    """

    person: str | None
    words: str
    sure: float = 1.0
    source: str = "staff"


@dataclass(frozen=True, slots=True)
class VoidResponse:
    """Discard the last response of a person, by id, because it was observed wrongly."""

    person: str


@dataclass(frozen=True, slots=True)
class Drive:
    """Drive by hand for some s, at most `LONGEST_DRIVE`."""

    direction: Direction
    seconds: float = 1.0


@dataclass(frozen=True, slots=True)
class Confirm:
    """Answer Tangy's proposal: yes carries it out, no lets staff choose another action."""

    yes: bool


@dataclass(frozen=True, slots=True)
class Acknowledge:
    """Acknowledge a fault, by id; without an id, the one that halts Tangy."""

    fault: str = ""


@dataclass(frozen=True, slots=True)
class CallExpert:
    """Log that staff call the expert."""


@dataclass(frozen=True, slots=True)
class Reached:
    """Log that staff reached the expert."""


@dataclass(frozen=True, slots=True)
class Clear:
    """Clear the fault that halts Tangy, so that it continues."""


@dataclass(frozen=True, slots=True)
class Accept:
    """Accept the condition that Tangy asks about."""


@dataclass(frozen=True, slots=True)
class EndGame:
    """End the game and stop the robot."""


PlanCommand: TypeAlias = (
    TakeBackCall | SetPace | ChangePace | ClaimCard | ChoosePatterns | LetWin | ComesIn | GoesAway
)
"""Changes to a game that staff make besides Tangy's actions; see `GamePlanControls`."""

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
    | PlanTime
    | Joins
    | HasCard
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
    PlanTime,
    HasCard,
    AskFor,
    Tell,
    Confirm,
)
"""Commands that do not wait for the current behaviour to end."""


WITHOUT_GAME = (
    StopRobot,
    Pause,
    GoOn,
    SetAutonomy,
    SetPace,
    ChangePace,
    PlanTime,
    HasCard,
    ChoosePatterns,
    LetWin,
    ComesIn,
    GoesAway,
)
"""Commands that also work when no game is running."""
