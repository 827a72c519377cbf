"""Words for what people did when they were asked, in reports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from tangy_profiles.activity import Activity
from tangy_tui.monitoring.people_progress import RESULTS, Attempts, MethodProgress, Progress
from tangy_tui.text.numbers import listed, often

RESULT_WORDS: Mapping[str, str] = {
    "complied": "did it",
    "late": "did it late",
    "refused": "would rather not",
    "void": "does not count",
    "awaited": "answer not known",
}
"""The outcomes of a request (`RESULTS`), for columns and marks."""

BY_METHOD = (
    "These activities choose among the ways of asking by methods of their own, so each has "
    "expectations of its own. What a person did counts in all of them."
)


def result_words(every: Iterable[Attempts]) -> str:
    """Tell how often each outcome occurred: "did it twice, would rather not once"."""
    counts = dict.fromkeys(RESULTS, 0)
    for one in every:
        for what in RESULTS:
            counts[what] += getattr(one, what)
    return ", ".join(f"{RESULT_WORDS[what]} {often(n)}" for what, n in counts.items() if n)


def asked_words(methods: Sequence[MethodProgress]) -> str:
    """Tell how often a person was asked by some methods, and their responses."""
    every = [one for method in methods for one in method.strategies.values()]
    return f"Asked {often(sum(one.used for one in every))}: {result_words(every)}."


def progress_line(person: Progress) -> str:
    """Tell how often a person was asked, and with each strategy their responses and beliefs."""
    parts = []
    for method in person.methods:
        where = method_words(person, method)
        for strategy, one in method.strategies.items():
            if one.used:
                expected = f"expected {one.before.mean:.0%} before, {one.after.mean:.0%} after"
                asked = f"{strategy}{f' ({where})' if where else ''}"
                parts.append(f"{asked}: {result_words([one])} ({expected})")
    return f"{person.name} was asked {often(person.interactions)}: {'; '.join(parts)}"


def response_line(person: Progress, activities: Iterable[Activity]) -> str:
    """Tell staff what a person did when asked, and how Tangy asked: in words, without numbers."""
    ways = {name: words for one in activities for name, words in ways_of(one)}
    parts = [
        f"{result_words([one])} ({ways.get(strategy, f'Tangy used {strategy}')})"
        for strategy, one in person.strategies.items()
        if one.used
    ]
    return f"{person.name}: {'; '.join(parts)}"


def ways_of(activity: Activity) -> Iterator[tuple[str, str]]:
    """Yield the ways of asking of an activity with their words for staff."""
    for name, words in activity.strategies.items():
        yield name, f"Tangy {words}"


def method_words(person: Progress, method: MethodProgress) -> str:
    """Name the activities of a method if there are several; "" if there is only one."""
    return listed(method.activities) if len(person.methods) > 1 else ""
