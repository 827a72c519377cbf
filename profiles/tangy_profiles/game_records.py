"""The events of games: behaviours, states, faults, and drills."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from tangy_profiles.codec import Count, DecodedBy, Flat, Sparse, decode, measurement
from tangy_profiles.contacts import Role
from tangy_profiles.declared.memory import GameMemory
from tangy_profiles.demonstration import Step, not_the_same
from tangy_profiles.drill_sheet import Sheet
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.game_world import GameWorld
from tangy_profiles.health import Fact
from tangy_profiles.records import EventRecord, kind
from tangy_profiles.state import ActivityState, Variable


@kind("game begun")
class GameBeginning(EventRecord):
    """A game begins with the policy of this digest. The first logs lack `world`.

    `file` is the path of an activity that comes neither with Tangy nor with a package. `room` is
    the name or file of the chosen room; "" if chosen by the number of people. `asks_in_visit` and
    `asks_in_game` are the limits of unsuccessful requests; 0: not logged.
    """

    game: str
    number: Count = 0
    activity: str = ""
    policy: str = ""
    seed: int = 0
    people: tuple[str, ...]
    world: Sparse[GameWorld | None] = None
    room: Sparse[str] = ""
    asks_in_visit: Sparse[Count] = 0
    asks_in_game: Sparse[Count] = 0
    file: Sparse[str] = ""
    patterns: Sparse[tuple[str, ...]] = ()
    several: Sparse[bool] = False
    visits: Sparse[bool] = False
    strength: Sparse[str] = ""
    absent: Sparse[tuple[str, ...]] = ()
    pace: Sparse[float] = 0.0
    minutes: Sparse[Count] = 0
    """Staff's plan for the game, as in `GamePlan`; empty if they chose none."""

    @property
    def plan(self) -> GamePlan:
        """Staff's plan for the game."""
        return GamePlan(
            self.patterns,
            self.several,
            self.visits,
            self.strength,
            self.absent,
            self.pace,
            self.minutes,
        )

    def follows(self, game: GameBeginning) -> bool:
        """Return whether it is the next game after another one in the same run."""
        return (self.number, self.seed) == (game.number + 1, game.seed)


@kind("game world set")
class GameWorldSet(EventRecord):
    """Staff set the world of a game."""

    game: str
    world: GameWorld
    by: str = ""


def _state_of_a_game(value: Any) -> ActivityState:
    """Decode a state; the first logs lack `closed`."""
    if isinstance(value, dict) and "closed" not in value:
        value = {**value, "closed": None}
    return decode(ActivityState, value)


GameState: TypeAlias = Annotated[ActivityState, DecodedBy(_state_of_a_game)]


@kind("game resumed")
class GameResumed(EventRecord):
    """An interrupted game continues after this many steps."""

    game: str
    steps: Count
    by: str = ""


ChangeKind = Literal[
    "taken back",
    "patterns chosen",
    "others first",
    "played on",
    "won",
    "claimed",
    "left",
    "came",
    "joined",
    "visit",
    "visit put off",
    "visit over",
    "calls first",
    "all called",
    "nobody won",
    "several winners",
    "one winner",
    "visits on",
    "visits off",
    "pace",
]
"""Kinds of changes in a game besides its behaviours."""

SETTLING: tuple[ChangeKind, ...] = ("others first", "played on", "visit put off", "visit over")
"""Changes that close the request of their person."""


@kind("game change")
class GameChange(EventRecord):
    """A change in a game after this many `steps`, besides its behaviours.

    A call (`number`) was taken back; staff chose the next `patterns`; a winner (`person`) waits for
    the others, the game continues with the next pattern, or is won; a card was claimed to win;
    `person` left or came, joined the game at a `place` (from 0; None: after the others), or gets
    an unrequested visit; some calls
    (`number`) come before requests; all numbers were called, so each person gets a
    visit; after these visits nobody has won, or nobody else after `number` patterns; staff allowed
    several winners of one call, or one; turned visits on or off; or chose another pace (`seconds`
    between calls).
    """

    game: str
    steps: Count
    what: ChangeKind
    person: Sparse[str] = ""
    number: Sparse[Count] = 0
    patterns: Sparse[tuple[str, ...]] = ()
    seconds: Sparse[float] = 0.0
    place: Sparse[Count | None] = None
    by: Sparse[str] = ""


@kind("game step")
class GameStep(EventRecord):
    """An executed behaviour: how it was chosen, and the states before and `after` it.

    `seconds` is its duration, and `clock` the time played when it ended, including pauses between
    steps; old logs lack them. `asking` is who asks for help in a live game, in the order of the
    queue, also while `after` shows no requests because numbers are called first, and `since` when
    each of them asked, by the `clock`; below 0: before the game. `memory` holds the facts of a live
    game of an activity by facts, which the steps alone do not determine.
    """

    game: str
    behaviour: str
    target: str | None
    strategy: str | None = None
    share: float | None = None
    teacher: str | None = None
    draws: Mapping[str, float] | None = None
    numbers: tuple[int, ...] = ()
    completed: bool = True
    seconds: float | None = None
    clock: Sparse[float | None] = None
    state: GameState
    after: GameState | None = None
    asking: Sparse[tuple[str, ...] | None] = None
    since: Sparse[tuple[float, ...] | None] = None
    memory: Sparse[GameMemory | None] = None

    def invalid_reason(self) -> str:
        """Return an inconsistency as the tail of a sentence; "" if there is none."""
        return not_the_same(self.state, self.after)


