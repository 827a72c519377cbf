"""Words for what became of a report of staff about a person."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_tui.app.staff_notes import StaffNote


def player_report_words(noted: StaffNote, name: str) -> str:
    """Tell what became of a report about a person, by name ("" for the group)."""
    whose = f"{name}: " if name else ""
    match noted.kind:
        case "told right" | "told wrong":
            judged = noted.kind.removeprefix("told ")
            if not noted.words:
                return f"{whose}{judged}." if name else f"Noted: {judged}."
            return f"{whose}{noted.words}. That counts as {judged}."
        case "told unclear":
            again = f" Tangy asks {name} again." if name else ""
            return f"{whose}{noted.words}, but you are not sure.{again}"
        case "not told":
            counts = f" These do: {noted.words}." if noted.words else ""
            return f"That does not count in this game.{counts}"
        case "not asked":
            asked = f"Tangy is not asking {name} now" if name else "Tangy asks nothing now"
            return f"{asked}, so this does not count: {noted.words}."
        case "whose":
            return f"Who is it? Begin with the name, for example {name}: {noted.words}"
        case _:
            return f"{whose}{noted.words}. Noted." if name else f"Noted: {noted.words}."
