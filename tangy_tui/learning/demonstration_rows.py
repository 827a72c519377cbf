"""The list of demonstrations as people see it: one row each, the same on screens and in lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import DemonstrationStep
from tangy_tui.learning.coverage import coverage
from tangy_tui.learning.library_entries import Library, LibraryEntry
from tangy_tui.learning.quality import quality_notes


@dataclass(frozen=True, slots=True)
class ListRow:
    """One demonstration: `number` in the list (from 1), who showed it, when (UTC, ISO 8601).

    `seen` of the `situations` of the activity occur in it; `state` says whether it is learnt
    from ("in use"), and if not, why; `notes` are what else is to be known of it.
    """

    number: int
    id: str
    teacher: str
    at: str
    steps: int
    seen: int
    situations: int
    notes: tuple[str, ...]
    state: str

    @property
    def in_use(self) -> bool:
        """Whether it is learnt from."""
        return self.state == IN_USE

    def to_json(self) -> dict[str, Any]:
        """Return the row as a document."""
        return {
            "number": self.number,
            "id": self.id,
            "teacher": self.teacher,
            "at": self.at,
            "steps": self.steps,
            "coverage": {"seen": self.seen, "situations": self.situations},
            "state": self.state,
            "notes": list(self.notes),
        }


IN_USE = "in use"
UNFINISHED = "unfinished"


def state_of(entry: LibraryEntry) -> str:
    """Say whether a demonstration is learnt from, or why it is not."""
    if entry.hidden:
        return entry.hidden
    return IN_USE if entry.demonstration.finished else UNFINISHED


def list_rows(activity: Activity, library: Library) -> list[ListRow]:
    """Return a row for every demonstration there ever was, in the order of their numbers."""
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
    """Return the words in which each step was commanded, where they are known, by its number."""
    numbers = {step.id: number for number, step in enumerate(shown.steps, 1) if step.id}
    events = (event for event in store.events(DemonstrationStep) if event.seq in numbers)
    return {numbers[e.seq]: e.record.heard for e in events if e.record.heard}
