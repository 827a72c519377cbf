"""Words for a teacher in line mode: commands, and what happens to demonstrations."""

from __future__ import annotations

import shlex

from tangy_profiles.reading import plain
from tangy_tui.text.numbers import counted

HELP = (
    "Type what Tangy should do (the first letters are enough), or one of: undo, redo, again N, "
    "where, seen, why, help, next, learn, play, quit. Enter alone lists what can be said now."
)
NOT_GUIDED = (
    "This game is not guided: type guided for one in which everything comes up that Tangy has to "
    "learn."
)
GUIDED_ALREADY = "This game is guided: everything that Tangy has to learn comes up in it."
NOTHING_FITS = "No command fits. Empty the line and press Tab to see what you can say."
MEANINGS = (
    ("undo", "take the last step back"),
    ("redo", "redo the step you took back"),
    ("again N", "go back before step N, to show it and what follows again"),
    ("where", "say what Tangy sees"),
    ("seen", "say which situations nobody has shown yet"),
    ("why", "say what Tangy would do here by what it has learnt, and why"),
    ("next", "begin another game"),
    ("guided", "begin a game in which everything comes up that Tangy has to learn"),
    ("learn", "let Tangy learn from the games that were shown to their end"),
    ("play", "leave, and see Tangy run a game in the simulated room"),
    ("discard game", "put this game away, and begin another"),
    ("my name is ROSA", "change your name"),
    ("quit", "leave; what you confirmed is kept"),
)
"""Commands in line mode besides behaviours, with their meanings."""

STOPPED = "STOP: the simulated robot stands still until your next command."
NOTHING_CHANGED = "You confirmed nothing, so nothing has changed."
ON_THE_SCREEN = "That works on the screen only: run tangy without --plain."
GAME_OVER = (
    "Type next for another game, learn to let Tangy learn from this one, play to see Tangy run a "
    "game, or quit."
)
NOW_PLAY = "Type play to see Tangy run a game, next to show it another one, or quit."
WHICH_STEP = "Say which step: `again 5` goes back to before step 5."


def learn_next(command: str) -> str:
    """Name the command that learns from the demonstrations."""
    return f"Let Tangy learn from it with `{command}`."


def left_after(steps: int, command: str) -> str:
    """Tell that confirmed steps are stored, and which command continues."""
    return (
        f"You left after {counted(steps, 'step')}. What you confirmed is kept. "
        f"Go on from here with `{command}`."
    )


def command_line(verb: str, **options: str | None) -> str:
    """Format a command line, with the options that have a value."""
    given = [f"--{name} {shlex.quote(value)}" for name, value in options.items() if value]
    return plain(" ".join(["tangy", verb, *given]))
