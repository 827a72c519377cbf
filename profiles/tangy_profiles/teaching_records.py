"""The events of teaching: demonstrations, their edits, and learnt policies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self, TypeAlias

from tangy_profiles.codec import Count, Flat, Sparse, Unlogged, at_least, within_range
from tangy_profiles.demonstration import Demonstration, Origin, Resolution, Step
from tangy_profiles.records import EventRecord, kind
from tangy_profiles.state import Request, Situation

Ids: TypeAlias = Annotated[tuple[str, ...], at_least(1)]


@kind("demonstration begun")
class DemonstrationBegun(EventRecord):
    """A demonstration begins; `kept` is the number of first steps repeated from `of`."""

    demonstration: str
    activity: str
    teacher: str
    seed: int
    people: tuple[str, ...]
    guided: bool = False
    origin: Origin = "shown"
    of: tuple[str, ...] = ()
    kept: Sparse[Count | None] = None

    @classmethod
    def from_demonstration(cls, shown: Demonstration, kept: int | None = None) -> Self:
        """Return the record of a demonstration that begins, with this many steps `kept`."""
        own = ("activity", "teacher", "seed", "people", "guided", "origin", "of")
        about: dict[str, Any] = {name: getattr(shown, name) for name in own}
        return cls(demonstration=shown.id, kept=kept, **about)

    def invalid_reason(self) -> str:
        """Return an inconsistency as the tail of a sentence; "" if there is none."""
        lacks = self.origin == "again" and (not self.of or self.kept is None)
        return "has no 'of' or 'kept'" if lacks else ""


@kind("demonstration step")
class DemonstrationStep(EventRecord):
    """A step was shown; `heard` and `confidence` say how the command was understood."""

    demonstration: str
    step: Flat[Step]
    heard: str | None = None
    confidence: float | None = None


@kind("demonstration step undone")
class DemonstrationStepUndone(EventRecord):
    """The last step was undone; `step` is its number, which the first logs lack."""

    demonstration: str
    step: Sparse[Count | None] = None


@kind("demonstration step redone")
class DemonstrationStepRedone(EventRecord):
    """The step that was undone last was redone."""

    demonstration: str


@kind("demonstration finished")
class DemonstrationFinished(EventRecord):
    """A demonstration is complete."""

    demonstration: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Deletion:
    """Demonstrations are deleted."""

    what: Literal["delete"] = "delete"
    ids: Ids


@dataclass(frozen=True, slots=True, kw_only=True)
class Restoration:
    """Deleted demonstrations are restored."""

    what: Literal["restore"] = "restore"
    ids: Ids


@dataclass(frozen=True, slots=True, kw_only=True)
class Settlement:
    """A conflict is settled."""

    what: Literal["resolve"] = "resolve"
    resolution: Flat[Resolution]


@dataclass(frozen=True, slots=True, kw_only=True)
class Merger:
    """Demonstrations are merged into one: `made`."""

    what: Literal["merge"] = "merge"
    ids: Ids
    made: tuple[str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Division:
    """A demonstration is split in two, `made`, after `kept` steps."""

    what: Literal["split"] = "split"
    ids: tuple[str]
    made: tuple[str, str]
    kept: Count


EditDone: TypeAlias = Deletion | Restoration | Settlement | Merger | Division


@kind("demonstrations edited")
class DemonstrationsEdited(EventRecord):
    """An edit of whole demonstrations of an activity."""

    activity: str
    edit: Flat[EditDone]


@kind("demonstrations edit undone")
class DemonstrationsEditUndone(EventRecord):
    """An edit was undone, by its seq."""

    activity: str
    edit: int


@kind("demonstrations edit redone")
class DemonstrationsEditRedone(EventRecord):
    """An undone edit was redone, by its seq."""

    activity: str
    edit: int


@dataclass(frozen=True, slots=True)
class ForestSettings:
    """The parameters of the forest, as in scikit-learn's RandomForestClassifier.

    The limits are far beyond any use, so that a damaged row costs neither time nor memory.
    """

    ONLY: ClassVar[bool] = True

    trees: Annotated[int, within_range(1, 1_000)] = 100
    bootstrap: bool = False
    min_samples_leaf: Annotated[int, within_range(1, 1_000_000)] = 1
    seed: int = 0


class LearntRow(NamedTuple):
    """A policy's decision in a demonstrated situation, and its share of the votes."""

    stage: str
    request: Request
    user_state: str
    behaviour: str
    share: float

    @property
    def situation(self) -> Situation:
        """The situation."""
        return Situation(self.stage, self.request, self.user_state)


@kind("own phrase")
class OwnPhraseNoted(EventRecord):
    """A teacher's own phrase for a behaviour was stored, or (not `kept`) declined or removed."""

    activity: str
    teacher: str
    text: str
    behaviour: str
    kept: bool


@kind("policy learnt")
class PolicyLearnt(EventRecord):
    """A policy was stored: its training data, settings, digest and decisions."""

    name: str
    activity: str
    demonstrations: tuple[str, ...]
    forest: ForestSettings
    versions: Mapping[str, str]
    digest: str
    resolved: tuple[Resolution, ...] = ()
    rows: tuple[LearntRow, ...]
    asks: Sparse[tuple[Situation, ...] | None] = None
    """The situations in which it asks; the first logs lack them."""
    at: Unlogged[str] = ""
    """When it was logged (ISO 8601, UTC)."""

    def invalid_reason(self) -> str:
        """Return an inconsistency as the tail of a sentence; "" if there is none.

        Repetitions would be learnt again, and a damaged row may have millions.
        """
        if len(set(self.demonstrations)) < len(self.demonstrations):
            return "names a demonstration twice"
        if len({row.situation for row in self.rows}) < len(self.rows):
            return "has two rows for a situation"
        return ""
