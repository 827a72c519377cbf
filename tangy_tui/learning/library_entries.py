"""The demonstrations of an activity and their edits: the library as a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from tangy_profiles.demonstration import Demonstration, Step
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_profiles.teaching_records import EditDone, Settlement
from tangy_tui.learning.conflicts import Conflict, Resolution, find_conflicts, joined

SHORTEST_PREFIX = 3
"""Characters of an id that identify a demonstration, if the prefix is unique."""


class NoDemonstration(TangyError):
    """No demonstration has this name."""


@dataclass(frozen=True, slots=True)
class LibraryEntry:
    """One demonstration of the library and its state.

    `at` and `last` are the UTC times (ISO 8601) of its first and last event, `undone` the steps
    that redo brings back (the next one last), and `taken_back` the number of undone steps. `hidden`
    says why it is not learnt from ("" if it is).
    """

    demonstration: Demonstration
    at: str
    last: str
    undone: tuple[Step, ...] = ()
    taken_back: int = 0
    hidden: str = ""


@dataclass(frozen=True, slots=True)
class Edit:
    """An edit of the library, logged as event `seq`.

    `found` are the demonstrations as they were at that time, without those that edits made: a
    demonstration may change afterwards, but the result of the edit does not.
    """

    seq: int
    at: str
    done: EditDone
    found: Mapping[str, Demonstration] = field(default_factory=dict)

    @property
    def ids(self) -> tuple[str, ...]:
        """The ids of the demonstrations that were edited."""
        return () if isinstance(self.done, Settlement) else self.done.ids


@dataclass
class Library:
    """The demonstrations of one activity, in the order in which they were begun."""

    activity: str
    entries: dict[str, LibraryEntry] = field(default_factory=dict)
    done: list[Edit] = field(default_factory=list)
    """The edits in force; undo takes back the last."""
    undone: list[Edit] = field(default_factory=list)
    """The edits that redo brings back, the next one last."""

    @property
    def demonstrations(self) -> list[Demonstration]:
        """The demonstrations that are not hidden, finished or not."""
        return [e.demonstration for e in self.entries.values() if not e.hidden]

    @property
    def finished(self) -> list[Demonstration]:
        """The demonstrations that are learnt from."""
        return [d for d in self.demonstrations if d.finished]

    @property
    def resolutions(self) -> tuple[Resolution, ...]:
        """Teachers' resolutions of conflicts, merged for each situation."""
        said = (e.done.resolution for e in self.done if isinstance(e.done, Settlement))
        return tuple(joined(said).values())

    @property
    def conflicts(self) -> list[Conflict]:
        """Unresolved conflicts of the finished demonstrations."""
        return find_conflicts(self.finished, self.resolutions)

    @property
    def all_conflicts(self) -> list[Conflict]:
        """Unresolved conflicts, including unfinished demonstrations."""
        return find_conflicts(self.demonstrations, self.resolutions)

    def find(self, wanted: str) -> LibraryEntry:
        """Find a demonstration by its number in the list (from 1), its id, or a prefix of its id.

        Raises:
            NoDemonstration: no demonstration matches, or more than one.
        """
        entries = list(self.entries.values())
        if wanted in self.entries:
            return self.entries[wanted]
        if wanted.isdecimal() and 1 <= int(wanted) <= len(entries):
            return entries[int(wanted) - 1]
        enough = len(wanted) >= SHORTEST_PREFIX
        found = [e for id, e in self.entries.items() if enough and id.startswith(wanted)]
        if len(found) == 1:
            return found[0]
        if not entries:
            raise NoDemonstration("There are no demonstrations yet: begin with `tangy teach`.")
        choice = f"choose from 1 to {len(entries)}" if len(entries) > 1 else "there is only 1"
        if found:
            raise NoDemonstration(
                plain(f"More than one demonstration is called {wanted!r}: {choice}.")
            )
        raise NoDemonstration(plain(f"No demonstration is called {wanted!r}: {choice}."))

    def repeats(self, entry: LibraryEntry) -> bool:
        """Return whether a finished demonstration in use repeats this one."""
        return any(
            entry.demonstration.id in other.demonstration.of
            for other in self.entries.values()
            if takes_place(other)
        )

    def number(self, id: str) -> int:
        """Return the number of a demonstration in the list, from 1; 0 if it is not there."""
        return list(self.entries).index(id) + 1 if id in self.entries else 0

    def name(self, id: str) -> str:
        """Return the name of a demonstration for people."""
        return f"demonstration {self.number(id) or id}"


STILL_USED = ("", "merged", "split", "shown again")
"""States in which the steps of a demonstration, or of its replacement, are learnt from."""


def takes_place(entry: LibraryEntry) -> bool:
    """Return whether a demonstration replaces those that it repeats."""
    made = entry.demonstration
    return made.origin == "again" and made.finished and entry.hidden in STILL_USED
