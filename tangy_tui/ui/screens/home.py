"""The home screen: everything that can be done with Tangy, one letter each, with its progress."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.strip import Strip

from tangy_tui.text.program import TAGLINE, no_command_here
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import LOW, key_line
from tangy_tui.ui.pasted_text import pasted_text
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import Row, draw, fit, shorten
from tangy_tui.ui.widgets.status_line import Status, StatusLine


@dataclass(frozen=True, slots=True)
class MenuItem:
    """A menu line: its letter, its name (in lower case also its id), and its purpose."""

    key: str
    name: str
    does: str

    @property
    def id(self) -> str:
        """The id of the choice."""
        return self.name.lower()


CHOICES = (
    MenuItem("t", "Teach", "show Tangy how the activity is run"),
    MenuItem("g", "Guided", "teach in one game that shows everything"),
    MenuItem("i", "Library", "all demonstrations: view, edit, delete"),
    MenuItem("l", "Learn", "make a policy from what was shown"),
    MenuItem("p", "Play", "let Tangy run the activity"),
    MenuItem("v", "Live", "run it with the robot, or on its bench"),
    MenuItem("r", "Rehearse", "practise what to do when things go wrong"),
    MenuItem("o", "Policy", "what Tangy does in which situation"),
    MenuItem("e", "People", "who takes part, and what persuades them"),
    MenuItem("b", "Reports", "what happened in the last games"),
    MenuItem("c", "Sensors", "cameras and devices, and the last card"),
    MenuItem("a", "Activity", "choose what to teach and play"),
    MenuItem("d", "Demo", "the whole story, in four minutes"),
    MenuItem("n", "Name", "who teaches: change your name"),
    MenuItem("h", "Help", "keys, and how to begin"),
    MenuItem("q", "Quit", "leave Tangy"),
)

A_WORD = 3
"""So many letters in a row are words: fewer may be a change of mind."""
LONGEST_WORD = 40
HELP_CHARACTER = "?"
"""Opens the help, also within a word."""
MOVES = ("k", "j")
"""Letters that move the cursor: no word begins with them."""

States = Callable[[], Mapping[str, str]]
"""Returns the progress of each choice, by its id: {"teach": "2 demonstrations"}."""


class Menu(InkedWidget, can_focus=True):
    """The choices, one line each, with empty lines between if there is room."""

    ALLOW_MAXIMIZE = False  # there is nothing beside them

    DEFAULT_CSS = """
    Menu { height: 1fr; padding: 1 2 0 2; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(f"up,{MOVES[0]}", "move(-1)", "Up", show=False),
        Binding(f"down,{MOVES[1]}", "move(1)", "Down", show=False),
        Binding("enter", "choose", "Choose", id="open"),
    ]

    class Chosen(Message):
        """A choice was made; `id` is its id."""

        def __init__(self, id: str) -> None:
            super().__init__()
            self.id = id

    class Typed(Message):
        """Enter came after words that name no line."""

        def __init__(self, words: str) -> None:
            super().__init__()
            self.words = words

    def __init__(self, choices: Sequence[MenuItem], id: str | None = "home") -> None:
        super().__init__(id=id)
        self._typed = ""  # the letters since the last Enter or move
        self._choices = tuple(choices)
        self._states: Mapping[str, str] = {}
        self._at = 0

    @property
    def chosen(self) -> MenuItem:
        """The choice at the cursor."""
        return self._choices[self._at]

    def show(self, states: Mapping[str, str]) -> None:
        """Show the progress of each choice."""
        if states != self._states:
            self._states = dict(states)
            self.refresh()

    def point(self, id: str) -> None:
        """Move the cursor to a choice."""
        self._at = next((n for n, c in enumerate(self._choices) if c.id == id), self._at)
        self.refresh()

    def action_move(self, by: int) -> None:
        """Move the cursor."""
        self._typed = ""
        self._at = (self._at + by) % len(self._choices)
        self.refresh()

    def action_choose(self) -> None:
        """Choose the line at the cursor, unless words were typed that name no line."""
        typed, self._typed = self._typed.strip(), ""
        if len(typed) >= A_WORD and self._named(typed) is None:
            self.post_message(self.Typed(typed))
        else:
            self.post_message(self.Chosen(self.chosen.id))

    def forget_typed(self) -> None:
        """Begin a new word."""
        self._typed = ""

    def on_key(self, event: events.Key) -> None:
        """Move the cursor to a choice by its letter or name; only Enter chooses."""
        by_letter = [one for one in self._choices if one.key == event.key]
        typed, character = self._typed, event.character
        letter = (character or "").isalpha() or (bool(typed) and character == " ")
        begins = letter and event.key not in MOVES
        continues = letter if len(typed) == 1 else bool(typed) and character != HELP_CHARACTER
        if event.key == "backspace":
            self._typed = typed[:-1]
        elif event.is_printable and character and (continues or begins):
            self._typed = f"{typed}{character}"[-LONGEST_WORD:]
        else:
            return
        named = self._named(self._typed) if len(self._typed) > 1 else None
        if by_letter or len(typed) > 1 or (typed and named is not None):
            event.stop()  # within a word no letter is a key of the program
        for choice in [named] if named is not None else by_letter:
            self.point(choice.id)

    def add(self, text: str) -> None:
        """Count text that came at once as typed words."""
        self._typed = f"{self._typed}{clean(text)}"[-LONGEST_WORD:]
        named = self._named(self._typed) if len(self._typed) > 1 else None
        if named is not None:
            self.point(named.id)

    def _named(self, typed: str) -> MenuItem | None:
        """Return the first choice whose name begins with the typed letters."""
        begun = typed.casefold()
        return next((c for c in self._choices if c.name.casefold().startswith(begun)), None)

    def on_click(self, event: events.Click) -> None:
        """Choose by mouse."""
        line = self._line(event.y - self.styles.padding.top)
        if line is not None:
            self._typed = ""
            self._at = line
            self.refresh()
            self.action_choose()

    def render_line(self, y: int) -> Strip:
        """Draw one line."""
        width = self.size.width
        line = self._line(y)
        if line is None:
            return draw(self, self._heading(y), width)
        over = "now" if line == self._at else ""
        return draw(self, self._row(self._choices[line], line == self._at, width), width, over)

    def _spacing(self) -> int:
        return 2 if self.size.height >= 2 * len(self._choices) + 3 else 1

    def _first(self) -> int:
        """Return the first choice's line; the heading above is left out if there is no room."""
        return max(0, min(3, self.size.height - len(self._choices)))

    def _line(self, y: int) -> int | None:
        """Return the choice on line `y` of the content."""
        line, rest = divmod(y - self._first(), self._spacing())
        return line if not rest and 0 <= line < len(self._choices) else None

    def _heading(self, y: int) -> Row:
        if y == 0:
            return ((" ".join("TANGY"), "robot"),)
        if y == 1 < self._first():
            return ((TAGLINE, "dim"),)
        return ()

    def _row(self, choice: MenuItem, here: bool, width: int) -> Row:
        name = fit(choice.name, 9)
        state = clean(self._states.get(choice.id, ""))
        head = 6 + len(name)
        does_width = min(42, width - head) if width >= 100 or not state else 0
        state_width = width - head - does_width
        return (
            ("▸ " if here else "  ", "robot"),
            (choice.key, "robot"),
            ("  ", "text"),
            (name, "strong"),
            (" ", "text"),
            (fit(choice.does, does_width), "text" if here else "dim"),
            (shorten(state, state_width), "text"),
        )


