"""Doing what a key does because its word was typed, or was chosen in the palette."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen

ACTIONS = {"palette": "command_palette", "draw": "draw_again", "begin": "play"}
"""What Textual calls an action of the keymap, where that is something else."""


async def perform(screen: Screen[Any], id: str, on: bool | None = None) -> None:
    """Do an action of the keymap on a screen; of a switch, only where it is not so already."""
    app: Any = screen.app
    if id == "voice" and on is not None and app.speaker.on == on:
        return
    if id == "listen" and on is not None and (app.hearing is None or app.hearing.on == on):
        return
    await screen.run_action(f"app.{ACTIONS.get(id, id)}")
