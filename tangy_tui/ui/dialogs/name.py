"""The dialog that asks for a name."""

from __future__ import annotations

from typing import ClassVar

from textual.binding import Binding, BindingType

from tangy_profiles.person import LONGEST_NAME
from tangy_tui.app.teacher_profile import checked
from tangy_tui.text.who import NAME_KEYS, WHO, WHO_DETAIL
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.line import LineDialog
from tangy_tui.ui.type_ahead_guard import Clock


class NameDialog(LineDialog[str]):
    """Asks for a name; Enter accepts the line, esc closes."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "leave", "Not now", priority=True)]
    HELP = "Type the name under which Tangy keeps what you show, and press Enter. Esc: not now."

    def __init__(
        self,
        suggested: str,
        title: str = WHO,
        detail: str = WHO_DETAIL,
        *,
        unasked: bool = False,
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog; `suggested` is the initial text, selected; others: as in the base."""
        super().__init__(
            clean(title),
            detail,
            NAME_KEYS,
            begun=clean(suggested),
            selected=True,
            longest=LONGEST_NAME,
            unasked=unasked,
            clock=clock,
        )

    def taken(self, line: str) -> str:
        """Return the name; raises TangyError if it is not valid."""
        return checked(line)
