"""Words for the quality notes of demonstrations, a few each."""

from __future__ import annotations

from collections.abc import Iterable
from typing import assert_never

from tangy_tui.learning.quality import QualityNote
from tangy_tui.text.numbers import counted, listed


def quality_words(notes: Iterable[QualityNote]) -> list[str]:
    """Return the words of some notes."""
    return [_words(note) for note in notes]


def _words(note: QualityNote) -> str:
    others = listed(note.demonstrations)
    match note.kind:
        case "asked":
            return "answered in a game"
        case "again":
            return f"shown again from step {note.count} of demonstration {others}"
        case "merged":
            return f"merged from demonstrations {others}"
        case "split":
            return f"a part of demonstration {others}"
        case "not finished":
            return "not finished"
        case "ended early":
            return f"ended before “{note.due}”"
        case "taken back":
            return f"{counted(note.count, 'step')} taken back"
        case "failed":
            return f"{counted(note.count, 'step')} that could not be carried out"
        case "contradicts itself":
            return f"contradicts itself in {counted(note.count, 'situation')}"
        case "disagrees":
            noun = "demonstration" if len(note.demonstrations) == 1 else "demonstrations"
            return f"disagrees with {noun} {others} in {counted(note.count, 'situation')}"
        case "called wrong":
            return f"{counted(note.count, 'step')} called wrong by a teacher"
        case "long":
            return f"much longer than usual ({note.count} steps)"
        case forgotten:
            assert_never(forgotten)
