"""The library of demonstrations: read from the events of the log, never kept beside it.

A demonstration is a chain of step events. Each later change of whole demonstrations (deleting,
merging, resolving a conflict, ...) is one event, an edit; edits are undone and done
again like typing, the latest first, by events of their own.
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

if TYPE_CHECKING:  # home counts demonstrations before anybody needs a forest
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
"""Kinds of events by which earlier ones read otherwise."""

_Newest: TypeAlias = tuple[str, ...]

_read: WeakKeyDictionary[Store, dict[str, tuple[_Newest, Library]]] = WeakKeyDictionary()
"""What was read of each log for each activity, and the newest events of all kinds then (uuids)."""


class OutOfPlace(Exception):
    """An event makes no sense where it stands in the log."""


def read_library(store: Store, activity: str) -> Library:
    """Read the library of an activity from the log, or return it as it was read before.

    A screen asks for it several times a key, and a log of 200 demonstrations takes a second to
    read. An event that makes no sense where it stands, because one before it is damaged, is set
    aside.
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
    library.entries = dict(in_order)  # so that nobody's number changes when more is shown
    _replace_repeated(library)
    return library


def read_demonstrations(store: Store, activity: str) -> list[Demonstration]:
    """Return the demonstrations of an activity that are not hidden, in order."""
    return read_library(store, activity).demonstrations


def effects_of(store: Store, activity: Activity, policy: Policy) -> Effects:
    """Learn the effects from the demonstrations that a policy rests on."""
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
    """Return a demonstration after one more event; `aside` are the events that are left out."""
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
    """Take back the step that event `at` means; its number counts where others are left out."""
    steps = entry.demonstration.steps
    number = len(steps) if number is None else number
    newest = steps[-1].id if steps else 0
    if number > len(steps) and any(newest < seq < at for seq in aside):
        # The one that was taken back is left out itself.
        return replace(entry, undone=(), taken_back=entry.taken_back + 1)
    if not steps or number < 1:
        raise OutOfPlace("there is no step to take back")
    kept = steps[: min(number, len(steps))]  # the others' undo events were left out
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
    """Take the edit that an undo or a redo means out of those that it can mean."""
    for place, edit in enumerate(edits):
        if edit.seq == seq:
            return edits.pop(place)
    raise OutOfPlace("the change that it is about is not there")


def _sources_of(edit: Edit) -> set[str]:
    """Return the demonstrations that an edit was done to and of which it kept no copy."""
    return set(edit.ids) - set(edit.found)


def _as_it_was(library: Library, edit: Edit, id: str) -> Demonstration:
    """Return a demonstration as an edit found it."""
    return edit.found[id] if id in edit.found else library.entries[id].demonstration


def _hide(library: Library, ids: Sequence[str], why: str) -> None:
    for id in ids:
        if id in library.entries:
            library.entries[id] = replace(library.entries[id], hidden=why)


def _apply(library: Library, edit: Edit, in_force: bool) -> None:
    """Do what an edit did; what it made is there even where the edit was undone."""
    match edit.done:
        case Deletion():
            hidden = "deleted"
        case Restoration():
            hidden = ""
        case Settlement():
            return  # it changes no demonstration; `Library.resolutions` reads it
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
    """Add what an edit made; where the edit was undone it stays, hidden, for old policies."""
    made = replace(
        source, id=id, steps=steps, finished=True, origin=origin, of=edit.ids, guided=False
    )
    hidden = "" if in_force else "undone"
    library.entries[id] = LibraryEntry(made, edit.at, edit.at, hidden=hidden)


def _replace_repeated(library: Library) -> None:
    """Hide demonstrations that a complete newer one shows again from some step."""
    for entry in list(library.entries.values()):
        if takes_place(entry):
            for id in entry.demonstration.of:
                if id in library.entries and not library.entries[id].hidden:
                    _hide(library, [id], "shown again")
