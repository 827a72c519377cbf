"""The score sheet of a drill: answers, corrections, and faults to rehearse again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar

from tangy_profiles.codec import Count, Key, Unlogged
from tangy_profiles.faults import URGENCY

NOTHING_WRONG = "none"
"""The class of rounds in which nothing was wrong."""

CLASSES = (*URGENCY, NOTHING_WRONG)


@dataclass(frozen=True, slots=True)
class AnsweredRound:
    """One round with its answers.

    `code` is the fault ("": nothing was wrong) and `recovery` the right action; `named` and `acted`
    are the answers. `may_clear` and `cleared` are the right and the given answer to whether Tangy
    may be cleared, if asked. `seconds` is the time of the round.
    """

    number: Annotated[Count, Key("round")]
    code: Annotated[str, Key("fault")]
    name: str
    recovery: str
    advice: tuple[str, ...]
    named: str
    acted: str
    seconds: float
    may_clear: bool | None = None
    cleared: bool | None = None
    DERIVED: ClassVar[Mapping[str, str]] = {
        key: key for key in ("named_right", "acted_right", "cleared_right", "points", "most")
    }

    @property
    def kind(self) -> str:
        """The class of the round."""
        return self.recovery if self.code else NOTHING_WRONG

    @property
    def named_right(self) -> bool:
        """Whether the fault was named correctly."""
        return self.named == self.code

    @property
    def acted_right(self) -> bool:
        """Whether the right action was chosen."""
        return self.acted == self.recovery

    @property
    def cleared_right(self) -> bool | None:
        """Whether the question about clearing was answered correctly; None if it was not asked."""
        return None if self.may_clear is None else self.cleared == self.may_clear

    @property
    def points(self) -> int:
        """One point for each right answer."""
        return self.named_right + self.acted_right + (self.cleared_right is True)

    @property
    def most(self) -> int:
        """The highest possible score."""
        return 2 if self.may_clear is None else 3


@dataclass(frozen=True, slots=True)
class Sheet:
    """The score of one drill: trainee, seed, the planned number of rounds, the answers."""

    who: str
    activity: str
    seed: int
    rounds: Count
    answered: Annotated[tuple[AnsweredRound, ...], Key("answers")]
    at: Unlogged[str] = ""
    """When it was logged (ISO 8601, UTC)."""
    DERIVED: ClassVar[Mapping[str, str]] = {
        "finished": "finished",
        "points": "points",
        "most": "most",
        "median_seconds": "median",
        "classes": "by_class",
        "again": "codes",
    }

    def by(self, who: str) -> bool:
        """Return whether it belongs to a person, ignoring the case of the name."""
        return self.who.casefold() == who.casefold()

    @property
    def finished(self) -> bool:
        """Whether every round was answered."""
        return len(self.answered) >= self.rounds

    @property
    def points(self) -> int:
        """The sum of the points."""
        return sum(one.points for one in self.answered)

    @property
    def most(self) -> int:
        """The highest possible score of the answered rounds."""
        return sum(one.most for one in self.answered)

    @property
    def median(self) -> float | None:
        """The median time of a round, in s; None if none was answered."""
        from statistics import median  # slow, and unused by the first screen

        return median(one.seconds for one in self.answered) if self.answered else None

    @property
    def by_class(self) -> dict[str, tuple[int, int]]:
        """Points and highest possible score of the classes that occurred, by urgency."""
        found: dict[str, tuple[int, int]] = {}
        for kind in CLASSES:
            mine = [one for one in self.answered if one.kind == kind]
            if mine:
                found[kind] = (sum(one.points for one in mine), sum(one.most for one in mine))
        return found

    @property
    def again(self) -> tuple[AnsweredRound, ...]:
        """The faults to rehearse again, one round with a mistake for each."""
        wrong = {one.code: one for one in self.answered if one.points < one.most}
        return tuple(wrong.values())

    @property
    def codes(self) -> tuple[str, ...]:
        """The codes of the faults to rehearse again."""
        return tuple(one.code or NOTHING_WRONG for one in self.again)
