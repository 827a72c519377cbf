"""What was understood of spoken words."""

from __future__ import annotations

from tangy_tui.learning.verification import Say, StopCommand


def behaviour_of(said: Say | StopCommand) -> str | None:
    """Return the behaviour that would be asked about; None if none would."""
    if isinstance(said, StopCommand) or not said.commands or not said.sure:
        return None
    return said.commands[0].behaviour
