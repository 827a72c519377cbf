"""Words for forgetting a person: which data goes, and which stays."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tangy_tui.text.numbers import counted, listed

if TYPE_CHECKING:
    from tangy_profiles.person import Person
    from tangy_tui.interaction.forgetting import Forgotten


def what_goes(person: Person, folder: Path) -> str:
    """Tell before a person is forgotten which data is deleted, and which stays."""
    called = person.name if person.name == person.id else f"{person.name} ({person.id})"
    return (
        f"This deletes who {called} is: the name, how it is said, their voice and their face. "
        f"{person.id} replaces the name where it was typed or said, and in files that Tangy "
        f"wrote in {folder}. "
        f"What worked with them is kept for {person.id}. This cannot be taken back."
    )


def not_forgotten(person: Person) -> str:
    """Tell that nothing was forgotten."""
    return f"Nothing was forgotten. Tangy knows {person.name} as before."


def forgotten_lines(person: Person, forgotten: Forgotten) -> list[str]:
    """Tell what was deleted, and where the name remains."""
    lines = [f"{person.id}: the name, how it is said, the voice and the face are forgotten."]
    changed = []
    if forgotten.events:
        changed.append(counted(forgotten.events, "entry of the log", "entries of the log"))
    if forgotten.files:
        changed.append(counted(len(forgotten.files), "file"))
    if changed:
        there = listed(changed)
        lines.append(f"{person.id} replaces the name in {there}.")
    if forgotten.events_left:
        entries = counted(forgotten.events_left, "entry", "entries")
        lines.append(f"The name stays in {entries} of the log, as a teacher's name.")
    lines += [f"Check this file yourself: {path}" for path in forgotten.files_left]
    return lines
