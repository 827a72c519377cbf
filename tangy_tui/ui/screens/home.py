"""The first screen: what can be done with Tangy, each by one letter, and how far it is."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.message import Message
from textual.strip import Strip

from tangy_tui.text.program import TAGLINE
from tangy_tui.ui.base import TangyScreen
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import key_line
from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import Row, draw, fit, shorten
from tangy_tui.ui.widgets.status_line import Status, StatusLine


@dataclass(frozen=True, slots=True)
class MenuItem:
    """One line: the letter, the name (also its id, in lower case), and what it is for."""

    key: str
    name: str
    does: str

    @property
    def id(self) -> str:
        """The word it is known by."""
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
    MenuItem("c", "Sensors", "cameras and devices, and the last card"),
    MenuItem("a", "Activity", "choose what to teach and play"),
    MenuItem("d", "Demo", "the whole story, in four minutes"),
    MenuItem("n", "Name", "who teaches: change your name"),
    MenuItem("h", "Help", "keys, and how to begin"),
    MenuItem("q", "Quit", "leave Tangy"),
)

States = Callable[[], Mapping[str, str]]
"""Gives a short line on how far each choice is, by its id: {"teach": "2 demonstrations"}."""


class Menu(Inked, can_focus=True):
    """The choices, one line each, with a line between them where there is room."""

    ALLOW_MAXIMIZE = False  # there is nothing beside them

    DEFAULT_CSS = """
    Menu { height: 1fr; padding: 1 2 0 2; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("up,k", "move(-1)", "Up", show=False),
        Binding("down,j", "move(1)", "Down", show=False),
        Binding("enter", "choose", "Choose", id="open"),
    ]

    class Chosen(Message):
        """A choice was made; `id` is its word."""

        def __init__(self, id: str) -> None:
            super().__init__()
            self.id = id

    def __init__(self, choices: Sequence[MenuItem], id: str | None = "home") -> None:
        super().__init__(id=id)
        self._choices = tuple(choices)
        self._states: Mapping[str, str] = {}
        self._at = 0

    @property
    def chosen(self) -> MenuItem:
        """The choice that the cursor is on."""
        return self._choices[self._at]

    def show(self, states: Mapping[str, str]) -> None:
        """Say how far each choice is."""
        if states != self._states:
            self._states = dict(states)
            self.refresh()

    def point(self, id: str) -> None:
        """Move the cursor to a choice."""
        self._at = next((n for n, c in enumerate(self._choices) if c.id == id), self._at)
        self.refresh()

    def action_move(self, by: int) -> None:
        """Move the cursor."""
        self._at = (self._at + by) % len(self._choices)
        self.refresh()

    def action_choose(self) -> None:
        """Choose what the cursor is on."""
        self.post_message(self.Chosen(self.chosen.id))

    def on_key(self, event: events.Key) -> None:
        """Go to a choice by its letter; Enter takes it, so that text that is pasted does not."""
        for choice in self._choices:
            if event.key == choice.key:
                event.stop()
                self.point(choice.id)

    def on_click(self, event: events.Click) -> None:
        """Choose with the mouse."""
        line = self._line(event.y - self.styles.padding.top)
        if line is not None:
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
        """Return the line of the first choice: what stands above it goes where room is scarce."""
        return max(0, min(3, self.size.height - len(self._choices)))

    def _line(self, y: int) -> int | None:
        """Return which choice stands on line `y` of the content."""
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
    """The first screen. Posts `HomeScreen.Chosen` to itself and the app, which opens the rest."""

    DEFAULT_CSS = """
    HomeScreen.-behind > * { visibility: hidden; }
    """
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
        """Make the screen; `states` is asked each time that it is shown."""
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
        """Show which activity is taught and played."""
        self._note = title
        self.query_one(StatusLine).show(Status(mode="home", note=title))
        self._menu.show(self._states())

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Look how far things are."""
        self._menu.show(self._states())

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
