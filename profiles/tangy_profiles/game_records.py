"""The events of games: behaviours, states, faults, and drills."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from tangy_profiles.codec import By, Count, Flat, Sparse, measurement, read
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
    """A game begins, by the policy of that digest. The first logs do not name the `world`.

    `file` is the path of an activity that does not come with Tangy or with a package.
    `room` is the name or the file of a room that was chosen; "": the number of people decided.

    `asks_in_visit` and `asks_in_game` say how often a person may be asked in vain; 0: not logged.
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
    """Staff's options for it, as in `GamePlan`; empty if they chose none."""

    @property
    def plan(self) -> GamePlan:
        """Staff's options for it."""
        return GamePlan(
            self.patterns,
            self.several,
            self.visits,
            self.strength,
            self.absent,
            self.pace,
            self.minutes,
        )


@kind("game world set")
class GameWorldSet(EventRecord):
    """Staff said in which world a game was played."""

    game: str
    world: GameWorld
    by: str = ""


def _state_of_a_game(value: Any) -> ActivityState:
    """Read a state; the first games were logged without who was `closed`."""
    if isinstance(value, dict) and "closed" not in value:
        value = {**value, "closed": None}
    return read(ActivityState, value)


GameState: TypeAlias = Annotated[ActivityState, By(_state_of_a_game)]


@kind("game resumed")
class GameResumed(EventRecord):
    """A game that was interrupted goes on, after so many steps."""

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
"""Kinds of changes in a game beside its behaviours."""


@kind("game change")
class GameChange(EventRecord):
    """Something changed in a game after so many `steps`, beside its behaviours.

    A call (`number`) was taken back; staff chose the `patterns` that follow; a winner (`person`)
    waits until others were seen to, the game is played on for the next pattern, or is won;
    a card was found to win, `person` left the game or came to it, or gets a visit unasked;
    so many calls (`number`) come before those who ask; all numbers were called, so that each
    person gets a visit; after these visits nobody has won, or nobody else after `number` patterns;
    staff let everybody win who has it at the same call, or one; let people be visited, or not; or
    chose another pace (`seconds` from one call to the next).
    """

    game: str
    steps: Count
    what: ChangeKind
    person: Sparse[str] = ""
    number: Sparse[Count] = 0
    patterns: Sparse[tuple[str, ...]] = ()
    seconds: Sparse[float] = 0.0
    by: Sparse[str] = ""


@kind("game step")
class GameStep(EventRecord):
    """A behaviour was executed: how it was chosen, and what was seen before and `after`.

    `seconds` is how long it took, `clock` the time that was played when it was over, with what
    passed between the steps; each is None in games of before it was logged. `memory` is what the
    game stands at in a live game of an activity by facts, which the steps alone do not lead to.
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
    memory: Sparse[GameMemory | None] = None

    def misfit(self) -> str:
        """Say what does not fit together, as the tail of a sentence ("": nothing)."""
        return not_the_same(self.state, self.after)


@kind("game ended")
class GameEnding(EventRecord):
    """A game ended; `stopped` says why before its end, if it was.

    `pauses` is how often the robot waited for late data, and `paused_seconds` for how long. `looks`
    is how often it looked at what the person beside it has, and `looks_wrong` how many of these
    looks others overruled.
    """

    game: str
    steps: Count
    stopped: str | None
    pauses: Sparse[Count] = 0
    paused_seconds: Sparse[float] = 0.0
    looks: Sparse[Count] = 0
    looks_wrong: Sparse[Count] = 0


Criticality = Literal["critical", "non-critical"]
Measurement: TypeAlias = Annotated[Fact, By(measurement)]


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A variable that took a value which no demonstration showed after this behaviour."""

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
    """A fault was diagnosed; its texts hold a slot where the name of a person stands."""

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
    """One step of a recovery: kind, attempt number, person, speech, time (s)."""

    kind: MoveKind
    seconds: float
    attempt: Sparse[Count] = 0
    by: Sparse[str] = ""
    to: Sparse[str] = ""
    speech: Sparse[str] = ""
    image: Sparse[str] = ""
    remedy: Sparse[str] = ""

    def called(self, name: str) -> RecoveryEvent:
        """Return the move with the person's name where the log only has a slot for it."""
        return replace(self, speech=named(self.speech, name), image=named(self.image, name))


NAME = "{name}"
"""Replaces a person's name in the log, so that names can be forgotten."""


def named(text: str, name: str) -> str:
    """Return a text of a fault with the person's name in its slot."""
    return text.replace(NAME, name)


@kind("recovery")
class FaultMove(EventRecord):
    """Something was done about a fault, or happened to it."""

    game: str
    fault: str
    move: Flat[RecoveryEvent]


CallStage = Literal["tried", "sent", "answered", "failed", "reached"]
"""Outcome of a call: a person `answered`, or staff say that they have `reached` them."""


@kind("call")
class CallMade(EventRecord):
    """Somebody was called about a fault: in which role, by which way, and what came of it.

    `said` is the answer, why the call failed, or who says that the person was reached.
    """

    game: str
    fault: str
    role: Role
    way: str
    stage: CallStage
    said: Sparse[str] = ""


@kind("answer not clear")
class AnswerNotClear(EventRecord):
    """A person's answer was not sure enough to be judged.

    `certainty` is the probability that it was `said`, `source` what observed it. The person was
    `asked_again`, or had been often enough.
    """

    game: str
    fact: str
    said: str
    certainty: float
    source: str
    asked_again: bool = True


@kind("effect accepted")
class EffectAccepted(EventRecord):
    """A teacher said that what followed a behaviour is all right."""

    activity: str
    game: str
    fault: str
    by: str
    step: Flat[Step]


@kind("acceptance taken back")
class AcceptanceTakenBack(EventRecord):
    """The acceptance by the event of that seq is withdrawn."""

    number: int


@kind("staff action")
class StaffAction(EventRecord):
    """An action of staff other than behaviours and recoveries: a stop, an injected fault.

    `seconds` is the time in the game, `taken_back` the number of a call that counts no more.
    """

    game: str
    what: str
    by: str
    seconds: float | None = None
    taken_back: Sparse[Count] = 0


@kind("drill-round")
class DrillAnswered(EventRecord):
    """A round of a drill was answered: the sheet so far, so that an interrupted drill goes on."""

    sheet: Flat[Sheet]


@kind("drill")
class DrillHeld(EventRecord):
    """A drill was held, with this score sheet."""

    sheet: Flat[Sheet]
