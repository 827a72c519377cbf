"""Commands of a teacher in a teaching session, and the resulting events."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from tangy_profiles.behaviour import Action
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.scene import Arranged, ArrangedSituation
from tangy_profiles.state import Outcome, Situation
from tangy_tui.learning.conflicts import Shown
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
)

# ------------------------------------------------------------------- what a teacher can do


@dataclass(frozen=True, slots=True)
class Undo:
    """Take the last step back."""


@dataclass(frozen=True, slots=True)
class Redo:
    """Do the step again that was taken back last."""


@dataclass(frozen=True, slots=True)
class Next:
    """Begin another demonstration after a finished one."""


@dataclass(frozen=True, slots=True)
class Discard:
    """Put the present demonstration away (the library brings it back), and begin another."""


@dataclass(frozen=True, slots=True)
class Finish:
    """Take the present demonstration as complete, although its game could go on."""


@dataclass(frozen=True, slots=True)
class Again:
    """Show a demonstration again from some step on: its first `kept` steps stay as they are.

    The present demonstration is taken back to there, and redo leads forward again. Another one is
    replaced when the new one is complete, and not before.
    """

    demonstration: str
    kept: int


RemarkAnswer = Literal["this", "earlier", "both", "undo", "keep", "later"]
"""Answers to a remark: this step is right, the earlier one, both; take this one back,
keep the words for it, or decide later."""


@dataclass(frozen=True, slots=True)
class Settle:
    """Answer the remark that was made on the last step."""

    answer: RemarkAnswer


@dataclass(frozen=True, slots=True)
class SameWhatever:
    """Say that the last step would be the same whatever these facts are (none: all of them)."""

    facts: tuple[str, ...] = ()


TeacherCommand: TypeAlias = (
    Say | Reply | Undo | Redo | Next | Discard | Finish | Again | Settle | SameWhatever
)


# ---------------------------------------------------------------------------- what follows


@dataclass(frozen=True, slots=True)
class Executed:
    """A verified behaviour was carried out and is step `number` of the trajectory (from 1)."""

    number: int
    step: Step
    action: Action
    outcome: Outcome
    speech: str
    image: str


@dataclass(frozen=True, slots=True)
class Contradicted:
    """Step `number` differs from an earlier one in the same situation."""

    number: int
    step: Step
    earlier: Shown
    own: bool
    """Whether the same teacher has shown it."""


@dataclass(frozen=True, slots=True)
class Overlooked:
    """Step `number` passed over its stage, in which the behaviour `due` was to come."""

    number: int
    step: Step
    due: str | None
    """None if the rules of the activity name no behaviour."""


@dataclass(frozen=True, slots=True)
class WrongPerson:
    """Step `number` went to a person who had not asked; `waiting` is who had."""

    number: int
    step: Step
    waiting: str | None


@dataclass(frozen=True, slots=True)
class EndedEarly:
    """Step `number` ended the game before `lacks`, after which games of this activity end."""

    number: int
    step: Step
    lacks: str


@dataclass(frozen=True, slots=True)
class NewWording:
    """Step `number` came of spoken `words` that Tangy was not sure of, or did not understand."""

    number: int
    step: Step
    words: str


Remark: TypeAlias = Contradicted | Overlooked | WrongPerson | EndedEarly | NewWording
"""A remark about the newest step; the teacher answers it, or puts it off."""


@dataclass(frozen=True, slots=True)
class Settled:
    """A remark was answered; `right` are the behaviours called right in its situation."""

    remark: Remark
    answer: RemarkAnswer
    right: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Announced:
    """A guided game is about to bring this about."""

    arranged: Arranged | ArrangedSituation


@dataclass(frozen=True, slots=True)
class StepUndone:
    """Step `number` was taken back; the world is as it was before it."""

    number: int
    step: Step


@dataclass(frozen=True, slots=True)
class RuleChoice:
    """A rule that a step can get: the facts it leaves out, and how many situations it covers."""

    facts: tuple[str, ...]
    covers: int


@dataclass(frozen=True, slots=True)
class Ruled:
    """Step `number` got a rule: whatever some `facts` are, it is the same; `covers` is where."""

    number: int
    step: Step
    facts: tuple[str, ...]
    covers: tuple[Situation, ...]


@dataclass(frozen=True, slots=True)
class NoRule:
    """A rule could not be added: why, of which fact, among which Tangy goes by."""

    why: Literal["no step", "no facts", "not gone by", "all shown"]
    fact: str = ""
    known: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RuleUndone:
    """A rule was taken back; its step stays."""

    rule: Ruled


@dataclass(frozen=True, slots=True)
class Begun:
    """A demonstration was begun, or taken up again with the steps it had."""

    demonstration: Demonstration
    resumed: bool


@dataclass(frozen=True, slots=True)
class Finished:
    """The game is over and the demonstration complete."""

    demonstration: Demonstration


TeachingEvent: TypeAlias = (
    Asked
    | Offered
    | NotUnderstood
    | Refused
    | Rejected
    | Executed
    | Remark
    | Settled
    | Announced
    | StepUndone
    | Ruled
    | RuleUndone
    | NoRule
    | Begun
    | Finished
)
