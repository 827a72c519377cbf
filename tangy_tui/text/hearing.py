"""Words about speech input: what it cannot hear, and what it records."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, assert_never

if TYPE_CHECKING:
    from tangy_tui.speech.hearing_notes import HearingNote

AGAIN_SOON = "Push again in a moment."
ANSWERS_NEED_SCREEN = "--mic: Tangy listens to answers on the screen; here they are typed."
LISTENING_NEEDS_SCREEN = "--mic: Tangy listens in a live game on the screen; there is none here."
NOTHING_ASKED = "I heard yes or no, but there is no question."
SAID_TOO_EARLY = "You said that before the question was on the screen."


def hearing_words(note: HearingNote) -> str:
    """Describe a note about speech input in a sentence."""
    from tangy_tui.speech.evidence import LONGEST

    about = note.about
    match note.kind:
        case "getting ready":
            return f"Tangy is getting ready to listen. {AGAIN_SOON}"
        case "still thinking":
            return f"Tangy is still thinking. {AGAIN_SOON}"
        case "records":
            return "Tangy records each command that you say yes to."
        case "records no more":
            return f"Nothing more is recorded: {about}."
        case "recording over":
            return "The recording is over."
        case "microphone closed":
            return "The microphone has closed."
        case "cut off":
            return f"You spoke for {note.seconds} s without a pause. I hear the first {LONGEST} s."
        case "not decoded":
            return f"{about} Please say that again."
        case "decoder failed" | "source":
            return about
        case "question between":
            return f"I heard {about!r}, but a question came between."
        case "no words":
            return "I heard something, but no words that I know."
        case "no answer":
            return "I heard something, but no yes, no or stop."
        case "word not heard":
            unknown = "the activity does not say how it is pronounced (tangy activity check)"
            return _only_typed(about, unknown)
        case "name not heard":
            return _only_typed(
                about, f"say how it is pronounced (tangy people pronounce {note.other})"
            )
        case "phrase not heard":
            return _only_typed(about, f"it sounds like {note.other!r}")
        case "worker ended":
            return f"Listening stopped by itself ({about}). Tangy starts it again."
        case forgotten:
            assert_never(forgotten)


def _only_typed(about: str, why: str) -> str:
    return f"{about!r} can be typed, but not heard: {why}."


def consent_question(folder: Path, options: str = "") -> str:
    """Return the question to a teacher before anything is recorded.

    Args:
        folder: where recordings are stored.
        options: options of the command that deletes them, with a space before them.
    """
    return (
        "May Tangy keep recordings of the commands that you say and confirm while you teach, to "
        f"practise on? They stay on this machine, in {folder}; "
        f"`tangy listen --forget-recordings{options}` deletes them all."
    )
