"""Runs the action of a key whose word was typed, or that was chosen in the palette."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen

ACTIONS = {"palette": "command_palette", "draw": "draw_again", "begin": "play"}
"""Textual's names of keymap actions, if they differ."""


async def perform(screen: Screen[Any], id: str, on: bool | None = None) -> None:
    """Run a keymap action on a screen; set a switch only if it is not already `on`."""
    app: Any = screen.app
    if id == "voice" and on is not None and app.speaker.on == on:
        return
    if id == "listen" and on is not None and (app.hearing is None or app.hearing.on == on):
        return
    await screen.run_action(f"app.{ACTIONS.get(id, id)}")
