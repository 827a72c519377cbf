"""The list of demonstrations, one row each, for screens and the command line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import DemonstrationStep
from tangy_tui.learning.coverage import coverage
from tangy_tui.learning.library_entries import Library, LibraryEntry
from tangy_tui.learning.quality import QualityNote, quality_notes


@dataclass(frozen=True, slots=True)
class ListRow:
    """One row: the demonstration's `number` in the list (from 1), its teacher and time (UTC).

    `seen` of the activity's `situations` occur in it. `state` is "in use", or why it is not learnt
    from. `notes` are quality notes.
    """

    number: int
    id: str
    teacher: str
    at: str
    steps: int
    seen: int
    situations: int
    notes: tuple[QualityNote, ...]
    state: str

    @property
    def in_use(self) -> bool:
        """Whether the demonstration is learnt from."""
        return self.state == IN_USE

    def to_json(self) -> dict[str, Any]:
        """Return the row as JSON, without the words of its notes."""
        return {
            "number": self.number,
            "id": self.id,
            "teacher": self.teacher,
            "at": self.at,
            "steps": self.steps,
            "coverage": {"seen": self.seen, "situations": self.situations},
            "state": self.state,
        }


IN_USE = "in use"
UNFINISHED = "unfinished"


def state_of(entry: LibraryEntry) -> str:
    """Return "in use", or why a demonstration is not learnt from."""
    if entry.hidden:
        return entry.hidden
    return IN_USE if entry.demonstration.finished else UNFINISHED


def list_rows(activity: Activity, library: Library) -> list[ListRow]:
    """Return a row for every demonstration, also deleted ones, in order of number."""
    conflicts = library.conflicts
    rows = []
    for number, entry in enumerate(library.entries.values(), 1):
        shown = entry.demonstration
        found = coverage(activity, [shown])
        rows.append(
            ListRow(
                number,
                shown.id,
                shown.teacher,
                entry.at,
                len(shown.steps),
                len(found.seen),
                len(found.times),
                tuple(quality_notes(activity, entry, library, conflicts)),
                state_of(entry),
            )
        )
    return rows


def heard_words(store: Store, shown: Demonstration) -> dict[int, str]:
    """Return the spoken or typed words of each step, where known, by step number."""
    numbers = {step.id: number for number, step in enumerate(shown.steps, 1) if step.id}
    events = (event for event in store.events(DemonstrationStep) if event.seq in numbers)
    return {numbers[e.seq]: e.record.heard for e in events if e.record.heard}
