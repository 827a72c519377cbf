"""The pronunciation of a person's name: listen, accept the suggestion, or edit it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Input, Static

from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_tui.app.keymap import is_letter
from tangy_tui.language.name_pronunciation import how_said
from tangy_tui.language.pronunciation import check_name
from tangy_tui.text.names import said_words
from tangy_tui.text.voice import SOUNDS_HELP, said_title
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys

LONGEST = 200


@dataclass(frozen=True, slots=True)
class NewPronunciation:
    """The new pronunciation; None removes it."""

    phones: str | None


ACTIONS = {"enter": "submit", "escape": "screen.leave"}


class PhonesInput(Input):
    """The input line for phones; Enter counts once the dialog is visible."""

    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("hear", "screen.hear"),
        Binding("enter", "submit", "Note it"),
        Binding("escape", "screen.leave", "Leave it as it is"),
    ]

    def __init__(self, phones: str) -> None:
        super().__init__(phones, max_length=LONGEST, compact=True, select_on_focus=False)
        self.cursor_blink = False
        self.keys = FreshKeys()

    async def _on_key(self, event: events.Key) -> None:
        hears = keymap_of(self.app).action(event.key) == "hear" and not is_letter(event.key)
        if hears or event.key in ("enter", "escape"):
            event.prevent_default()
            if self.keys.take(event):
                action = "screen.hear" if hears else ACTIONS[event.key]
                await self.run_action(action)
        else:
            await super()._on_key(event)


class PronunciationDialog(Dialog[NewPronunciation | None]):
    """Shows the present or suggested pronunciation of a name; Enter stores the line."""

    HELP = (
        "{hear} says what stands in the line. Enter notes it for this person, and what you say "
        "to Tangy with this name is heard from then on. " + SOUNDS_HELP
    )

    def __init__(
        self,
        person: Person,
        hear: Callable[[str], object],
        check: Callable[[Person, str], object],
        *,
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            person: the person with the name.
            hear: speaks phones aloud.
            check: raises a `TangyError` if the pronunciation could be confused with another name.
            clock: returns seconds, on the scale of `time.monotonic` (default: the app's clock).
        """
        super().__init__(None)
        self._person = person
        self._said = how_said(person)
        self._hear = hear
        self._check = check
        self._clock = clock

    def compose(self) -> ComposeResult:
        """Lay out the present pronunciation, the line, and the keys."""
        with Vertical(classes="box") as box:
            box.border_title = Content(said_title(clean(self._person.name)))
            yield Static(clean(said_words(self._said)), markup=False)
            yield Static(SOUNDS_HELP + "\n", markup=False, classes="dim")
            yield PhonesInput(self._said.phones)
            yield Static("", id="wrong", markup=False)
            yield Static(
                Content.assemble(
                    *(part for key, words in (("enter", "note it"), ("^l", "hear it"),
                                              ("esc", "leave it as it is"))
                      for part in ((key, "$primary bold"), f" {words}   "))
                )
            )  # fmt: skip

    def on_mount(self) -> None:
        """Focus the line; keys count once it is visible."""
        line = self.query_one(PhonesInput)
        line.focus()
        line.cursor_position = len(line.value)
        line.keys.watch(self, self._clock)

    def on_input_submitted(self, event: Input.Submitted) -> None:
        """Store the pronunciation, if it is valid."""
        if not event.value.strip():
            self.answer(NewPronunciation(None))
        elif phones := self._checked():
            try:
                self._check(self._person, phones)
            except TangyError as error:
                self._tell(str(error))
            else:
                self.answer(NewPronunciation(phones))

    def on_input_changed(self, event: Input.Changed) -> None:
        """Clear the last error."""
        self._tell("")

    def action_hear(self) -> None:
        """Speak the phones in the line."""
        if phones := self._checked():
            self._hear(phones)

    def action_leave(self) -> None:
        """Close the dialog."""
        self.answer(None)

    def _checked(self) -> str:
        """Return the phones in the line; "" if they are wrong, after showing the mistake."""
        try:
            return check_name(self.query_one(PhonesInput).value, self._person.name)
        except TangyError as error:
            self._tell(str(error))
            return ""

    def _tell(self, sentence: str) -> None:
        self.query_one("#wrong", Static).update(clean(sentence))
