"""Commands of a teacher in a teaching session, and the resulting events."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from tangy_profiles.behaviour import Action
from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.scene import ArrangedCard, ArrangedSituation
from tangy_profiles.state import Outcome, Situation
from tangy_tui.learning.conflicts import DemonstratedStep
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Reply,
    Say,
)

# ------------------------------------------------------------------- commands of a teacher


@dataclass(frozen=True, slots=True)
class Undo:
    """Undo the last step."""


@dataclass(frozen=True, slots=True)
class Redo:
    """Redo the step that was undone last."""


@dataclass(frozen=True, slots=True)
class Next:
    """Begin another demonstration after a finished one."""


@dataclass(frozen=True, slots=True)
class Discard:
    """Delete the current demonstration (it can be restored), and begin another."""


@dataclass(frozen=True, slots=True)
class Finish:
    """Mark the current demonstration as complete, although its game could go on."""


@dataclass(frozen=True, slots=True)
class Again:
    """Repeat a demonstration from some step on: its first `kept` steps stay.

    The current demonstration is undone to that step, and redo works. An older one is replaced as
    soon as the new one is complete.
    """

    demonstration: str
    kept: int


RemarkAnswer = Literal["this", "earlier", "both", "undo", "keep", "later"]
"""Answers to a remark.

This step, the earlier one, or both are right; undo this step; keep the words; or decide later.
"""


@dataclass(frozen=True, slots=True)
class Settle:
    """Answer the remark about the last step."""

    answer: RemarkAnswer


@dataclass(frozen=True, slots=True)
class SameWhatever:
    """Add a rule: the last step is the same whatever these facts are (empty: all facts)."""

    facts: tuple[str, ...] = ()


TeacherCommand: TypeAlias = (
    Say | Reply | Undo | Redo | Next | Discard | Finish | Again | Settle | SameWhatever
)


# ---------------------------------------------------------------------------- events


@dataclass(frozen=True, slots=True)
class Executed:
    """A verified behaviour was carried out as step `number` of the trajectory (from 1)."""

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
    earlier: DemonstratedStep
    own: bool
    """Whether the same teacher showed the earlier step."""


@dataclass(frozen=True, slots=True)
class Overlooked:
    """Step `number` skipped its stage, in which the behaviour `due` was expected."""

    number: int
    step: Step
    due: str | None
    """None if the rules of the activity name no behaviour."""


@dataclass(frozen=True, slots=True)
class WrongPerson:
    """Step `number` went to a person who had not asked; `waiting` is the one who had."""

    number: int
    step: Step
    waiting: str | None


@dataclass(frozen=True, slots=True)
class EndedEarly:
    """Step `number` ended the game before `lacks`, the behaviour that ends this activity."""

    number: int
    step: Step
    lacks: str


@dataclass(frozen=True, slots=True)
class NothingChanged:
    """Step `number` changed nothing; if `back`, it led back to where the game has been."""

    number: int
    step: Step
    back: bool


@dataclass(frozen=True, slots=True)
class NewWording:
    """Step `number` followed spoken `words` that Tangy did not understand for certain."""

    number: int
    step: Step
    words: str


Remark: TypeAlias = (
    Contradicted | Overlooked | WrongPerson | EndedEarly | NothingChanged | NewWording
)
"""A remark about the newest step; the teacher answers or postpones it."""


@dataclass(frozen=True, slots=True)
class Settled:
    """A remark was answered; `right` are the behaviours called right in its situation."""

    remark: Remark
    answer: RemarkAnswer
    right: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Announced:
    """A guided game is about to bring about this event or situation."""

    arranged: ArrangedCard | ArrangedSituation


@dataclass(frozen=True, slots=True)
class StepUndone:
    """Step `number` was undone; the world is in the state before it."""

    number: int
    step: Step


@dataclass(frozen=True, slots=True)
class RuleChoice:
    """A rule that a step can get: the facts to ignore, and how many situations it covers."""

    facts: tuple[str, ...]
    covers: int


@dataclass(frozen=True, slots=True)
class Ruled:
    """Step `number` got a rule: it ignores `facts`, and covers these situations."""

    number: int
    step: Step
    facts: tuple[str, ...]
    covers: tuple[Situation, ...]


@dataclass(frozen=True, slots=True)
class NoRule:
    """A rule was not added: the reason, the unknown fact, and the facts that are known here."""

    why: Literal["no step", "no facts", "not gone by", "all shown"]
    fact: str = ""
    known: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class RuleUndone:
    """A rule was undone; its step stays."""

    rule: Ruled


@dataclass(frozen=True, slots=True)
class Begun:
    """A demonstration was begun, or resumed with its earlier steps."""

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
