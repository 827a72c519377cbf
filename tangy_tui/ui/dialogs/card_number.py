"""The dialog that asks for the number of a person's card."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_profiles.errors import TangyError
from tangy_tui.text.cards import NO_NUMBER, NUMBER_DETAIL, NUMBER_HELP, NUMBER_KEYS, which_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.line import LineDialog

LONGEST_NUMBER = 6  # digits


class CardNumberDialog(LineDialog[int]):
    """Asks which card a person has; Enter takes the number, esc closes."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Not now", priority=True)]
    HELP = NUMBER_HELP

    def __init__(self, name: str) -> None:
        super().__init__(
            clean(which_words(name)), NUMBER_DETAIL, NUMBER_KEYS, longest=LONGEST_NUMBER
        )

    def taken(self, line: str) -> int:
        """Return the number; raises TangyError if it is none."""
        digits = line.strip().lstrip("#")
        if not (digits.isascii() and digits.isdecimal()):
            raise TangyError(NO_NUMBER)
        return int(digits)
