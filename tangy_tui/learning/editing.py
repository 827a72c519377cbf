"""Edits of the library: delete, restore, merge, split, settle a conflict; undo and redo.

Each edit is one event in the log, so it is atomic and nothing is ever lost.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from uuid import uuid4

from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_profiles.store import Store
from tangy_profiles.teaching_records import (
    Deletion,
    DemonstrationsEdited,
    DemonstrationsEditRedone,
    DemonstrationsEditUndone,
    Division,
    EditDone,
    Merger,
    Restoration,
    Settlement,
)
from tangy_tui.learning.conflicts import Conflict, Resolution
from tangy_tui.learning.library import read_library
from tangy_tui.learning.library_entries import Edit, Library, LibraryEntry

MakeId = Callable[[], str]


class NotPossible(TangyError):
    """The edit is not possible; the message says why."""


def new_id() -> str:
    """Return a new id for a demonstration."""
    return uuid4().hex[:12]


class Editor:
    """Edits the library of one activity. Each method returns the edit that it made.

    Raises:
        NoDemonstration: no demonstration has this name.
        NotPossible: the edit is not possible; the message says why.
    """

    def __init__(self, store: Store, activity: Activity, make_id: MakeId = new_id) -> None:
        self.activity = activity
        self._store = store
        self._make_id = make_id

    @property
    def library(self) -> Library:
        """The current library."""
        return read_library(self._store, self.activity.name)

    def delete(self, *wanted: str) -> Edit:
        """Delete demonstrations: they are not learnt from until they are restored."""
        entries = self._choose(wanted)
        for entry in entries:
            if entry.hidden:
                name = self.library.name(entry.demonstration.id)
                raise NotPossible(f"{name} is not in use: {entry.hidden}.")
        return self._edit(Deletion(ids=_ids(entries)))

    def restore(self, *wanted: str) -> Edit:
        """Restore deleted demonstrations."""
        library, entries = self.library, self._choose(wanted)
        for entry in entries:
            name = library.name(entry.demonstration.id)
            if entry.hidden == "shown again" or library.repeats(entry):
                raise NotPossible(  # only one of the two can be in use
                    f"{name} was shown again: delete the new one, and it is in use."
                )
            if entry.hidden in ("merged", "split"):
                raise NotPossible(
                    f"{name} was {entry.hidden}: undo that with `tangy demonstrations undo`."
                )
            if entry.hidden == "undone":
                raise NotPossible(
                    f"What made {name} was taken back: `tangy demonstrations redo` makes it again."
                )
            if not entry.hidden:
                raise NotPossible(f"{name} is in use already.")
        return self._edit(Restoration(ids=_ids(entries)))

    def merge(self, *wanted: str) -> Edit:
        """Merge several demonstrations into one, in the given order; the new one replaces them."""
        entries = self._choose(wanted)
        self._need_use(entries)
        if len(entries) < 2:
            raise NotPossible("Merging needs two demonstrations or more.")
        return self._edit(Merger(ids=_ids(entries), made=(self._make_id(),)))

    def split(self, wanted: str, kept: int) -> Edit:
        """Split a demonstration into its first `kept` steps and the rest."""
        entries = self._choose([wanted])
        self._need_use(entries)
        steps = len(entries[0].demonstration.steps)
        if not 1 <= kept < steps:
            choice = f"choose from 1 to {steps - 1}" if steps > 1 else "it is too short"
            name = self.library.name(entries[0].demonstration.id)
            raise NotPossible(
                f"{name} has {steps} steps and cannot be split after {kept}: {choice}."
            )
        whole = (entries[0].demonstration.id,)
        made = (self._make_id(), self._make_id())
        return self._edit(Division(ids=whole, made=made, kept=kept))

    def resolve(self, conflict: Conflict, *right: str) -> Edit:
        """Settle a conflict: these answers, shown or not, are right; the other steps are wrong."""
        if not right:
            raise NotPossible("Say which answer is right.")
        return self.settle(conflict.resolved(*right))

    def settle(self, resolution: Resolution) -> Edit:
        """Log a teacher's resolution of a situation."""
        for behaviour in resolution.right:
            self.activity.behaviour(behaviour)
        return self._edit(Settlement(resolution=resolution))

    def undo(self) -> Edit:
        """Undo the last edit."""
        done = self.library.done
        if not done:
            raise NotPossible("There is no change of the demonstrations to undo.")
        undo = DemonstrationsEditUndone(activity=self.activity.name, edit=done[-1].seq)
        self._store.append(undo)
        return done[-1]

    def redo(self) -> Edit:
        """Redo the edit that was undone last."""
        undone = self.library.undone
        if not undone:
            raise NotPossible("There is no change of the demonstrations to do again.")
        redo = DemonstrationsEditRedone(activity=self.activity.name, edit=undone[-1].seq)
        self._store.append(redo)
        return undone[-1]

    def _choose(self, wanted: Sequence[str]) -> list[LibraryEntry]:
        library = self.library
        entries = [library.find(one) for one in wanted]
        ids = [entry.demonstration.id for entry in entries]
        if not ids:
            raise NotPossible("Name a demonstration: `tangy demonstrations list` shows them.")
        if len(set(ids)) < len(ids):
            raise NotPossible("The same demonstration was named twice.")
        return entries

    def _need_use(self, entries: Sequence[LibraryEntry]) -> None:
        for entry in entries:
            shown = entry.demonstration
            name = self.library.name(shown.id)
            if entry.hidden:
                raise NotPossible(f"{name} is not in use: {entry.hidden}.")
            if not shown.finished:
                raise NotPossible(plain(f"{name} by {shown.teacher} is not finished yet."))

    def _edit(self, done: EditDone) -> Edit:
        seq = self._store.append(DemonstrationsEdited(activity=self.activity.name, edit=done))
        edit = self.library.done[-1]
        if edit.seq != seq:  # there is only one writer
            raise NotPossible("The log was changed meanwhile.")
        return edit


def _ids(entries: Sequence[LibraryEntry]) -> tuple[str, ...]:
    return tuple(entry.demonstration.id for entry in entries)
