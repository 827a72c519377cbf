"""Words for injecting faults in the simulated room."""

from __future__ import annotations

import re

from tangy_sim.worlds.injection import KINDS

WHICH = "What should go wrong?"
NONE_FOUND = "Nothing matches these letters."

NOT_SIMULATED = "You can bring about faults in the simulated room only."
NO_GAME = "No game is going on: press {next} to play one first."


def happens_words(injected: str) -> str:
    """Tell what happens in the room by an injected fault of the log, or by several planned ones.

    Words that name no kind of fault stay as they are, such as those of an earlier version.
    """
    told = []
    for one in injected.split(", "):
        kind = KINDS.get(re.split("[@~]", one)[0])
        told.append(one if kind is None else kind.words)
    return ", ".join(told)


def not_of_this_robot(kind: str, robot: str) -> str:
    """Tell that a fault belongs to a device that a robot does not have."""
    return f"--inject {kind}: {robot} has no device that this could happen to."


def comes_later_words(kind: str) -> str:
    """Tell that a fault will become visible later."""
    return f"This comes as soon as it can show: {happens_words(kind)}."


def lifted_words(kind: str) -> str:
    """Tell that a fault was lifted."""
    return f"Lifted: {happens_words(kind)}."


def injected_words(kind: str) -> str:
    """Tell that a fault was injected."""
    return f"Brought about: {happens_words(kind)}."
