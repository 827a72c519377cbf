"""Words for demonstrations: their list, and the effects of changes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tangy_tui.learning.demonstration_rows import UNFINISHED, ListRow
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.quality import quality_words

LIST_HELP = (
    "One line for each demonstration: its number, who showed it and when, how many steps "
    "it has, how many of the situations it shows, and whether Tangy learns from it."
)
NONE_TO_LIST = "No demonstrations yet: choose Teach at home to show Tangy a game."

NO_STEPS = "It has no steps."
NOTHING_LOST = "Nothing is lost: {undo} takes it back."
NOT_LEARNT = "no: a teacher called this step wrong"
AGAIN_DETAIL = (
    "The steps before it stay as they are. The old demonstration is replaced only when you have "
    "shown the game to its end."
)
MARK_FIRST = "Mark two or more with {mark} first, and then merge them with {merge}."
CHOOSE_LAST = "Choose the step that ends the first part: tab goes to the steps."
CHOOSE_FIRST = "Choose the step to begin with: tab goes to the steps."


def again_words(name: str, step: int) -> str:
    """Ask before a demonstration is repeated from a step."""
    return f"Show {name} again from step {step}?"


def delete_words(row: ListRow) -> tuple[str, str]:
    """Ask before a demonstration is deleted, and explain the effect."""
    detail = f"Tangy will not learn from its {counted(row.steps, 'step')}. {NOTHING_LOST}"
    return f"Delete demonstration {row.number} by {row.teacher}?", detail


def merge_words(rows: Sequence[ListRow]) -> tuple[str, str]:
    """Ask before demonstrations are merged, and explain the effect."""
    names = listed(row.number for row in rows)
    steps = sum(row.steps for row in rows)
    detail = f"They become one of {counted(steps, 'step')}, in this order. {NOTHING_LOST}"
    return f"Merge demonstrations {names}?", detail


def split_words(row: ListRow, step: int) -> tuple[str, str]:
    """Ask before a demonstration is split after a step, and explain the effect."""
    return (
        f"Split demonstration {row.number} after step {step}?",
        f"It becomes two: one of {counted(step, 'step')}, one of {row.steps - step}. "
        f"{NOTHING_LOST}",
    )


def nothing_after_words(step: int) -> str:
    """Tell that a demonstration cannot be split after its last step."""
    return f"Nothing comes after step {step}: choose one before it."


def refused_words(row: ListRow) -> str:
    """Tell why a demonstration cannot be merged or split."""
    why = "not finished yet" if row.state == UNFINISHED else f"not in use: {row.state}"
    return f"Demonstration {row.number} by {row.teacher} is {why}."


def changed_words(change: str, before: str = "") -> str:
    """Describe the effect of a change, after its name, or with how to undo it."""
    return f"{before}: {change}" if before else f"{change} {{undo}} takes it back."


def steps_title(number: int) -> str:
    """Return the heading of a demonstration's steps."""
    return f"Steps of demonstration {number}"


NONE_YET = "There are no demonstrations yet: begin with `tangy teach`."


def row_document(row: ListRow) -> dict[str, Any]:
    """Return a row of the list as JSON, with its notes in words."""
    return {**row.to_json(), "notes": quality_words(row.notes)}
