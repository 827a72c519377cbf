"""The microphone on one line: what it does, how loud it is, the words so far, and what is wrong."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from rich.cells import cell_len
from textual.strip import Strip
from textual.timer import Timer

from tangy_tui.text.microphone import trouble_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.inks import Inked
from tangy_tui.ui.widgets.rows import Row, Span, draw, shorten

if TYPE_CHECKING:
    from tangy_hw.audio.meter import SoundTrouble

HERTZ = 10
"""How often the line may be drawn in a second."""

LOOKS = 5
"""Every so many drawings it is asked whether something is wrong."""

BAR = 12  # cells
GAP = 3  # cells between level and text
OPENS = ("listening", "speaking")
"""The states in which the microphone is open, so that level, words and trouble may change."""

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
"""What stands before the state: a filled dot while the microphone is open."""
RECORDING = "◉ rec"
HINTS = {
    "off": "then say what Tangy should do",
    "listening": "{key} ends it",
    "speaking": "{key} ends it",
}
"""What push-to-talk adds, while there are no words yet."""


class Level(Protocol):
    """How loud it is."""

    @property
    def level(self) -> float:
        """The loudness, from 0 to 1."""


class Microphone(Protocol):
    """What the line shows; see `Ears`."""

    @property
    def live(self) -> bool:
        """Whether somebody speaks now, rather than on a recording."""

    @property
    def hands_free(self) -> bool:
        """Whether it is open all the time."""

    @property
    def state(self) -> str:
        """What it is doing."""

    @property
    def words(self) -> str:
        """The words so far."""

    @property
    def trouble(self) -> SoundTrouble | None:
        """The fault; None if there is none."""

    @property
    def records(self) -> bool:
        """Whether what is said is kept."""

    @property
    def meter(self) -> Level:
        """How loud it is."""


class MicrophoneLine(Inked):
    """One line; while the microphone is not open, it costs nothing.

    `look` is to be called when state or words may have changed. Level and trouble are looked at
    ten times a second at most, and drawn when they are others.
    """

    DEFAULT_CSS = """
    MicrophoneLine { height: 1; padding: 0 1; background: $panel; }
    """

    def __init__(
        self, ears: Microphone, expects: Callable[[], str] = str, *, id: str | None = "microphone"
    ) -> None:
        """Make the line; `expects` says what alone is listened for ("": commands)."""
        super().__init__(id=id)
        self.ears = ears
        self._expects = expects
        self._row: Row = ()
        self._trouble = ""
        self.ticks = 0
        self.timer: Timer | None = None

    @property
    def text(self) -> str:
        """What it says."""
        return "".join(text for text, _ in self._row)

    def on_mount(self) -> None:
        """Prepare to follow the level."""
        self.timer = self.set_interval(1 / HERTZ, self.tick, pause=True)
        self.look()

    def on_resize(self) -> None:
        """Use the room there is."""
        self._show()

    def look(self) -> None:
        """Show what has changed; words that come while it is open are drawn with the level."""
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
        """Look at level and words, and now and then at what is wrong."""
        if self.ticks % LOOKS == 0:
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
        """The key that is pushed to talk: in a line to type in, a letter is a letter."""
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
                row.pop()  # what is wrong is to be read whole
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
    """Return the end of words that are too long: what is being said now is looked for."""
    if cell_len(words) <= width:
        return words
    kept = words
    while kept and cell_len(kept) > width - 1:
        kept = kept.partition(" ")[2] or kept[1:]
    return f"…{kept}"
