"""What a teacher at the lines is told: what a command needs, and what becomes of what was shown."""

from __future__ import annotations

from tangy_tui.text.numbers import counted

STOPPED = "STOP: the simulated robot stands still until your next command."
NOTHING_CHANGED = "You confirmed nothing, so nothing has changed."
ON_THE_SCREEN = "That works on the screen only: run tangy without --plain."
WHICH_STEP = "Say which step: `again 5` goes back to before step 5."


def learn_next(command: str) -> str:
    """Say which command learns from what was shown."""
    return f"Let Tangy learn from it with `{command}`."


def left_after(steps: int, command: str) -> str:
    """Say that what was confirmed is kept, and which command goes on from there."""
    return (
        f"You left after {counted(steps, 'step')}. What you confirmed is kept. "
        f"Go on from here with `{command}`."
    )


def next_or_quit(command: str) -> str:
    """Say what can be done after a demonstration; a command learns from it."""
    return f"Type next for another demonstration, or quit and run `{command}`."
