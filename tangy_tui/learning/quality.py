"""Quality notes: what a teacher should know of a demonstration before learning from it.

Each note is a fact of the log in a few plain words; none of them is a mark out of ten.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from statistics import median

from tangy_profiles.activity import Activity
from tangy_profiles.demonstration import Demonstration
from tangy_tui.learning.conflicts import Conflict, find_conflicts
from tangy_tui.learning.library_entries import Library, LibraryEntry

MUCH_LONGER = 2.0
"""Times the usual length from which on a demonstration is called long."""

ENOUGH_TO_COMPARE = 3
"""Other complete games that there must be before anything is called usual."""


def quality_notes(
    activity: Activity,
    entry: LibraryEntry,
    library: Library,
    conflicts: Sequence[Conflict] | None = None,
) -> list[str]:
    """List notes about a demonstration, a few words each; [] if there are none.

    Args:
        activity: the activity demonstrated.
        entry: the demonstration.
        library: all demonstrations.
        conflicts: those of the library, if they are known already; they cost a look at every step.
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


def _origin(shown: Demonstration, library: Library) -> Iterator[str]:
    """Name its origin, unless it was shown in a game from the beginning."""
    sources = [library.number(id) for id in shown.of if id in library.entries]
    match shown.origin:
        case "asked":
            yield "answered in a game"
        case "again" if sources:
            first = _kept(shown, library) + 1
            yield f"shown again from step {first} of demonstration {sources[0]}"
        case "merged" if sources:
            yield f"merged from demonstrations {_listed(sources)}"
        case "split" if sources:
            yield f"a part of demonstration {sources[0]}"


def _kept(shown: Demonstration, library: Library) -> int:
    """Count the first steps that it shares with the demonstration that it was made from."""
    source = library.entries[shown.of[0]].demonstration
    pairs = zip(shown.steps, source.steps, strict=False)
    return next(
        (n for n, (mine, theirs) in enumerate(pairs) if mine.id != theirs.id or not mine.id),
        min(len(shown.steps), len(source.steps)),
    )


def _course(activity: Activity, entry: LibraryEntry) -> Iterator[str]:
    """Say how it went: whether it came to an end, and what did not go as it was meant."""
    shown = entry.demonstration
    if not shown.finished:
        yield "not finished"
    elif shown.replayable and (ending := missed_end(activity, shown)):
        yield f"ended before “{activity.behaviour(ending).question}”"
    if entry.taken_back:
        yield f"{_counted(entry.taken_back, 'step')} taken back"
    failed = sum(not step.completed for step in shown.steps)
    if failed:
        yield f"{_counted(failed, 'step')} that could not be carried out"


def missed_end(activity: Activity, shown: Demonstration) -> str:
    """Return the behaviour that ends a game, where a demonstration never came to that stage; ""."""
    ends = {r.stage: r.behaviour for r in activity.stage_rules if r.condition == "after"}
    reached = {step.state.stage for step in shown.steps}
    return "" if reached.intersection(ends) else next(iter(ends.values()), None) or ""


def _answers(entry: LibraryEntry, library: Library, conflicts: Sequence[Conflict]) -> Iterator[str]:
    """Say where it gives another answer than itself, than others, and than a teacher."""
    shown = entry.demonstration
    if not entry.hidden:
        if not shown.finished:  # it is not learnt from yet, and so in none of the library's
            conflicts = find_conflicts([*library.finished, shown], library.resolutions)
        alone = find_conflicts([shown], library.resolutions)
        if alone:
            yield f"contradicts itself in {_counted(len(alone), 'situation')}"
        others = [found for c in conflicts if (found := _opponents(shown.id, c))]
        if others:
            numbers = sorted({library.number(id) for found in others for id in found})
            noun = "demonstration" if len(numbers) == 1 else "demonstrations"
            yield (
                f"disagrees with {noun} {_listed(numbers)} in {_counted(len(others), 'situation')}"
            )
    wrong = sum(any(r.sets_aside(step) for r in library.resolutions) for step in shown.steps)
    if wrong:
        yield f"{_counted(wrong, 'step')} called wrong by a teacher"


def _opponents(id: str, conflict: Conflict) -> set[str]:
    """Return the demonstrations that give an answer to a situation which this one does not."""
    mine = {b for b, steps in conflict.answers.items() if any(s.demonstration == id for s in steps)}
    if not mine:
        return set()
    theirs = (steps for b, steps in conflict.answers.items() if mine != {b})
    return {s.demonstration for steps in theirs for s in steps} - {id}


def _length(shown: Demonstration, library: Library) -> Iterator[str]:
    """Say that it took many more steps than games usually take."""
    usual = [len(d.steps) for d in library.finished if d.id != shown.id and d.replayable]
    if shown.replayable and len(usual) >= ENOUGH_TO_COMPARE:
        middle = median(usual)
        if len(shown.steps) > MUCH_LONGER * middle:
            yield f"much longer than usual ({middle:.0f} steps)"


def _counted(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def _listed(numbers: Iterable[int]) -> str:
    *most, last = map(str, numbers)
    return f"{', '.join(most)} and {last}" if most else last
