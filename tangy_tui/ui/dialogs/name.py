"""Asking the teacher's name."""

from __future__ import annotations

from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tangy_profiles.errors import TangyError
from tangy_profiles.person import LONGEST_NAME
from tangy_tui.app.teacher_profile import checked
from tangy_tui.text.who import NAME_KEYS, WHO, WHO_DETAIL
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean


class NameDialog(Dialog[str | None]):
    """Asks for a name; Enter takes what stands in the line, esc leaves it for another time."""

    DEFAULT_CSS = """
    NameDialog Input { margin: 1 0 0 0; }
    NameDialog .wrong { color: $warning; height: auto; display: none; }
    NameDialog .wrong.-shown { display: block; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "later", "Not now", priority=True)]
    HELP = "Type the name under which Tangy keeps what you show, and press Enter. Esc: not now."

    def __init__(self, suggested: str) -> None:
        """Make the dialog; `suggested` stands in the line, selected."""
        super().__init__(None)
        self._suggested = clean(suggested)

    def compose(self) -> ComposeResult:
        """Lay out the question and the line."""
        line = Input(self._suggested, max_length=LONGEST_NAME, select_on_focus=True, id="name")
        line.cursor_blink = False
        box = Vertical(
            Static(WHO_DETAIL, markup=False),
            line,
            Static("", classes="wrong", markup=False),
            id="who",
            classes="box",
        )
        box.border_title = Content(WHO)
        box.border_subtitle = NAME_KEYS
        yield box

    def on_mount(self) -> None:
        """Let the name be typed."""
        self.query_one(Input).focus()

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Take the name, if it is one that may be kept."""
        event.stop()
        try:
            name = checked(event.value)
        except TangyError as error:
            wrong = self.query_one(".wrong", Static)
            wrong.update(str(error))
            wrong.add_class("-shown")
        else:
            self.answer(name)

    def on_key(self, event: events.Key) -> None:
        """Let letters be letters: none is a key here."""
        if event.is_printable:
            event.stop()

    def action_later(self) -> None:
        """Leave it for another time."""
        self.answer(None)
