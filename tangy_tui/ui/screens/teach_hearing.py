"""The teaching screen as a listener: when it takes commands, and which phrases it knows."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from textual.screen import Screen

from tangy_tui.app.workspace import Workspace
from tangy_tui.language.commands import Phrasebook
from tangy_tui.learning.teaching_events import TeachingEvent
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Say
from tangy_tui.text.teaching import BY_KEY, HANDS_FREE
from tangy_tui.ui.hearing import Hearing
from tangy_tui.ui.screens.teach_keys import (
    HEARING_KEYS,
    KEYS,
    RULE_HEARING_KEYS,
    RULE_KEYS,
)
from tangy_tui.ui.widgets.command_bar import CommandBar
from tangy_tui.ui.widgets.log_view import Kind, LogView


class TeachHearing:
    """Takes spoken commands, one at a time. Without a recogniser it only keeps its state."""

    def __init__(
        self,
        screen: Screen[Any],
        workspace: Workspace,
        teaching: TeachingSession,
        apply: Callable[[Say], None],
    ) -> None:
        """Create the listener; `apply` applies a command to the session."""
        self.hearing: Hearing | None = None
        self.by_voice = False
        """Whether the present command was spoken."""
        self._screen = screen
        self._workspace = workspace
        self._teaching = teaching
        self._apply = apply
        self._people = workspace.people  # when the session was created
        self._present = self._people
        self._changed: Phrasebook | None = None  # the phrasebook after a change of people
        self._open = False

    @property
    def by_key(self) -> bool:
        """Whether it is push-to-talk."""
        return self.hearing is not None and self.hearing.by_key

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of the screen."""
        heard = self.hearing is not None
        if self._teaching.rules.possible:
            return RULE_HEARING_KEYS if heard else RULE_KEYS
        return HEARING_KEYS if heard else KEYS

    @property
    def help(self) -> str:
        """How to talk to Tangy; "" without speech input."""
        if self.hearing is None:
            return ""
        return f" {BY_KEY if self.by_key else HANDS_FREE}"

    @property
    def aloud(self) -> str:
        """The words that tell how to answer a question by voice; "" if that is not possible."""
        return "" if self.hearing is None else self.hearing.aloud

    def follow(self, events: Iterable[TeachingEvent]) -> None:
        """Label the recording of a command with its result."""
        if self.hearing is not None:
            self.hearing.ears.follow(events)

    def attend(self) -> None:
        """Start to listen."""
        if self.hearing is not None:
            self.hearing.attend(self)

    def leave(self) -> None:
        """Stop listening."""
        if self.hearing is not None:
            self.hearing.leave(self)

    def open(self, is_open: bool) -> None:
        """Open or close for commands; queued speech is handled next."""
        self._open = is_open
        if self.hearing is not None:
            self.hearing.look()

    @property
    def listens(self) -> bool:
        """Whether a command can be applied to the session now."""
        return self._open and (self._screen.is_active or self._under_a_page)

    @property
    def _under_a_page(self) -> bool:
        """Whether only pages to read, which can be opened by voice, cover the screen."""
        from tangy_tui.ui.screens.help import HelpScreen
        from tangy_tui.ui.screens.phrases import PhrasesScreen

        stack = self._screen.app.screen_stack
        if self._screen not in stack:
            return False
        above = stack[stack.index(self._screen) + 1 :]
        return all(isinstance(page, HelpScreen | PhrasesScreen) for page in above)

    @property
    def spoken(self) -> Phrasebook:
        """The phrases that can be spoken, with the present pronunciation of names."""
        present = tuple(p for p in self._workspace.people if p.id in self._teaching.people)
        if self._changed is None and self._people is self._workspace.people:
            return self._teaching.phrasebook
        if self._changed is None or self._present != present:
            self._present, self._changed = (
                present,
                self._teaching.phrasebook_for(present),
            )
        return self._changed

    def refresh(self) -> None:
        """Listen for the present participants and the pronunciation of their names."""
        if self.hearing is not None:
            self.hearing.understand()

    def hear(self, said: Say) -> None:
        """Apply a spoken command; words that steer the application count as if typed.

        A command closes the page that covers the screen: the phrases that it lists can be said.
        """
        if said.commands == () and not self._screen.is_active:
            return  # people talk while the teacher reads
        while not self._screen.is_active:
            self._screen.app.pop_screen()
        if said.commands is None:
            self._screen.post_message(
                CommandBar.Given(self._screen.query_one(CommandBar), said.text)
            )
            return
        self.by_voice = True
        self._apply(said)

    def told(self, sentence: str, kind: Kind) -> None:
        """Show a sentence about speech input in the log."""
        for log in self._screen.query(LogView):
            log.notice(sentence, kind)

    def give_back(self, heard: str) -> None:
        """Put a command back into the bar for correction.

        A spoken command is not put back: overheard words would stay in the line.
        """
        bar = self._screen.query_one(CommandBar)
        if self.by_voice:
            bar.ready()
        else:
            bar.restore(heard)
