"""The score sheet of a drill: what was answered, what was right, and what to rehearse again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from tangy_profiles.faults import URGENCY
from tangy_profiles.store import Store

DRILL = "drill"
NOTHING_WRONG = "none"
"""The class of rounds in which nothing was wrong."""

CLASSES = (*URGENCY, NOTHING_WRONG)


@dataclass(frozen=True, slots=True)
class AnsweredRound:
    """One round with its answers.

    `code` is the fault ("": nothing was wrong), `recovery` what had to be done; `named` and
    `acted` are what was answered to that. `may_clear` and `cleared` are the right answer and the
    given one where it was asked whether Tangy may be cleared. `seconds` is how long all took.
    """

    number: int
    code: str
    name: str
    recovery: str
    advice: tuple[str, ...]
    named: str
    acted: str
    seconds: float
    may_clear: bool | None = None
    cleared: bool | None = None

    @property
    def kind(self) -> str:
        """The class that it counts for."""
        return self.recovery if self.code else NOTHING_WRONG

    @property
    def named_right(self) -> bool:
        """Whether it was called what it was."""
        return self.named == self.code

    @property
    def acted_right(self) -> bool:
        """Whether the right thing was done."""
        return self.acted == self.recovery

    @property
    def cleared_right(self) -> bool | None:
        """Whether it was known if Tangy may be cleared; None where that was not asked."""
        return None if self.may_clear is None else self.cleared == self.may_clear

    @property
    def points(self) -> int:
        """One for each right answer."""
        return self.named_right + self.acted_right + (self.cleared_right is True)

    @property
    def most(self) -> int:
        """The points that could be had."""
        return 2 if self.may_clear is None else 3

    def to_json(self) -> dict[str, Any]:
        """Return the round as log and `--json` have it."""
        return {
            "round": self.number,
            "fault": self.code,
            "name": self.name,
            "recovery": self.recovery,
            "named": self.named,
            "named_right": self.named_right,
            "acted": self.acted,
            "acted_right": self.acted_right,
            "may_clear": self.may_clear,
            "cleared": self.cleared,
            "cleared_right": self.cleared_right,
            "points": self.points,
            "most": self.most,
            "seconds": self.seconds,
            "advice": list(self.advice),
        }

    @classmethod
    def from_json(cls, body: Mapping[str, Any]) -> AnsweredRound:
        """Read a round that `to_json` wrote."""
        return cls(
            int(body["round"]),
            body["fault"],
            body["name"],
            body["recovery"],
            tuple(body["advice"]),
            body["named"],
            body["acted"],
            float(body["seconds"]),
            body["may_clear"],
            body["cleared"],
        )


@dataclass(frozen=True, slots=True)
class Sheet:
    """The score of one drill: who, which seed, how many rounds there were to be, the answers."""

    who: str
    activity: str
    seed: int
    rounds: int
    answered: tuple[AnsweredRound, ...]
    at: str = ""
    """When it was logged (ISO 8601, UTC)."""

    def by(self, who: str) -> bool:
        """Say whether it is somebody's, however the name is written."""
        return self.who.casefold() == who.casefold()

    @property
    def finished(self) -> bool:
        """Whether every round was answered."""
        return len(self.answered) >= self.rounds

    @property
    def points(self) -> int:
        """All points."""
        return sum(one.points for one in self.answered)

    @property
    def most(self) -> int:
        """The points that could be had in what was answered."""
        return sum(one.most for one in self.answered)

    @property
    def median(self) -> float | None:
        """The median time that a round took, in s; None where none was answered."""
        from statistics import median  # not needed for the first screen, which looks at the points

        return median(one.seconds for one in self.answered) if self.answered else None

    @property
    def by_class(self) -> dict[str, tuple[int, int]]:
        """By class: points, and how many could be had; those that came up, in order of urgency."""
        found: dict[str, tuple[int, int]] = {}
        for kind in CLASSES:
            mine = [one for one in self.answered if one.kind == kind]
            if mine:
                found[kind] = (sum(one.points for one in mine), sum(one.most for one in mine))
        return found

    @property
    def again(self) -> tuple[AnsweredRound, ...]:
        """What to rehearse again: each fault once in which something was wrong."""
        wrong = {one.code: one for one in self.answered if one.points < one.most}
        return tuple(wrong.values())

    def to_json(self) -> dict[str, Any]:
        """Return the sheet as log and `--json` have it."""
        return {
            "who": self.who,
            "activity": self.activity,
            "seed": self.seed,
            "rounds": self.rounds,
            "finished": self.finished,
            "points": self.points,
            "most": self.most,
            "median_seconds": self.median,
            "classes": {kind: list(points) for kind, points in self.by_class.items()},
            "again": [one.code or NOTHING_WRONG for one in self.again],
            "answers": [one.to_json() for one in self.answered],
        }

    @classmethod
    def from_json(cls, body: Mapping[str, Any], at: str = "") -> Sheet:
        """Read a sheet that `to_json` wrote."""
        return cls(
            body["who"],
            body["activity"],
            int(body["seed"]),
            int(body["rounds"]),
            tuple(AnsweredRound.from_json(one) for one in body["answers"]),
            at,
        )


def read_sheets(store: Store, who: str = "") -> list[Sheet]:
    """Read the sheets that were kept (of one person), the oldest first."""
    sheets = [Sheet.from_json(event.body, event.at) for event in store.events(DRILL)]
    return [sheet for sheet in sheets if not who or sheet.by(who)]


def last_sheet(store: Store) -> Sheet | None:
    """Return the newest sheet, or None."""
    event = store.last(DRILL)
    return None if event is None else Sheet.from_json(event.body, event.at)
