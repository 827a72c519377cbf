"""The microphone on one line: its state, level, words so far, and trouble."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from rich.cells import cell_len
from textual.strip import Strip
from textual.timer import Timer

from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import InkedWidget
from tangy_tui.ui.widgets.rows import Row, Span, draw, shorten

if TYPE_CHECKING:
    from tangy_hw.audio.meter import SoundTrouble

HERTZ = 10
"""The highest frame rate of the line, in Hz."""

LOOKS = 5
"""Trouble is checked once in this many frames."""

BAR = 12  # cells
GAP = 3  # cells between level and text
OPENS = ("listening", "speaking")
"""The states with an open microphone, in which level, words and trouble may change."""

STATES = {
    "starting": "getting ready ...",
    "off": "{key} talk",
    "listening": "listening{for_what} ...",
    "speaking": "hearing you ...",
    "thinking": "thinking ...",
    "shut": "shut while Tangy speaks",
    "over": "closed",
}
MARKS = {"listening": "●", "speaking": "●", "off": "○", "shut": "○", "over": "○", "thinking": "○"}
"""The mark before the state: a filled dot while the microphone is open."""
RECORDING = "◉ rec"
HINTS = {
    "off": "then say what Tangy should do",
    "listening": "{key} ends it",
    "speaking": "{key} ends it",
}
"""The hint of push-to-talk while there are no words yet."""


class Level(Protocol):
    """A sound level."""

    @property
    def level(self) -> float:
        """The level, from 0 to 1."""


class Microphone(Protocol):
    """The interface to the microphone; see `SpeechInput`."""

    @property
    def live(self) -> bool:
        """Whether the sound is live, rather than a recording."""

    @property
    def hands_free(self) -> bool:
        """Whether the microphone is always open."""

    @property
    def state(self) -> str:
        """Its state."""

    @property
    def words(self) -> str:
        """The words so far."""

    @property
    def trouble(self) -> SoundTrouble | None:
        """The trouble with the sound, None if there is none."""

    @property
    def records(self) -> bool:
        """Whether the sound is recorded."""

    @property
    def meter(self) -> Level:
        """The level meter."""


class MicrophoneLine(InkedWidget):
    """One line; costs nothing while the microphone is closed.

    Call `look` when the state or the words may have changed. Level and trouble are polled at most
    ten times a second, and redrawn when they change.
    """

    DEFAULT_CSS = """
    MicrophoneLine { height: 1; padding: 0 1; background: $panel; }
    """

    def __init__(
        self, ears: Microphone, expects: Callable[[], str] = str, *, id: str | None = "microphone"
    ) -> None:
        """Create the line; `expects` names what alone the recogniser listens for ("": commands)."""
        super().__init__(id=id)
        self.ears = ears
        self._expects = expects
        self._row: Row = ()
        self._trouble = ""
        self.ticks = 0
        self.timer: Timer | None = None

    @property
    def text(self) -> str:
        """Its text."""
        return "".join(text for text, _ in self._row)

    def on_mount(self) -> None:
        """Create the paused timer that follows the level."""
        self.timer = self.set_interval(1 / HERTZ, self.tick, pause=True)
        self.look()

    def on_resize(self) -> None:
        """Redraw at the new size."""
        self._show()

    def look(self) -> None:
        """Show the changes; while the microphone is open, words are drawn with the level."""
        if self.timer is None:
            return
        follows = self.ears.live and self.ears.state in OPENS
        if follows:
            self.timer.resume()
        else:
            self.timer.pause()
            self.ticks, self._trouble = 0, ""
        if not follows or not self._row or self._row[0] != self._state():
            self._show()

    def render_line(self, y: int) -> Strip:
        """Draw the line."""
        return draw(self, self._row, self.size.width)

    def tick(self) -> None:
        """Redraw level and words, and check for trouble from time to time."""
        if self.ticks % LOOKS == 0:
            from tangy_tui.text.mic_check import trouble_words  # not before the first frame

            trouble = self.ears.trouble
            self._trouble = "" if trouble is None else trouble_words(trouble)
        self.ticks += 1
        self._show()

    def _show(self) -> None:
        row = self._written(self.size.width)
        if row != self._row:
            self._row = row
            if self.is_attached:
                self.refresh()

    @property
    def _key(self) -> str:
        """The push-to-talk key: if an input line takes letters, a control key."""
        from textual.widgets import Input

        typing = isinstance(self.screen.focused, Input)
        return "t" if self.screen.is_active and not typing else "ctrl+t"

    def _state(self) -> tuple[str, str]:
        ears = self.ears
        only = self._expects()
        words = STATES.get(ears.state, ears.state)
        words = words.format(key=self._key, for_what=f" for {only}" if only else "")
        if not ears.live and ears.state == "over":
            words = "the recording is over"
        ink = "good" if ears.state in OPENS else "warn" if ears.state == "shut" else "text"
        return (f"{MARKS.get(ears.state, ' ')} {words}", ink)

    def _written(self, width: int) -> Row:
        ears = self.ears
        if not self.is_attached:
            return ()
        row: list[Span] = [self._state()]
        if ears.records and ears.state != "over":
            row.append((f"  {RECORDING}", "warn"))
        if ears.live and ears.state in OPENS:
            full = round(BAR * min(1.0, max(0.0, ears.meter.level)))
            row += [("  ", "text"), ("■" * full, "curve"), ("·" * (BAR - full), "dim")]
        if self._trouble:
            trouble = f"! {self._trouble}"
            while row and _cells(row) + GAP + cell_len(trouble) > width:
                row.pop()  # trouble is shown in full
            gap = " " * GAP if row else ""
            return (*row, (f"{gap}{shorten(trouble, width)}", "warn"))
        left = width - _cells(row) - GAP
        text = ""
        if ears.words:
            text = _end(clean(ears.words), left)
        elif ears.live and not ears.hands_free and not self._expects():
            text = shorten(HINTS.get(ears.state, "").format(key=self._key), left)
        return (*row, (f"{' ' * GAP}{text}", "dim")) if text else tuple(row)


def _cells(row: list[Span]) -> int:
    return sum(cell_len(text) for text, _ in row)


def _end(words: str, width: int) -> str:
    """Cut words to their end, which is being said now."""
    if cell_len(words) <= width:
        return words
    kept = words
    while kept and cell_len(kept) > width - 1:
        kept = kept.partition(" ")[2] or kept[1:]
    return f"…{kept}"
