"""The library of demonstrations, derived from the events of the log.

A demonstration is a chain of step events. A later change of whole demonstrations (deletion, merger,
resolution of a conflict, ...) is one event, an edit. Undo and redo of edits, latest first, are
events too.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias, assert_never
from weakref import WeakKeyDictionary

from tangy_profiles.demonstration import Demonstration, Origin, Step
from tangy_profiles.people_records import PersonForgotten, Renamed
from tangy_profiles.teaching_records import (
    Deletion,
    DemonstrationBegun,
    DemonstrationFinished,
    DemonstrationsEdited,
    DemonstrationsEditRedone,
    DemonstrationsEditUndone,
    DemonstrationStep,
    DemonstrationStepRedone,
    DemonstrationStepUndone,
    Division,
    EditDone,
    Merger,
    Restoration,
    Settlement,
)
from tangy_tui.learning.library_entries import Edit, Library, LibraryEntry, takes_place

if TYPE_CHECKING:  # the home screen counts demonstrations before a forest is needed
    from tangy_profiles.activity import Activity
    from tangy_profiles.events import EventRecord
    from tangy_profiles.store import Event, Store
    from tangy_tui.learning.effects import Effects
    from tangy_tui.learning.policy import Policy

_STEPS = (
    DemonstrationBegun,
    DemonstrationStep,
    DemonstrationStepUndone,
    DemonstrationStepRedone,
    DemonstrationFinished,
)
_EDITS = (DemonstrationsEdited, DemonstrationsEditUndone, DemonstrationsEditRedone)


_ERASING = (PersonForgotten, Renamed)
"""Kinds of events that change how earlier events read."""

_Newest: TypeAlias = tuple[str, ...]

_read: WeakKeyDictionary[Store, dict[str, tuple[_Newest, Library]]] = WeakKeyDictionary()
"""The library read from each log, by activity, with the uuids of the newest events of all kinds."""


class OutOfPlace(Exception):
    """An event is inconsistent with the events before it."""


def read_library(store: Store, activity: str) -> Library:
    """Read the library of an activity from the log, or return the cached one.

    A screen asks for it several times per key press, and reading a log of 200 demonstrations takes
    a second. An event that is inconsistent, because one before it is damaged, is set aside.
    """
    kinds = (*_STEPS, *_EDITS, *_ERASING)
    newest = tuple(event.uuid if (event := store.last(kind)) else "" for kind in kinds)
    before, library = _read.get(store, {}).get(activity, (None, Library(activity)))
    if before != newest:
        library = _read_anew(store, activity)
        _read.setdefault(store, {})[activity] = (newest, library)
    return replace(
        library,
        entries=dict(library.entries),
        done=list(library.done),
        undone=list(library.undone),
    )


def _read_anew(store: Store, activity: str) -> Library:
    library = Library(activity)
    edits: list[tuple[Edit, Event[EventRecord]]] = []
    made: dict[str, int] = {}
    for event in store.events(*_STEPS, *_EDITS):
        try:
            match event.record:
                case DemonstrationBegun(demonstration=id, activity=of) as begun:
                    if of == activity:
                        _begin(library, begun, event.at)
                        made[id] = event.seq
                case (
                    DemonstrationStep(demonstration=id)
                    | DemonstrationStepUndone(demonstration=id)
                    | DemonstrationStepRedone(demonstration=id)
                    | DemonstrationFinished(demonstration=id)
                ):
                    entry = library.entries.get(id)
                    if entry is not None:
                        changed = replace(_stepped(entry, event, store.aside), last=event.at)
                        library.entries[id] = changed
                case DemonstrationsEdited(activity=of, edit=done) if of == activity:
                    edits.append((_edit(library, event, done), event))
                    library.done.append(edits[-1][0])
                    library.undone.clear()
                    if isinstance(done, Merger | Division):
                        made |= dict.fromkeys(done.made, event.seq)
                case DemonstrationsEditUndone(activity=of, edit=seq) if of == activity:
                    library.undone.append(_taken(library.done, seq))
                case DemonstrationsEditRedone(activity=of, edit=seq) if of == activity:
                    library.done.append(_taken(library.undone, seq))
        except OutOfPlace as why:
            store.set_aside(event, str(why))
    in_force = {edit.seq for edit in library.done}
    for edit, event in edits:
        making = isinstance(edit.done, Merger | Division)
        if making and not _sources_of(edit) <= library.entries.keys():
            store.set_aside(event, "a demonstration that it was done to is not there")
        else:
            _apply(library, edit, edit.seq in in_force)
    in_order = sorted(library.entries.items(), key=lambda entry: made[entry[0]])
    library.entries = dict(in_order)  # so that numbers do not change when more is shown
    _replace_repeated(library)
    return library


def read_demonstrations(store: Store, activity: str) -> list[Demonstration]:
    """Return the demonstrations of an activity that are not hidden, in order."""
    return read_library(store, activity).demonstrations


def effects_of(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from the demonstrations that a policy was learnt from."""
    from tangy_tui.learning.effects import learn_effects

    entries = read_library(store, activity.name).entries
    used = [entries[id].demonstration for id in policy.demonstrations if id in entries]
    return learn_effects(activity, used, policy.resolutions)


# ------------------------------------------------------------------------ the chain of steps


