"""Words about a session in the log: the limits of its report, and how faults ended."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, assert_never

from tangy_profiles.reading import plain
from tangy_tui.text.endings import ending_words
from tangy_tui.text.injections import happens_words

if TYPE_CHECKING:
    from tangy_tui.monitoring.fault import FaultStatus
    from tangy_tui.monitoring.session import Session, SessionNote


def status_words(status: FaultStatus) -> str:
    """Tell how a fault ended."""
    match status:
        case "open":
            return "left open"
        case "borne":
            return "Tangy goes on with it"
        case "over":
            return "over"
        case forgotten:
            assert_never(forgotten)


def note_words(note: SessionNote) -> str:
    """Tell which details a report lacks, or which of its events were injected."""
    match note.kind:
        case "unknown activity":
            return unknown_words(note.about)
        case "no times":
            return "An older Tangy kept no times within a game: those games are drawn by steps."
        case "brought about":
            words = dict.fromkeys(map(happens_words, note.about.split("; ")))
            return f"Some faults were brought about on purpose: {'; '.join(words)}."
        case forgotten:
            assert_never(forgotten)


def unknown_words(activity: str) -> str:
    """Tell that an activity is unknown, and which details are therefore missing."""
    return plain(
        f"Tangy cannot find the file of the activity {activity!r}: name it with --activity. "
        "Without it, Tangy leaves out what it said, and counts each behaviour that it could carry "
        "out as a success."
    )


def session_document(session: Session) -> dict[str, Any]:
    """Return a session as one JSON document, with its notes in words."""
    told = session.to_json()
    for game, document in zip(session.games, told["games"], strict=True):
        document["ending"] = ending_words(game)
    return {**told, "notes": [note_words(note) for note in session.notes]}
