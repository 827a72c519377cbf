"""Letters on the teaching screen go to the command bar, whatever has the focus."""

from __future__ import annotations

from typing import Any

from textual import events
from textual.screen import Screen

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.command_bar import CommandBar


def type_letter(
    screen: Screen[Any], event: events.Key | events.Paste, *, push_to_talk: bool
) -> bool:
    """Type a letter, or pasted text, into the bar; return False if it is a key."""
    bar = next(iter(screen.query(CommandBar)), None)
    if isinstance(event, events.Paste):
        lines = event.text.strip().splitlines()
        known = clean(lines[0]) if lines else None
    else:
        known = event.character if event.is_printable else None
    filtering = getattr(screen.focused, "filtering", False)
    if bar is None or known is None or filtering or bar.has_keys:
        return False
    if (
        known == ":"  # to type
        or (known == "?" and not bar.text)  # for help
        or (known == "t" and push_to_talk)  # to talk
    ):
        return False
    bar.type(known)
    return True
