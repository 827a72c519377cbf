"""The phrasebook screen: the phrases of each behaviour, and the pronunciation of every word."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from itertools import groupby
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Input

from tangy_profiles.errors import TangyError
from tangy_tui.app.aloud import hear
from tangy_tui.app.workspace import Workspace
from tangy_tui.language.phrase_list import list_phrases
from tangy_tui.learning.own_phrases import own_phrases, personal_activity
from tangy_tui.text import phrases as text
from tangy_tui.text.phrases import NONE_FOUND, PhraseItem, items
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.dialogs.pronunciation import NewPronunciation, PronunciationDialog
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import key_line, panel
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import fit
from tangy_tui.ui.widgets.status_line import Status, StatusLine
from tangy_tui.ui.widgets.wrapping import wrap

LONGEST_SEARCH = 60
ABOUT = 20  # width of the subject of an entry

Hear = Callable[[str], Awaitable[None]]
"""Speaks phones."""


class SearchInput(Input):
    """The search line; results update with every letter."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,down,up,tab", "screen.found", "Choose among what was found"),
        Binding("escape", "screen.all", "Show everything again"),
    ]

    async def _on_key(self, event: events.Key) -> None:
        bindings = self._bindings.key_to_bindings.get(event.key, [])
        if bindings:
            event.stop()
            event.prevent_default()
            await self.run_action(bindings[0].action)
        else:
            await super()._on_key(event)


class PhrasesScreen(TangyScreen[None]):
    """All phrases that Tangy understands, to read, search and listen to."""

    DEFAULT_CSS = """
    PhrasesScreen #phrases { height: 1fr; }
    PhrasesScreen #search { display: none; height: 1; padding: 0 1; }
    PhrasesScreen.-searching #search { display: block; }
    """
    TITLE = "Phrases"
    HELP = (
        "All that can be said or typed, from the file of the activity: for each behaviour its "
        "phrases and keywords, then the people and their seats, what cannot be heard, and how "
        "every word is said. {filter} filters: type any words, Enter goes to what was found, esc "
        "shows everything again. {hear} says the chosen entry aloud. {pronounce} changes how a "
        "person's name is said; words of the activity stand in its file, under [pronunciations]."
    )
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("filter", "search"),
        *bind("hear"),
        *bind("pronounce", "edit"),
        *bind("back", "leave"),
    ]

    def __init__(self, workspace: Workspace, say: Hear = hear) -> None:
        """Create the screen; `say` speaks phones."""
        super().__init__()
        self._workspace = workspace
        self._aloud = say
        self._items: tuple[PhraseItem, ...] = ()

    def compose(self) -> ComposeResult:
        """Lay out the list and the search line."""
        yield StatusLine(Status(mode="phrases", note=self._workspace.activity.title))
        yield panel(ChoiceList(text.LIST_TITLE, text.LIST_HELP, id="phrases"))
        search = SearchInput(
            placeholder="search for ...",
            max_length=LONGEST_SEARCH,
            compact=True,
            select_on_focus=False,
            id="search",
        )
        search.cursor_blink = False
        yield search
        yield key_line(
            ("up down", "choose"), "filter", "hear", "pronounce:edit a name", "back", "help"
        )

    def on_mount(self) -> None:
        """Look up the words in the background."""
        self._list.focus()
        self._list.show(lambda width, height: [ChoiceLine(((text.LOOKING_UP, "dim"),))])
        self.run_worker(self._read(), group="read", exclusive=True)

    def on_input_changed(self, event: Input.Changed) -> None:
        """Show the matches."""
        self._show()

    def action_search(self) -> None:
        """Open the search line."""
        self.add_class("-searching")
        self.query_one(SearchInput).focus()

    def action_found(self) -> None:
        """Move to the first match."""
        self._list.focus()

    def action_all(self) -> None:
        """Clear the search."""
        self.query_one(SearchInput).clear()
        self.remove_class("-searching")
        self._list.focus()
        self._show()

    def action_hear(self) -> None:
        """Speak the chosen entry."""
        item = self._chosen
        if item is None or not item.phones:
            self._say(text.CHOOSE_SAYABLE)
        else:
            self._hear(item.phones)

    def action_edit(self) -> None:
        """Change the pronunciation of the chosen person's name."""
        item = self._chosen
        if item is None or item.person is None:
            self._say(text.CHOOSE_PERSON)
            return
        person = self._workspace.find_person(item.person)

        def take(new: NewPronunciation | None) -> None:
            if new is not None:
                try:
                    self._workspace.pronounce(person, new.phones)
                except TangyError as error:
                    self._say(str(error), bad=True)
                self.run_worker(self._read(), group="read", exclusive=True)

        dialog = PronunciationDialog(person, self._hear, self._workspace.check_said)
        self.app.push_screen(dialog, take)

    def action_leave(self) -> None:
        """Clear the search, or close the screen."""
        if self.query_one(SearchInput).value:
            self.action_all()
        else:
            self.leave(None)

    @property
    def _list(self) -> ChoiceList:
        return self.query_one("#phrases", ChoiceList)

    @property
    def _chosen(self) -> PhraseItem | None:
        """The entry at the cursor."""
        at = self._list.chosen
        return self._items[at] if isinstance(at, int) and at < len(self._items) else None

    async def _read(self) -> None:
        workspace = self._workspace
        own = own_phrases(workspace.store, workspace.activity.name, workspace.teacher)
        activity = personal_activity(workspace.activity, own)
        listed = await asyncio.to_thread(list_phrases, activity, workspace.people, own)
        self._items = tuple(items(listed))
        self._show()

    def _show(self) -> None:
        wanted = self.query_one(SearchInput).value
        self._list.show(lambda width, height: phrase_lines(self._items, wanted, width))

    def _hear(self, phones: str) -> None:
        self.run_worker(self._heard(phones), group="hear", exclusive=True)

    async def _heard(self, phones: str) -> None:
        try:
            await self._aloud(phones)
        except TangyError as error:
            self._say(str(error), bad=True)

    def _say(self, sentence: str, *, bad: bool = False) -> None:
        severity = "error" if bad else "information"
        self.app.notify(clean(sentence), severity=severity, markup=False)  # type: ignore[arg-type]


def phrase_lines(entries: tuple[PhraseItem, ...], wanted: str, width: int) -> list[ChoiceLine]:
    """Format the entries that match a search, with headings; their keys are indices."""
    about = min(ABOUT, width // 3)
    lines: list[ChoiceLine] = []
    found = [(place, item) for place, item in enumerate(entries) if item.has(wanted)]
    for heading, under in groupby(found, key=lambda one: one[1].heading):
        lines += (
            [ChoiceLine(()), ChoiceLine(((clean(heading), "strong"),))]
            if lines
            else [ChoiceLine(((clean(heading), "strong"),))]
        )
        for place, item in under:
            left = wrap(clean(item.about), about)
            right = [line for text in item.texts for line in wrap(clean(text), width - about - 2)]
            for n in range(max(len(left), len(right))):
                name = fit(left[n] if n < len(left) else "", about + 2)
                text = right[n] if n < len(right) else ""
                ink = "person" if item.person else "robot"
                lines.append(ChoiceLine(((name, ink), (text, "text")), place))
    return lines or [ChoiceLine(((NONE_FOUND, "dim"),))]
