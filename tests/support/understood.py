"""The meaning of recognised words."""

from __future__ import annotations

from tangy_tui.learning.verification import Say, StopCommand


def behaviour_of(said: Say | StopCommand) -> str | None:
    """Return the behaviour that Tangy would ask about; None if there is none."""
    if isinstance(said, StopCommand) or not said.commands or not said.sure:
        return None
    return said.commands[0].behaviour