class HomeScreen(TangyScreen[None]):
    """The home screen. Posts `HomeScreen.Chosen` to itself and the application."""

    DEFAULT_CSS = """
    HomeScreen.-low Menu { padding: 0 2; }
    HomeScreen.-behind > * { visibility: hidden; }
    """
    VERTICAL_BREAKPOINTS = LOW
    TITLE = "Home"
    HELP = (
        "Begin with Teach: show Tangy a game by typing or saying what it should do. Then Learn, "
        "and then Play. Go to a line with its letter or the arrows, and choose it with Enter."
    )
    AUTO_FOCUS = "#home"
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("guided", "app.guided"),
        *bind("library", "app.library"),
        *bind("learn", "app.learn"),
        *bind("name", "app.name"),
    ]

    class Chosen(Message):
        """A choice was made; `id` is teach, library, learn, play, rehearse, and so on."""

        def __init__(self, id: str) -> None:
            super().__init__()
            self.id = id

    def __init__(
        self, states: States = dict, *, choices: Sequence[MenuItem] = CHOICES, note: str = ""
    ) -> None:
        """Create the screen; `states` is called whenever it is shown."""
        super().__init__()
        self._states = states
        self._menu = Menu(choices)
        self._note = note

    def compose(self) -> ComposeResult:
        """Lay out the status line, the choices, and the keys."""
        yield StatusLine(Status(mode="home", note=self._note))
        yield self._menu
        yield key_line(
            "open:choose", ("letter", "go to"), ("up down", "move"), "guided", "library", "learn",
            "palette", "quit", "help",
        )  # fmt: skip

    def show_activity(self, title: str) -> None:
        """Show the title of the present activity."""
        self._note = title
        self.query_one(StatusLine).show(Status(mode="home", note=title))
        self._show_progress()

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Update the progress once the choices are drawn, which need not wait for it."""
        self._menu.forget_typed()
        self.call_after_refresh(self._show_progress)
        self.call_after_refresh(self._take_keys)

    def _take_keys(self) -> None:
        """Focus the choices: while hidden behind another screen they could not be focused."""
        if self.focused is None:
            self._menu.focus()

    def _show_progress(self) -> None:
        self._menu.show(self._states())

    def take_letter(self, event: events.Key | events.Paste) -> bool:
        """Take pasted text, and letters that a slow link brings at once, as words."""
        if isinstance(event, events.Paste):
            self._menu.add(event.text)
            return True
        if pasted_text(event) and event.is_printable:
            self._menu.add(event.character or "")
            return True
        return False

    def on_menu_typed(self, event: Menu.Typed) -> None:
        """Tell somebody who types commands here where they belong."""
        event.stop()
        app: Any = self.app
        app.say(no_command_here(event.words))

    def on_menu_chosen(self, event: Menu.Chosen) -> None:
        """Handle help and quit, and pass other choices to the app."""
        event.stop()
        app: Any = self.app
        if event.id == "quit":
            app.leave()
        elif event.id == "help":
            app.action_help()
        else:
            self.post_message(self.Chosen(event.id))
