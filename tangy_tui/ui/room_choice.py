"""The dialog to choose a room."""

from __future__ import annotations

from collections.abc import Iterable

from textual.app import App

from tangy_tui.app.rooms import KnownRoom
from tangy_tui.text.rooms import CHOOSE_ROOM, places_words
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option


async def ask_room(app: App[object], rooms: Iterable[KnownRoom]) -> str | None:
    """Return the source of the chosen room, None if none was chosen."""
    options = [
        Option(one.source, one.source if one.room is None else one.room.title,
               one.problem if one.room is None else places_words(one.room))
        for one in rooms
    ]  # fmt: skip
    return await app.push_screen_wait(ChooseDialog(CHOOSE_ROOM, options))
