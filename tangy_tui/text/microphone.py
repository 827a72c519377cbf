"""Words for faults of a microphone's sound, and how to fix them."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

if TYPE_CHECKING:
    from tangy_hw.audio.meter import SoundTrouble


def trouble_words(trouble: SoundTrouble) -> str:
    """Describe a fault of the sound in one line."""
    match trouble.kind:
        case "nothing comes":
            return f"The microphone has sent nothing for {trouble.seconds} s: is it connected?"
        case "no sound":
            return (
                f"No sound for {trouble.seconds} s: is the microphone plugged in? It may be muted."
            )
        case "too loud":
            return "Too loud: move a little away from the microphone, or turn it down."
        case "very quiet":
            return "Very quiet: move closer to the microphone, or turn it up."
        case forgotten:
            assert_never(forgotten)
