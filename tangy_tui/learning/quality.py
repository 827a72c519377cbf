"""Quality notes: what a teacher should know about a demonstration before learning from it.

Each note states a fact of the log; there is no score. `text/quality.py` has its words.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Literal

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_tui.learning.conflicts import Conflict, called_wrong, find_conflicts
from tangy_tui.learning.early_ends import missed_end
from tangy_tui.learning.library_entries import Library, LibraryEntry

MUCH_LONGER = 2.0
"""A demonstration is long if it has more steps than this many times the usual number."""

ENOUGH_TO_COMPARE = 3
"""Complete games needed before a usual length is defined."""


NoteKind = Literal[
    "asked",
    "again",
    "merged",
    "split",
    "not finished",
    "ended early",
    "taken back",
    "failed",
    "contradicts itself",
    "disagrees",
    "called wrong",
    "long",
]


@dataclass(frozen=True, slots=True)
class QualityNote:
    """One fact about a demonstration.

    `count` is a number of steps or situations, or the step it was shown again from;
    `demonstrations` are the numbers of the others, and `due` the behaviour that was still to come.
    """

    kind: NoteKind
    count: int = 0
    demonstrations: tuple[int, ...] = ()
    due: str = ""


def quality_notes(
    activity: Activity,
    entry: LibraryEntry,
    library: Library,
    conflicts: Sequence[Conflict] | None = None,
) -> list[QualityNote]:
    """List notes about a demonstration.

    Args:
        activity: the activity demonstrated.
        entry: the demonstration.
        library: all demonstrations.
        conflicts: those of the library if known, because finding them visits every step.
    """
    if conflicts is None:
        conflicts = library.conflicts
    shown = entry.demonstration
    return [
        *_origin(shown, library),
        *_course(activity, entry),
        *_answers(entry, library, conflicts),
        *_length(shown, library),
    ]


def _origin(shown: Demonstration, library: Library) -> Iterator[QualityNote]:
    """Describe its origin, unless it was shown as one whole game."""
    sources = [library.number(id) for id in shown.of if id in library.entries]
    match shown.origin:
        case "asked":
            yield QualityNote("asked")
        case "again" if sources:
            first = _kept(shown, library) + 1
            yield QualityNote("again", first, (sources[0],))
        case "merged" if sources:
            yield QualityNote("merged", demonstrations=tuple(sources))
        case "split" if sources:
            yield QualityNote("split", demonstrations=(sources[0],))


def _kept(shown: Demonstration, library: Library) -> int:
    """Count the first steps that it shares with its source demonstration."""
    source = library.entries[shown.of[0]].demonstration
    pairs = zip(shown.steps, source.steps, strict=False)
    return next(
        (n for n, (mine, theirs) in enumerate(pairs) if mine.id != theirs.id or not mine.id),
        min(len(shown.steps), len(source.steps)),
    )


def _course(activity: Activity, entry: LibraryEntry) -> Iterator[QualityNote]:
    """Describe how the game went: its end, undone steps, and failed steps."""
    shown = entry.demonstration
    if not shown.finished:
        yield QualityNote("not finished")
    elif shown.replayable and (ending := missed_end(activity, shown)):
        yield QualityNote("ended early", due=activity.behaviour(ending).question)
    if entry.taken_back:
        yield QualityNote("taken back", entry.taken_back)
    failed = sum(not step.completed for step in shown.steps)
    if failed:
        yield QualityNote("failed", failed)


def _answers(
    entry: LibraryEntry, library: Library, conflicts: Sequence[Conflict]
) -> Iterator[QualityNote]:
    """Describe its contradictions: with itself, with others, and with a teacher's resolutions."""
    shown = entry.demonstration
    if not entry.hidden:
        if not shown.finished:  # not in the library's conflicts yet, as it is not learnt from
            conflicts = find_conflicts([*library.finished, shown], library.resolutions)
        alone = find_conflicts([shown], library.resolutions)
        if alone:
            yield QualityNote("contradicts itself", len(alone))
        others = [found for c in conflicts if (found := _opponents(shown.id, c))]
        if others:
            numbers = sorted({library.number(id) for found in others for id in found})
            yield QualityNote("disagrees", len(others), tuple(numbers))
    wrong = sum(called_wrong(library.resolutions, step) for step in shown.steps)
    if wrong:
        yield QualityNote("called wrong", wrong)


def _opponents(id: str, conflict: Conflict) -> set[str]:
    """Return the demonstrations that give an answer to a situation that this one does not."""
    mine = {b for b, steps in conflict.answers.items() if any(s.demonstration == id for s in steps)}
    if not mine:
        return set()
    theirs = (steps for b, steps in conflict.answers.items() if mine != {b})
    return {s.demonstration for steps in theirs for s in steps} - {id}


def _length(shown: Demonstration, library: Library) -> Iterator[QualityNote]:
    """Describe that it took many more steps than usual."""
    usual = [len(d.steps) for d in library.finished if d.id != shown.id and d.replayable]
    if shown.replayable and len(usual) >= ENOUGH_TO_COMPARE:
        middle = median(usual)
        if len(shown.steps) > MUCH_LONGER * middle:
            yield QualityNote("long", round(middle))
