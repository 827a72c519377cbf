"""The demo in the console: the frames of its story, each with caption and events."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tangy_tui.app.workspace import Workspace
from tangy_tui.console.story import Story
from tangy_tui.text import demo as text
from tangy_tui.text.command_line import TEACH_YOURSELF


def tell(workspace: Workspace, seed: int, write: Callable[[str], None]) -> dict[str, Any]:
    """Write the story line by line; return the totals of its game."""
    story = Story(workspace, seed)
    scene, caption, asked = 0, "", ""
    for frame in story.frames():
        if frame.scene != scene:
            write(text.scene_words(frame.scene))
        scene = frame.scene
        if frame.caption != caption:
            write(f"  {frame.caption}")
        caption = frame.caption
        if frame.typed and not frame.asked:
            write(f"    {text.typed_words(frame.typed)}")
        if frame.asked and frame.asked != asked:
            write(f"    {text.asked_words(frame.asked)}")
        asked = frame.asked
        for line in frame.lines[len(frame.lines) - frame.new :]:
            write(f"    {line}")
    write(TEACH_YOURSELF)
    return story.tally.to_json(workspace.activity.situations, story.beliefs)
