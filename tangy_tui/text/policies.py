"""Words for policies: stored ones, changed ones, and comparisons."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from tangy_profiles.reading import plain
from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_tui.learning.policies import LeftOut, PolicyNotice

NOTHING_LEARNT = "Nothing learnt yet."
NOW_PLAY = "Press {begin} to see Tangy run a game by this; esc goes back to teach more."
PLAY_BY_THIS = "Let Tangy run a game by this"
PLAY_NOW = "Let Tangy run a game in the simulated room?"
PLAY_DETAIL = "It follows this table, and asks you where nothing was shown."
NOT_AS_KEPT = "The policy differs from the one that was kept"
SAME_DECISIONS = "It decides the same everywhere; only the votes differ."
OTHER_DECISIONS = "What has changed"


def change_words(before: str, after: str) -> str:
    """Name the behaviour in a situation, now and before."""
    return f"was {before}, is now {after}"


NOTHING_TO_COMPARE = "Nothing to compare"
ONE_POLICY = (
    "There are no two policies yet: learn again after another demonstration, or let another "
    "person teach."
)
WHICH = "Which policy do you want to see?"
ALL_THE_SAME = "Both do the same in every situation; {differences} shows all rows."


def compared_words(differ: int, situations: int) -> str:
    """Tell in how many situations two policies differ."""
    count = counted(situations, "situation")
    return f"They differ in {differ} of {count}." if differ else f"They agree in all {count}."


def left_out_words(step: LeftOut) -> str:
    """Name a step left out of learning, because the activity does not define it."""
    where = f"{' / '.join(step.situation)} -> {step.behaviour}"
    of = step.demonstration
    return plain(f"Step {step.number} of {of} is left out: {step.activity} has no {where}.")


def notice_words(notices: Iterable[PolicyNotice]) -> list[str]:
    """Return the notices about a policy before it is used, a sentence each."""
    return [line for notice in notices for line in _notice(notice)]


def _notice(notice: PolicyNotice) -> Iterator[str]:
    from tangy_tui.learning.policies import LeftOut

    if isinstance(notice, LeftOut):
        yield left_out_words(notice)
        return
    moved = ", ".join(f"{part} {was} -> {now}" for part, was, now in notice.versions)
    why = moved or "its demonstrations have changed since"
    yield f"The policy {notice.policy!r} is not the one that was kept ({why})."
    if not notice.changes:
        yield SAME_DECISIONS
    for change in notice.changes:
        yield f"{' / '.join(change.situation)}: {change_words(change.before, change.after)}."
    yield "Look at it with `tangy policy`, and keep it with `tangy learn`."
