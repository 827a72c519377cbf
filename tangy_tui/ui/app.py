"""The application: colours, global key bindings, and an orderly exit."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
from collections.abc import Callable, Iterable
from contextlib import suppress
from datetime import datetime
from functools import partial
from pathlib import Path
from threading import Thread
from time import monotonic
from typing import TYPE_CHECKING, Any, ClassVar, cast

from textual import events
from textual._compositor import ChopsUpdate, LayoutUpdate
from textual.app import App, SystemCommand
from textual.css.query import NoMatches
from textual.screen import Screen

from tangy_profiles.errors import TangyError
from tangy_tui.app.terminal_session import QuestionKey, terminal_session
from tangy_tui.text import program as text
from tangy_tui.ui.blank_screen import BlankScreen
from tangy_tui.ui.clean_output import CleanOutput
from tangy_tui.ui.early_keys import EarlyKeys
from tangy_tui.ui.key_reading import KeyReader, prepare_stop
from tangy_tui.ui.keys import DEFAULT, bind
from tangy_tui.ui.message_history import MessageHistoryApp
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.round_trip import ReplyParser, RoundTrip
from tangy_tui.ui.screen_diff import ScreenDiff, TextUpdate
from tangy_tui.ui.terminal import SERVED, TerminalKind
from tangy_tui.ui.themes import ANSI, DARK, INK_DEFAULTS, LIGHT, THEMES, first_theme
from tangy_tui.ui.writer import HeldWrites

if TYPE_CHECKING:
    from rich.console import RenderableType
    from textual.binding import BindingType
    from textual.command import Provider

    from tangy_tui.app.keymap import Keymap
    from tangy_tui.app.user_settings import LinkSpeed
    from tangy_tui.ui.type_ahead_guard import Clock

HANGUP_CODE = 129
TERMINATED_CODE = 143

LOADED_SECONDS = 1.0
"""The first screen is drawn by then."""

FirstScreen = Callable[[], Screen[Any]]
"""Creates the first screen of the program."""


def collect_again() -> None:
    """Collect garbage from now on, except what was loaded, which stays as long as the program."""
    gc.freeze()
    gc.enable()


class TangyApp(MessageHistoryApp):
    """The Textual application. Its screens are pushed from outside.

    `return_code` is 0 after a normal end, 129 after the terminal was closed, 143 after SIGTERM.
    Every exit first sends `Stop` to all open screens.
    """

    TITLE = "Tangy"
    CSS_PATH = Path(__file__).with_name("tangy.tcss")
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("stop", priority=True),
        *bind("quit", priority=True),
        *bind("palette", "command_palette", priority=True),
        *bind("help", priority=True),
        *bind("command"),
        *bind("back"),
        *bind("zoom"),
        *bind("picture"),
        *bind("draw", "draw_again", priority=True),
        *bind("filter"),
        *bind("phrases"),
        *bind("mouse"),
    ]

    def __init__(
        self,
        first: FirstScreen | None = None,
        *,
        kind: TerminalKind | None = None,
        pictures: Path | None = None,
        clock: Clock = monotonic,
        question: QuestionKey = "auto",
        keymap: Keymap = DEFAULT,
        link: LinkSpeed = "auto",
        theme: str = "",
        keep_theme: Callable[[str], None] = lambda _: None,
    ) -> None:
        """Create the application.

        Args:
            first: creates the first screen (default: an empty one).
            kind: the capabilities of the terminal (see `terminal.terminal_kind()`).
            pictures: the folder for screenshots (default: the current one).
            clock: returns seconds, on the scale of `time.monotonic`; dialogs and the room use it.
            question: the key for a yes to a question.
            keymap: the keys of the actions.
            link: the speed of the connection to the terminal.
            theme: the theme chosen earlier ("": none). A terminal of 16 colours keeps its own.
            keep_theme: stores the name of a theme that is chosen.
        """
        kind = kind or TerminalKind()
        super().__init__(ansi_color=True if kind.ansi else None)
        for known in THEMES:
            self.register_theme(known)
        self._use_theme(first_theme(theme, ansi=kind.ansi))
        self._keep_theme = keep_theme
        self._filters.append(CleanOutput(ascii=kind.ascii))
        self.animation_level = "none"
        self.kind = kind
        self.clock = clock
        self.mouse = True
        """Whether Tangy handles the mouse; otherwise the terminal selects and copies text as usual.
        """
        self._first = first
        self._pictures = pictures
        self.leaving = False
        """Whether the program is ending, which is then why things stop."""
        self.early_keys = EarlyKeys(self)
        self._reader = KeyReader(self, self.early_keys)
        self.frames = HeldWrites(lambda: None if self.is_headless else self._driver)
        self._shown = ScreenDiff()
        self._measured = False
        self._blank = BlankScreen()
        self._question = question
        self.keymap = keymap
        self._link = link
        self.set_keymap(keymap.overrides())
        self.round_trip: RoundTrip | None = None
        """Asks the terminal whether it has drawn a question; None if it cannot."""

    async def on_event(self, event: events.Event) -> None:
        """Handle a typed or pasted stop first, so that its letters are not taken as keys."""
        if isinstance(event, events.Resize):
            if self._measured:  # the first one only reports the size
                self._shown.forget()
            self._measured = True
            if self.round_trip is not None:
                self.round_trip.resized(event.size)
        if not (self._blank.hides(event, self.keymap) or self._reader.takes(event)):
            await super().on_event(event)

    def get_default_screen(self) -> Screen[Any]:
        """Return the first screen."""
        screen = self._first() if self._first is not None else super().get_default_screen()
        self._load_screen_css(screen)  # Textual only does this for pushed screens
        return screen

    def get_theme_variable_defaults(self) -> dict[str, str]:
        """Return the colours of the inks for themes that are not Tangy's own."""
        return INK_DEFAULTS

    def on_mount(self) -> None:
        """Exit in order on SIGHUP and SIGTERM."""
        loop = asyncio.get_running_loop()
        for number, code in ((signal.SIGHUP, HANGUP_CODE), (signal.SIGTERM, TERMINATED_CODE)):
            # Not on Windows, and not outside of the main thread.
            with suppress(NotImplementedError, RuntimeError, ValueError):
                loop.add_signal_handler(number, self.leave, code, f"{number.name} was received")
        self.call_after_refresh(Thread(target=prepare_stop, daemon=True).start)
        if not gc.isenabled():
            self.set_timer(LOADED_SECONDS, collect_again)
        if not self.is_headless:
            self.call_after_refresh(self._meet_terminal)

    def _meet_terminal(self) -> None:
        """Find out whether the terminal replies, which proves that it has drawn a question."""
        self.round_trip = RoundTrip(
            self._to_terminal,
            terminal_session,
            self.clock,
            cursor=lambda: self._previous_cursor_position,
            setting=self._question,
        )
        ReplyParser.heard = self.round_trip.attributes
        self.round_trip.begin(self.size)

    def _to_terminal(self, sequence: str) -> None:
        """Write after everything drawn so far."""
        if self._driver is not None:
            self._driver.write(sequence)
            self._driver.flush()

    @property
    def slow_link(self) -> bool:
        """Whether the link to the terminal is slow, so that fewer frames are drawn."""
        if self._link != "auto" or self.round_trip is None:
            return self._link == "slow"
        return self.round_trip.slow

    def on_cursor_position(self, event: events.CursorPosition) -> None:
        """Handle the terminal's reply: everything drawn before has arrived."""
        if self.round_trip is not None:
            self.round_trip.reported(event.x, event.y, event.time)

    def stop(self, reason: str) -> None:
        """Send `Stop` to every open screen, the topmost first."""
        for screen in reversed(self.screen_stack):
            screen.post_message(Stop(reason))

    def leave(self, code: int = 0, reason: str = "the program ends") -> None:
        """Send `Stop`, wait until every screen has handled it, and exit with this status."""
        if self.leaving:
            return
        self.leaving = True
        self.stop(reason)
        waiting = len(self.screen_stack)

        def heard() -> None:
            nonlocal waiting
            waiting -= 1
            if not waiting:
                self.exit(return_code=code)

        for screen in self.screen_stack:
            if not screen.call_later(heard):
                heard()

    def action_stop(self) -> None:
        """Stop the robot; if nothing could be moving, tell that."""
        from tangy_tui.ui.base import Dialog

        moving = [s for s in self.screen_stack if hasattr(s, "on_stop")]
        if all(isinstance(screen, Dialog) for screen in moving):
            self.say(text.NOTHING_MOVES)
        self.stop("ctrl+x was pressed")

    def _display(self, screen: Screen[Any], renderable: RenderableType | None) -> None:
        """Write only the cells that changed, if any."""
        if renderable is not None:
            self._blank.drawn(screen)
        if (
            isinstance(renderable, LayoutUpdate | ChopsUpdate)
            and self._driver is not None
            and self._running
            and not (self.is_headless or self._batch_count or self._closed)
        ):
            changed = self._shown.difference(renderable, self.console)
            cursor = self.screen.outer_size.clamp_offset(self.cursor_position)
            if not changed and cursor == self._previous_cursor_position:
                self.post_display_hook()
                return
            super()._display(screen, cast("RenderableType", TextUpdate(changed)))
            return
        if renderable is not None:
            self._shown.forget()
        super()._display(screen, renderable)

    def _handle_exception(self, error: Exception) -> None:
        """Ignore errors of a screen that was still being laid out when the program ended.

        Textual mounts nothing once an application exits, so that such a screen does not find its
        widgets. All other errors are reported.
        """
        if not (self._exit and isinstance(error, NoMatches)):
            super()._handle_exception(error)

    async def action_quit(self) -> None:
        """Leave the program."""
        self.leave()

    def action_help(self) -> None:
        """Show help for the focused widget and the screen, or close it."""
        from tangy_tui.ui.screens.help import HelpScreen, help_for

        if isinstance(self.screen, HelpScreen):
            self.screen.action_close()
        else:
            self.push_screen(HelpScreen(help_for(self.screen)))

    def action_command(self) -> None:
        """Focus the command bar, if the screen has one."""
        with suppress(NoMatches):
            self.screen.query_one("#command-input").focus()

    async def action_back(self) -> None:
        """Return to the previous screen; the first one stays."""
        if len(self.screen_stack) > 1:
            self.pop_screen()

    def action_zoom(self) -> None:
        """Maximise the focused panel, or restore it."""
        screen, panel = self.screen, self.screen.focused
        if screen.maximized is not None:
            screen.minimize()
        elif panel is not None and panel.allow_maximize:
            screen.maximize(panel)

    def action_picture(self) -> None:
        """Save the screen as an SVG picture, and tell its path."""
        folder = self._pictures or Path.cwd()
        name = f"tangy-{datetime.now().astimezone():%Y-%m-%d-%H%M%S}.svg"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            path = self.save_screenshot(filename=name, path=str(folder))
        except OSError as error:
            self.say(text.not_saved_words(folder, error.strerror), bad=True)
        else:
            self.say(f"Saved {path}")

    def action_draw_again(self) -> None:
        """Redraw the whole screen, after other output on the terminal."""
        self._shown.forget()
        self.screen.refresh(layout=True)

    def action_mouse(self) -> None:
        """Handle the mouse, or leave it to the terminal for copying text."""
        self.use_mouse(not self.mouse)
        if self.mouse:
            self.say(text.MOUSE_ON)
        else:
            self.say(text.MOUSE_OFF)

    def use_mouse(self, on: bool) -> None:
        """Handle the mouse, or leave it to the terminal."""
        driver: Any = self._driver
        if driver is not None and hasattr(driver, "_enable_mouse_support"):
            if on:
                driver._mouse = True
                driver._enable_mouse_support()
            else:
                driver._disable_mouse_support()
                driver._mouse = False
        self.mouse = on

    def get_system_commands(self, screen: Screen[Any]) -> Iterable[SystemCommand]:
        """List the commands of the palette that have no key."""
        for (name, like), theme in zip(text.THEMES.items(), (DARK, LIGHT, ANSI), strict=True):
            yield SystemCommand(name, like, partial(self._choose_theme, theme.name))

    def action_command_palette(self) -> None:
        """Show the command palette, unless it is open."""
        from tangy_tui.ui.palette import Palette

        if not isinstance(self.screen, Palette):
            self.push_screen(Palette([_actions_provider]))

    def action_filter(self) -> None:
        """Filter the focused list, or the first one of the screen."""
        lists = (self.screen.focused, *self.screen.query("*"))
        for panel in lists:
            begin = getattr(panel, "begin_filter", None)
            if begin is not None and panel is not None and panel.display:
                begin()
                return

    def _choose_theme(self, name: str) -> None:
        self.ansi_color = None
        self.theme = name
        try:
            self._keep_theme(name)
        except TangyError as error:
            self.say(str(error), bad=True)

    def _use_theme(self, name: str) -> None:
        """Set the theme before the program runs, so that the styles are parsed once."""
        self.set_reactive(App.theme, name)
        self._refresh_truecolor_filter(self.ansi_theme)
        self.stylesheet.set_variables(self.get_css_variables())
        theme = self.current_theme
        self.set_class(theme.dark, "-dark-mode", update=False)
        self.set_class(not theme.dark, "-light-mode", update=False)


def _actions_provider() -> type[Provider]:
    from tangy_tui.ui.palette import ActionsProvider

    return ActionsProvider


def run_app(app: TangyApp) -> int:
    """Run the application and return its exit status."""
    if SERVED not in os.environ:
        for size in ("COLUMNS", "LINES"):  # exported, they hide the window's size
            os.environ.pop(size, None)
    app.run()
    return app.return_code or 0