def _begin(library: Library, begun: DemonstrationBegun, at: str) -> None:
    id = begun.demonstration
    if id in library.entries:
        raise OutOfPlace("a demonstration of this id was begun before")
    steps: tuple[Step, ...] = ()
    if begun.origin == "again" and begun.of[0] in library.entries:
        steps = library.entries[begun.of[0]].demonstration.steps[: begun.kept]
    made = Demonstration(
        id,
        library.activity,
        begun.teacher,
        begun.seed,
        begun.people,
        steps,
        origin=begun.origin,
        of=begun.of,
        guided=begun.guided,
    )
    library.entries[id] = LibraryEntry(made, at, at)


def _stepped(
    entry: LibraryEntry, event: Event[EventRecord], aside: Collection[int]
) -> LibraryEntry:
    """Return a demonstration after one more event; `aside` are the events that were set aside."""
    shown = entry.demonstration
    match event.record:
        case DemonstrationStep(step=step):
            step = replace(step, id=event.seq, teacher=shown.teacher)
            return replace(entry, demonstration=shown.with_step(step), undone=())
        case DemonstrationStepUndone(step=number):
            return _step_undone(entry, number, event.seq, aside)
        case DemonstrationStepRedone():
            if not entry.undone:
                raise OutOfPlace("there is no step to do again")
            again = shown.with_step(entry.undone[-1])
            return replace(entry, demonstration=again, undone=entry.undone[:-1])
        case _:
            return replace(entry, demonstration=replace(shown, finished=True))


def _step_undone(
    entry: LibraryEntry, number: int | None, at: int, aside: Collection[int]
) -> LibraryEntry:
    """Undo step `number` by event `at`, even if some events between them were set aside."""
    steps = entry.demonstration.steps
    number = len(steps) if number is None else number
    newest = steps[-1].id if steps else 0
    if number > len(steps) and any(newest < seq < at for seq in aside):
        # The undone step was itself set aside.
        return replace(entry, undone=(), taken_back=entry.taken_back + 1)
    if not steps or number < 1:
        raise OutOfPlace("there is no step to take back")
    kept = steps[: min(number, len(steps))]  # the undo events of the others were set aside
    return replace(
        entry,
        demonstration=replace(entry.demonstration, steps=kept[:-1], finished=False),
        undone=(*entry.undone, kept[-1]),
        taken_back=entry.taken_back + 1,
    )


# --------------------------------------------------------------------------------- the edits


def _edit(library: Library, event: Event[EventRecord], done: EditDone) -> Edit:
    edit, entries = Edit(event.seq, event.at, done), library.entries
    found = {id: entries[id].demonstration for id in edit.ids if id in entries}
    return replace(edit, found=found)


def _taken(edits: list[Edit], seq: int) -> Edit:
    """Remove the edit that an undo or redo event refers to from a list, and return it."""
    for place, edit in enumerate(edits):
        if edit.seq == seq:
            return edits.pop(place)
    raise OutOfPlace("the change that it is about is not there")


def _sources_of(edit: Edit) -> set[str]:
    """Return the demonstrations that an edit refers to but holds no copy of."""
    return set(edit.ids) - set(edit.found)


def _as_it_was(library: Library, edit: Edit, id: str) -> Demonstration:
    """Return a demonstration as it was at the time of an edit."""
    return edit.found[id] if id in edit.found else library.entries[id].demonstration


def _hide(library: Library, ids: Sequence[str], why: str) -> None:
    for id in ids:
        if id in library.entries:
            library.entries[id] = replace(library.entries[id], hidden=why)


def _apply(library: Library, edit: Edit, in_force: bool) -> None:
    """Apply an edit; demonstrations that it made exist even if it was undone."""
    match edit.done:
        case Deletion():
            hidden = "deleted"
        case Restoration():
            hidden = ""
        case Settlement():
            return  # changes no demonstration; see `Library.resolutions`
        case Merger(made=(id,)):
            sources = [_as_it_was(library, edit, id) for id in edit.ids]
            steps = tuple(step for source in sources for step in source.steps)
            teachers = dict.fromkeys(source.teacher for source in sources)
            source = replace(sources[0], teacher=" and ".join(teachers))
            _make(library, edit, id, source, steps, "merged", in_force)
            hidden = "merged"
        case Division(made=(first, second), kept=at):
            source = _as_it_was(library, edit, edit.ids[0])
            _make(library, edit, first, source, source.steps[:at], "split", in_force)
            _make(library, edit, second, source, source.steps[at:], "split", in_force)
            hidden = "split"
        case forgotten:
            assert_never(forgotten)
    if in_force:
        _hide(library, edit.ids, hidden)


def _make(
    library: Library,
    edit: Edit,
    id: str,
    source: Demonstration,
    steps: tuple[Step, ...],
    origin: Origin,
    in_force: bool,
) -> None:
    """Add a demonstration made by an edit; if the edit was undone, hidden, for older policies."""
    made = replace(
        source, id=id, steps=steps, finished=True, origin=origin, of=edit.ids, guided=False
    )
    hidden = "" if in_force else "undone"
    library.entries[id] = LibraryEntry(made, edit.at, edit.at, hidden=hidden)


def _replace_repeated(library: Library) -> None:
    """Hide demonstrations that a finished newer one repeats."""
    for entry in list(library.entries.values()):
        if takes_place(entry):
            for id in entry.demonstration.of:
                if id in library.entries and not library.entries[id].hidden:
                    _hide(library, [id], "shown again")