@kind("game ended")
class GameEnding(EventRecord):
    """A game ended; `stopped` is the reason if it was stopped early.

    `pauses` is how often the robot waited for late data, and `paused_seconds` for how long. `looks`
    is the number of looks at the attended person's card, and `looks_wrong` how many were outvoted.
    `due` is the behaviour that the activity expected instead of the one that ended the game, and
    `rounds_left` the number of rounds still to come.
    """

    game: str
    steps: Count
    stopped: str | None
    pauses: Sparse[Count] = 0
    paused_seconds: Sparse[float] = 0.0
    looks: Sparse[Count] = 0
    looks_wrong: Sparse[Count] = 0
    due: Sparse[str] = ""
    rounds_left: Sparse[Count] = 0


Criticality = Literal["critical", "non-critical"]
Measurement: TypeAlias = Annotated[Fact, DecodedBy(measurement)]


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A variable with a value that no demonstration showed after this behaviour."""

    ONLY: ClassVar[bool] = True
    behaviour: str
    variable: Variable
    expected: tuple[str, ...]
    seen: str

    def __str__(self) -> str:
        wanted = " or ".join(self.expected) if self.expected else "nothing known"
        return f"{self.behaviour}: {self.variable} should be {wanted}, is {self.seen}"


@kind("fault")
class FaultDiagnosed(EventRecord):
    """A fault was diagnosed; its texts have a slot in place of a person's name."""

    game: str
    fault: str
    code: str
    name: str
    criticality: Criticality
    recovery: str
    step: Count
    seconds: float
    behaviour: str
    console: str
    why: str
    evidence: Mapping[str, Measurement]
    mismatches: tuple[Mismatch, ...]
    advice: tuple[str, ...]


MoveKind = Literal[
    "kept",
    "asked",
    "remedied",
    "teacher asked",
    "halted",
    "acknowledged",
    "expert called",
    "still there",
    "escalated",
    "went on",
    "recovered",
    "taught",
    "accepted",
    "cleared",
    "ended",
    "left",
    "given up",
    "left open",
]
"""Kinds of moves against a fault."""


@dataclass(frozen=True, slots=True)
class RecoveryEvent:
    """One step of a recovery: kind, attempt number, person, speech, time (s).

    `answer` is the behaviour that a teacher said, for the person `target` ("": for nobody).
    """

    kind: MoveKind
    seconds: float
    attempt: Sparse[Count] = 0
    by: Sparse[str] = ""
    to: Sparse[str] = ""
    speech: Sparse[str] = ""
    image: Sparse[str] = ""
    remedy: Sparse[str] = ""
    answer: Sparse[str] = ""
    target: Sparse[str] = ""

    def called(self, name: str) -> RecoveryEvent:
        """Return the event with the person's name in its slots."""
        return replace(self, speech=named(self.speech, name), image=named(self.image, name))


NAME = "{name}"
"""The slot for a person's name in the log, so that names can be forgotten."""


def named(text: str, name: str) -> str:
    """Fill a person's name into a text of a fault."""
    return text.replace(NAME, name)


@kind("recovery")
class FaultMove(EventRecord):
    """A recovery event of a fault."""

    game: str
    fault: str
    move: Flat[RecoveryEvent]


CallStage = Literal["tried", "sent", "answered", "failed", "reached"]
"""Outcome of a call: a person `answered`, or staff say that they have `reached` them."""


@kind("call")
class CallMade(EventRecord):
    """A contact was called about a fault: role, channel, and outcome.

    `said` is the answer, the reason for the failure, or who says that the person was reached.
    """

    game: str
    fault: str
    role: Role
    way: str
    stage: CallStage
    said: Sparse[str] = ""


@kind("answer not clear")
class AnswerNotClear(EventRecord):
    """A person's answer was not certain enough to be judged.

    `certainty` is the probability that it was `said`, `source` the device or method. `asked_again`
    is False if the question had been repeated often enough.
    """

    game: str
    fact: str
    said: str
    certainty: float
    source: str
    asked_again: bool = True


@kind("effect accepted")
class EffectAccepted(EventRecord):
    """A teacher accepted an observed effect of a behaviour."""

    activity: str
    game: str
    fault: str
    by: str
    step: Flat[Step]


@kind("acceptance taken back")
class AcceptanceTakenBack(EventRecord):
    """The acceptance logged as event `number` is withdrawn."""

    number: int


@kind("drill-round")
class DrillAnswered(EventRecord):
    """A round of a drill was answered: the sheet so far, to resume an interrupted drill."""

    sheet: Flat[Sheet]


@kind("drill")
class DrillHeld(EventRecord):
    """A drill ended, with this score sheet."""

    sheet: Flat[Sheet]
