"""The base classes of screens and dialogs: help, and a cover if the window is too small."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, ClassVar, TypeVar

from textual import events
from textual.binding import BindingType
from textual.messages import Prune
from textual.screen import ModalScreen, Screen
from textual.strip import Strip
from textual.widget import Widget

from tangy_tui.ui.keys import bind
from tangy_tui.ui.messages import Stop
from tangy_tui.ui.terminal import too_small
from tangy_tui.ui.themes import INK_CLASSES
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import draw
from tangy_tui.ui.widgets.wrapping import wrap

LOW_OR_TALL = [(0, "-low"), (22, "-tall")]
"""The classes of a dialog from a number of lines on."""

ResultT = TypeVar("ResultT")
AnswerT = TypeVar("AnswerT")


class Cover(InkedWidget, can_focus=True):
    """Covers a screen with one sentence if the window is too small for it, and swallows keys."""

    DEFAULT_CSS = """
    Cover { layer: cover; dock: top; width: 100%; height: 100%; background: $background; }
    """

    def __init__(self, sentence: str, keep: Widget | None) -> None:
        super().__init__()
        self._sentence = sentence
        self._keep = keep

    def on_mount(self) -> None:
        """Take the focus."""
        self.focus()

    def say(self, sentence: str) -> None:
        """Replace the sentence."""
        self._sentence = sentence
        self.refresh()

    def lift(self) -> None:
        """Uncover the screen and restore the focus."""
        keep = self._keep
        self.remove()
        self.screen.set_focus(keep if keep is not None and keep.is_attached else None)

    def on_key(self, event: events.Key) -> None:
        """Swallow all keys: nobody should answer a hidden question."""
        event.stop()

    def render_line(self, y: int) -> Strip:
        """Draw the sentence in the middle."""
        width, height = self.size
        lines = wrap(self._sentence, max(1, width - 2))
        n = y - max(0, (height - len(lines)) // 2)
        text = lines[n] if 0 <= n < len(lines) else ""
        return draw(self, ((text.center(width), "strong"),), width)


def cover_if_small(screen: Screen[Any]) -> None:
    """Cover a screen while the window is too small for it."""
    sentence = too_small(*screen.app.size)
    covers = list(screen.query_children(Cover))
    if sentence is None:
        for cover in covers:
            cover.lift()
    elif covers:
        covers[0].say(sentence)
    else:
        screen.mount(Cover(sentence, screen.focused))


async def on_top(screen: Screen[Any]) -> None:
    """Wait until a screen is on top."""
    while not screen.is_active:  # noqa: ASYNC110 - several screens may be above it
        await asyncio.sleep(0.05)


class TangyScreen(Screen[ResultT]):
    """The base class of screens. `HELP` describes the screen's purpose in a paragraph.

    The focus is restored when the screen is on top again; without a focused widget, none gets the
    focus then.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = set(INK_CLASSES)
    DEFAULT_CSS = """
    TangyScreen { layers: default cover; overflow: hidden hidden; }
    """
    HELP: ClassVar[str] = ""
    ALLOW_IN_MAXIMIZED_VIEW = ".-textual-system,StatusLine,#keys,#command"
    LETTERS_FOLLOW: ClassVar[Mapping[str, str]] = {}
    """The screen's action for each action of the keymap that opens a line or a list.

    `KeyReader` carries it out before it reads the next key. If it opens a dialog, `EarlyKeys` keeps
    the keys until the dialog has the focus.
    """

    def ask(self, dialog: Dialog[AnswerT]) -> asyncio.Future[AnswerT]:
        """Push a dialog at once, and return its answer, for a worker to await."""
        answered: asyncio.Future[AnswerT] = asyncio.get_running_loop().create_future()

        def take(answer: Any) -> None:
            if not answered.done():  # its worker may have been cancelled
                answered.set_result(answer)

        self.app.push_screen(dialog, take)
        return answered

    def close(self, result: ResultT) -> None:
        """Dismiss the screen with a result, unless it is covered or dismissed already."""
        if self.is_active:
            self.dismiss(result)

    def leave(self, result: ResultT) -> None:
        """Close the screen, if it is on top, and clear its toasts."""
        if self.is_active:
            self.app.clear_notifications()
            self.close(result)

    def take_letter(self, event: events.Key | events.Paste) -> bool:
        """Handle a key before the bindings do; return False to leave it to them.

        A screen with a command bar takes letters and pasted text here, whatever has the focus.
        """
        return False

    async def on_prune(self, event: Prune) -> None:
        """Cancel the screen's workers before its widgets are removed, because they use them."""
        self.workers.cancel_node(self)

    def on_screen_suspend(self, event: events.ScreenSuspend) -> None:
        """Remember whether the screen had a focused widget, so that the focus is restored."""
        auto = "" if self.focused is None else type(self).AUTO_FOCUS
        self.AUTO_FOCUS = auto  # type: ignore[misc]

    def on_resize(self, event: events.Resize) -> None:
        """Cover the screen if the window is too small."""
        cover_if_small(self)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Cover the screen if the window is too small."""
        cover_if_small(self)


class Dialog(ModalScreen[ResultT]):
    """A modal question or message. Only the first answer counts; STOP answers it with `no`."""

    COMPONENT_CLASSES: ClassVar[set[str]] = set(INK_CLASSES)
    DEFAULT_CSS = """
    Dialog { layers: default cover; align: center middle; overflow: hidden hidden; }
    Dialog > .box {
        width: 64;
        max-width: 96%;
        height: auto;
        max-height: 100%;
        border: round $accent;
        border-title-color: $accent;
        border-title-style: bold;
        background: $surface;
        padding: 1 2;
    }
    Dialog.-low > .box { padding: 0 2; }
    """
    VERTICAL_BREAKPOINTS = LOW_OR_TALL
    BINDINGS: ClassVar[list[BindingType]] = [
        *bind("help", "app.help", show=False),
    ]
    HELP: ClassVar[str] = ""

    def __init__(self, no: ResultT) -> None:
        super().__init__()  # no id: the next dialog may open before this one is removed
        self._no = no
        self._answered = False

    def answer(self, result: ResultT) -> None:
        """Close the dialog with a result; only the first one counts."""
        if not self._answered and self.app.screen is self:
            self._answered = True
            self.dismiss(result)

    def on_mount(self) -> None:
        """Clear the toasts, which would cover the dialog, and watch its size."""
        self.app.clear_notifications()
        if hasattr(self.below, "covered"):
            self.screen_layout_refresh_signal.subscribe(self, self._tell_below)

    def on_descendant_focus(self) -> None:
        """Take the keys that were typed for the dialog before it was there."""
        if (early := getattr(self.app, "early_keys", None)) is not None:
            self.app.call_later(early.give)

    def on_stop(self, message: Stop) -> None:
        """Answer with `no` on STOP."""
        self.answer(self._no)

    def on_resize(self, event: events.Resize) -> None:
        """Cover the dialog if the window is too small."""
        cover_if_small(self)

    @property
    def below(self) -> Screen[Any] | None:
        """The screen below the dialog."""
        stack = self.app.screen_stack
        return stack[stack.index(self) - 1] if self in stack[1:] else None

    def _tell_below(self, laid_out: Screen[Any]) -> None:
        """Tell the screen below what the dialog covers: a hint can add a line to it."""
        below: Any = self.below
        for box in self.query(".box"):
            if below is not None and box.region:
                below.covered(box.region)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Cover the dialog if the window is too small."""
        cover_if_small(self)


ACTIONS = {"palette": "command_palette", "draw": "draw_again", "begin": "play"}
"""Textual's names of keymap actions, if they differ."""

OF_SCREENS = ("why", "whose_card", "presence", "next")
"""Actions that each screen carries out in its own way."""


def can_perform(screen: Screen[Any], id: str) -> bool:
    """Return whether a screen, or the app for it, has a keymap action now."""
    if id not in OF_SCREENS:
        return True
    return hasattr(screen, f"action_{id}") and screen.check_action(id, ()) is not False


async def perform(screen: Screen[Any], id: str, on: bool | None = None) -> None:
    """Run a keymap action of a screen or the app; set a switch only if it is not already `on`."""
    app: Any = screen.app
    if id in OF_SCREENS:
        await screen.run_action(id)
        return
    if id == "voice" and on is not None and app.speaker.on == on:
        return
    if id == "listen" and on is not None and (app.hearing is None or app.hearing.on == on):
        return
    await screen.run_action(f"app.{ACTIONS.get(id, id)}")


def give_keys_back(screen: Screen[Any], widget: Widget | None) -> None:
    """Focus a widget of a screen, unless another one has the focus by now."""
    if screen.focused is None and widget is not None and widget.is_attached:
        screen.set_focus(widget)
