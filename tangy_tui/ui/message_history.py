"""The messages of the application, which vanish after some seconds, and can be read again."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from datetime import datetime
from typing import TYPE_CHECKING, Any, ClassVar

from textual.app import App

from tangy_tui.text.keys import with_keys
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind, keymap_of

if TYPE_CHECKING:
    from textual.binding import BindingType
    from textual.notifications import SeverityLevel

MOST = 100
"""The most messages that are kept."""
LONGEST_WORK = 600.0
"""How long, in s, a message on work in progress stays at most."""


class MessageHistoryApp(App[None]):
    """An application that shows messages, and lists the last ones again."""

    BINDINGS: ClassVar[list[BindingType]] = [*bind("messages")]

    def __init__(self, **settings: Any) -> None:
        """Create the application; `settings` are Textual's."""
        super().__init__(**settings)
        self.told: deque[tuple[datetime, str]] = deque(maxlen=MOST)
        """The last messages, with the local time at which each was shown."""
        self.told_before: tuple[str, Sequence[tuple[datetime, str]]] = "", ()
        """A heading, and the messages before an interruption, with their local times."""

    def remember(self, sentence: str) -> None:
        """Keep a sentence that was told."""
        self.told.append((datetime.now().astimezone(), clean(sentence)))

    def notify(self, message: str, **more: Any) -> None:
        """Show a message for some s, and keep it."""
        self.remember(message)
        super().notify(message, **more)

    def say(self, sentence: str, *, bad: bool = False, seconds: float | None = None) -> None:
        """Show a sentence for some s, unless the screen has a better place for it."""
        sentence = with_keys(sentence, keymap_of(self))
        take = getattr(self.screen, "take_sentence", None)
        if take is not None and take(sentence):
            self.remember(sentence)
            return
        severity: SeverityLevel = "error" if bad else "information"
        self.notify(clean(sentence), severity=severity, timeout=seconds, markup=False)

    def show_work(self, sentence: str) -> None:
        """Show what the program works on, until the notifications are cleared."""
        super().notify(clean(sentence), timeout=LONGEST_WORK, markup=False)

    def action_messages(self) -> None:
        """List the last messages."""
        from tangy_tui.ui.dialogs.messages import MessagesDialog

        heading, before = self.told_before
        self.push_screen(MessagesDialog(tuple(self.told), heading, before))


def remember_before(app: object, heading: str, told: Sequence[tuple[datetime, str]]) -> None:
    """Let Tangy's application keep the messages before an interruption, as the log has them."""
    if isinstance(app, MessageHistoryApp):
        app.told_before = heading, [(at, clean(words)) for at, words in told][-MOST:]


def remember(app: object, sentence: str) -> None:
    """Let Tangy's application keep a sentence that a screen showed in a place of its own."""
    keep = getattr(app, "remember", None)
    if keep is not None:
        keep(sentence)


def date_last(app: object, at: datetime | None) -> None:
    """Give the last message the time at which it happened: a screen may tell it only later."""
    if at is not None and isinstance(app, MessageHistoryApp):
        app.told[-1] = at, app.told[-1][1]
