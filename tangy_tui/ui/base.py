"""What all screens and dialogs share: help of their own, and a cover when there is no room."""

from __future__ import annotations

import asyncio
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
from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import draw
from tangy_tui.ui.widgets.wrapping import wrap

LOW_OR_TALL = [(0, "-low"), (22, "-tall")]
"""The class that a dialog has from so many lines on."""

ResultT = TypeVar("ResultT")


class Cover(Inked, can_focus=True):
    """Covers a screen that has too little room with one sentence, and takes the keys meanwhile."""

    DEFAULT_CSS = """
    Cover { layer: cover; dock: top; width: 100%; height: 100%; background: $background; }
    """

    def __init__(self, sentence: str, keep: Widget | None) -> None:
        super().__init__()
        self._sentence = sentence
        self._keep = keep

    def on_mount(self) -> None:
        """Take the keys."""
        self.focus()

    def say(self, sentence: str) -> None:
        """Say something else."""
        self._sentence = sentence
        self.refresh()

    def lift(self) -> None:
        """Uncover the screen and give the keys back."""
        keep = self._keep
        self.remove()
        self.screen.set_focus(keep if keep is not None and keep.is_attached else None)

    def on_key(self, event: events.Key) -> None:
        """Let no key through: nobody should answer what they cannot see."""
        event.stop()

    def render_line(self, y: int) -> Strip:
        """Draw the sentence in the middle."""
        width, height = self.size
        lines = wrap(self._sentence, max(1, width - 2))
        n = y - max(0, (height - len(lines)) // 2)
        text = lines[n] if 0 <= n < len(lines) else ""
        return draw(self, ((text.center(width), "strong"),), width)


def cover_if_small(screen: Screen[Any]) -> None:
    """Cover a screen while the window is too small for it, uncover it when it is large enough."""
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
    """Wait until no dialog, help or other screen lies over a screen."""
    while not screen.is_active:  # noqa: ASYNC110 - what lies over it may itself be covered
        await asyncio.sleep(0.05)


class TangyScreen(Screen[ResultT]):
    """A screen of the program. `HELP` tells in a paragraph what it is for.

    What has the keys keeps them while something lies over the screen; where nothing has them,
    nothing takes them afterwards.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = set(INK_CLASSES)
    DEFAULT_CSS = """
    TangyScreen { layers: default cover; overflow: hidden hidden; }
    """
    HELP: ClassVar[str] = ""
    ALLOW_IN_MAXIMIZED_VIEW = ".-textual-system,StatusLine,#keys,#command"

    def close(self, result: ResultT) -> None:
        """Dismiss the screen with a result, unless it is covered or has been dismissed already."""
        if self.is_active:
            self.dismiss(result)

    def take_letter(self, event: events.Key | events.Paste) -> bool:
        """Handle a key before the bindings see it; return False to leave it to them.

        A screen on which people type commands takes letters here, wherever the keys are, and
        text that is pasted.
        """
        return False

    async def on_prune(self, event: Prune) -> None:
        """End what goes on beside the screen before its panels go: it writes on them."""
        self.workers.cancel_node(self)

    def on_screen_suspend(self, event: events.ScreenSuspend) -> None:
        """Remember whether the keys were the screen's own, so that they are so again."""
        auto = "" if self.focused is None else type(self).AUTO_FOCUS
        self.AUTO_FOCUS = auto  # type: ignore[misc]

    def on_resize(self, event: events.Resize) -> None:
        """Cover the screen if it has too little room."""
        cover_if_small(self)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Cover the screen if it has too little room."""
        cover_if_small(self)


class Dialog(ModalScreen[ResultT]):
    """A question or a message over a screen. It is answered once; STOP answers it with `no`."""

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
        super().__init__()  # no id: the next dialog may come before this one is gone
        self._no = no
        self._answered = False

    def answer(self, result: ResultT) -> None:
        """Close the dialog with a result; only the first one counts."""
        if not self._answered and self.app.screen is self:
            self._answered = True
            self.dismiss(result)

    def on_mount(self) -> None:
        """Clear the toasts, which would lie over the dialog."""
        self.app.clear_notifications()

    def on_stop(self, message: Stop) -> None:
        """Take STOP for a no."""
        self.answer(self._no)

    def on_resize(self, event: events.Resize) -> None:
        """Cover the dialog if it has too little room."""
        cover_if_small(self)

    def on_screen_resume(self, event: events.ScreenResume) -> None:
        """Cover the dialog if it has too little room."""
        cover_if_small(self)
