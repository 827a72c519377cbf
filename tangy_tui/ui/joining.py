"""Dialogs about a person who joins the group, or gets a new name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from textual.app import App

from tangy_tui.text import set_up as text
from tangy_tui.text.joining import WHERE, beside_words
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.name import NameDialog


async def ask_who_joins(app: App[Any]) -> tuple[str, bool] | None:
    """Ask who joins; return the name, and whether as a guest; None: nobody does."""
    name = await app.push_screen_wait(NameDialog("", text.ADD, text.NAME_DETAIL))
    if not name:
        return None
    options = [
        Option("for good", text.FOR_GOOD, text.FOR_GOOD_NOTE),
        Option("guest", text.TODAY, text.TODAY_NOTE),
    ]
    chosen = await app.push_screen_wait(ChooseDialog(text.ADD_GUEST.format(name), options))
    return None if chosen is None else (name, chosen == "guest")


async def ask_where(
    app: App[Any], name: str, seats: Mapping[int, Sequence[str]], word: str
) -> int | None:
    """Ask on which seat a new person sits; None: nobody joins.

    Args:
        app: the program.
        name: the person's name.
        seats: the seats to choose from (from 1), each with the names of the neighbours.
        word: the word for a seat.
    """
    options = [
        Option(str(seat), f"{word} {seat}", beside_words(beside)) for seat, beside in seats.items()
    ]
    dialog = ChooseDialog(WHERE.format(name), options[::-1])  # the last seat is the usual one
    chosen = await app.push_screen_wait(dialog)
    return None if chosen is None else int(chosen)


async def ask_new_name(app: App[Any], name: str) -> str | None:
    """Ask for a person's new name; None leaves it unchanged."""
    dialog = NameDialog(name, text.RENAME.format(name), text.NAME_DETAIL)
    wanted = await app.push_screen_wait(dialog)
    return None if wanted in (None, name) else wanted


async def ask_who_is_on_duty(app: App[Any], name: str) -> str | None:
    """Ask who is on duty; None leaves it unchanged."""
    return await app.push_screen_wait(NameDialog(name, text.WHO_IS_ON_DUTY, text.DUTY_DETAIL))
