"""Words for known faces: consent, enrolment, and forgetting."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_profiles.person import Person

NO_FACES = "Tangy knows no faces yet. Add one: tangy faces enrol NAME --from CAMERA or a folder."


def consent_question(name: str, folder: Path) -> str:
    """Ask a person whether Tangy may know their face."""
    return (
        f"{name}, may Tangy know your face? It keeps measurements, no pictures, on "
        f"this machine, in {folder}. `tangy faces forget` deletes them at any time."
    )


def enrolled_lines(
    person: Person, *, new: bool, taken: int, advised: int, several: bool, like: str
) -> list[str]:
    """Count the pictures of a person, and name the doubtful ones.

    Args:
        person: the person with the face.
        new: whether they were added as a guest just now.
        taken: the number of pictures used.
        advised: the recommended number of pictures.
        several: whether the pictures may show more than one person.
        like: a known person they resemble, by name and id; "" for nobody.
    """
    lines = []
    if new:
        lines.append(f"{person.name} is a guest, with the id {person.id}.")
    few = f". With {advised} Tangy is surer" if taken < advised else ""
    lines.append(f"Tangy knows {person.name} from {counted(taken, 'picture')}{few}.")
    if several:
        lines.append(
            "The pictures may show more than one person: check them. `tangy faces forget "
            f"{person.id}` deletes these measurements."
        )
    if like:
        lines.append(f"The pictures also look like {like}.")
    return lines


def face_forgotten(name: str, kept: bool) -> str:
    """Tell that a face was forgotten, or that there was none."""
    if kept:
        return f"{name}'s face is forgotten."
    return f"Tangy did not know {name}'s face."
