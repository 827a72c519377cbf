"""What is said of a microphone: what is wrong with its sound, and what to do about it."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

if TYPE_CHECKING:
    from tangy_hw.audio.meter import SoundTrouble


def trouble_words(trouble: SoundTrouble) -> str:
    """Say in one line what is wrong with a sound."""
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
