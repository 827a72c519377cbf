"""Settles conflicts between demonstrations in the console, one question after another."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from tangy_tui.text.conflicts import LEFT_OPEN, WHICH_IS_RIGHT, how_to_settle

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.conflicts import Conflict

Read = Callable[[], str | None]
Write = Callable[[str], None]


def settle_conflicts(workspace: Workspace, read: Read, write: Write) -> None:
    """Ask which answer is right in each conflict; at the end of the input the rest stay open.

    Args:
        workspace: the workspace of the demonstrations.
        read: returns the next line, None at the end.
        write: writes a line.
    """
    from tangy_tui.learning.editing import Editor
    from tangy_tui.learning.library import read_library
    from tangy_tui.text.situations import conflict_lines

    library = read_library(workspace.store, workspace.activity.name)
    editor = Editor(workspace.store, workspace.activity)
    for conflict in library.conflicts:
        for line in conflict_lines(workspace.activity, library, conflict):
            write(line)
        right = _asked(conflict, read, write)
        if right is None:
            return
        if right:
            editor.resolve(conflict, *right)
        else:
            write(LEFT_OPEN)


def _asked(conflict: Conflict, read: Read, write: Write) -> list[str] | None:
    """Return the right answers, none if they stay open; None at the end of the input."""
    answers = list(conflict.answers)
    write(WHICH_IS_RIGHT)
    while (said := read()) is not None:
        word = " ".join(said.split()).casefold()
        if word in ("", "later"):
            return []
        if word == "b":
            return answers
        if word.isdecimal() and 1 <= int(word) <= len(answers):
            return [answers[int(word) - 1]]
        if word in answers:
            return [word]
        write(how_to_settle(len(answers)))
    return None
