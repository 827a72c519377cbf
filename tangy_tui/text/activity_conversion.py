"""Words for a converted activity file: its new keys, and what an author can add."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_tui.text.numbers import listed

COMMENTS = {
    "pressing_strategies": "those not used again in a visit in which the person refused",
    "asks_in_visit": "requests in vain, one after another, before Tangy leaves a person in peace",
    "asks_in_game": "the same in a whole game",
}
"""The comment beside each key that a conversion writes."""

CAN_ADD = {
    "summary": "for how many people it is, how long it takes and what they need",
    "patterns": "what wins, for staff to choose",
    "strengths": "how strongly Tangy may speak, for staff to choose",
    "rules": "claims, numbers taken back, and visits to people who do not ask",
    "now": "what is going on, for teachers and staff",
    "wordings": "other ways to ask for a behaviour",
}
"""What an author gains by each key that has no default."""


def converted_lines(file: str, new: str, added: Sequence[str], lacks: Sequence[str]) -> list[str]:
    """Tell what a conversion wrote, and what the author can add.

    Args:
        file: the file that was read.
        new: the file that was written ("": none was needed).
        added: the keys that it has now.
        lacks: the keys that it could have.
    """
    keys = listed(added)
    told = [f"{file} is up to date: nothing is written."]
    if added:
        told = [f"Written: {new}. Its games stay the same. It now has {keys}: change their values."]
    if lacks:
        told.append("You can also add these keys (see CONTRIBUTING.md):")
        told += [f"  {key}: {CAN_ADD[key]}" for key in lacks]
    return told


def no_toml_name(file: str) -> str:
    """Refuse the name of a new file, which Tangy would not open as an activity."""
    return f"{file}: the name of an activity's file must end in .toml. Nothing is written."


def is_no_activity(file: str) -> str:
    """Refuse a file that is no TOML, and tell how to use a file of questions."""
    return (
        f"{file} is no activity: its name must end in .toml. "
        f'Make one from questions with: tangy activity import {file} --title "..."'
    )
