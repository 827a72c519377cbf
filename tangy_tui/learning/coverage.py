"""Coverage: which of the situations that can occur in an activity were demonstrated."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.state import Situation
from tangy_tui.learning.conflicts import shown_steps
from tangy_tui.learning.teaching_events import NewWording, Remark


@dataclass(frozen=True, slots=True)
class Coverage:
    """How often each situation was demonstrated, in the order of a game."""

    times: dict[Situation, int]

    @property
    def seen(self) -> list[Situation]:
        """The situations that were shown at least once."""
        return [situation for situation, times in self.times.items() if times]

    @property
    def missing(self) -> list[Situation]:
        """The situations that were never shown."""
        return [situation for situation, times in self.times.items() if not times]


def coverage(activity: Activity, demonstrations: Iterable[Demonstration]) -> Coverage:
    """Count the demonstrated steps in each situation that can occur."""
    counts = Counter(shown.step.state.situation for shown in shown_steps(demonstrations))
    return Coverage({situation: counts[situation] for situation in activity.situations})


def standing(shown: Demonstration, remark: Remark | None) -> Demonstration:
    """Return a demonstration without its last step while a remark asks whether it was a slip."""
    if remark is None or isinstance(remark, NewWording):
        return shown
    return replace(shown, steps=shown.steps[:-1])


def missing_words(activity: Activity, found: Coverage) -> list[str]:
    """Describe in plain words, one line each, the situations that were not shown yet."""
    return [activity.not_yet(situation) for situation in found.missing]
