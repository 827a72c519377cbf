"""A remark on the last step, instead of the command bar: a number answers it, esc postpones it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from rich.cells import cell_len
from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.app.spoken_answers import answer_by_yes_or_no
from tangy_tui.learning.remarks import answers_to
from tangy_tui.learning.teaching_events import Remark, RemarkAnswer
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.hearing import SAID_TOO_EARLY
from tangy_tui.text.questions import TOO_EARLY
from tangy_tui.text.remarks import (
    LEARN_LATER,
    NUMBER_OR_ESC,
    SAY_A_NUMBER,
    answer_words,
    later_words,
    remark_words,
    sayable_words,
)
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.keys import bind, keymap_of
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys

GAP = 3
"""Cells between two answers."""
SIDE = 1
"""Cells at each side of the dialog."""


class RemarkDialog(Dialog[RemarkAnswer]):
    """Tells what may have been overlooked; a number answers it, esc postpones it."""

    DEFAULT_CSS = f"""
    RemarkDialog {{ align: left bottom; background: transparent; }}
    RemarkDialog > .box {{
        width: 100%; max-width: 100%; border: none; padding: 0 {SIDE}; background: $surface;
    }}
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("1", "nothing", "The answer of this number", key_display="1-4"),
        *bind("undo"),
        *bind("learn", "nothing", name=LEARN_LATER),
        Binding("escape", "nothing", "Decide later"),
    ]
    HELP = (
        "Your step differs from what was shown before, or something may have been overlooked. The "
        "number of an answer gives it, and Tangy learns by that. Esc leaves it open: you are asked "
        "once more before Tangy learns, and not again while you teach."
    )

    def __init__(
        self,
        sentence: str,
        answers: Sequence[tuple[RemarkAnswer, str]],
        later: str,
        *,
        aloud: str = "",
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            sentence: the remark.
            answers: the possible answers with their words; 1 gives the first.
            later: the action of esc, in words.
            aloud: the words before the spoken answers, "" if answers cannot be spoken.
            clock: returns seconds, on the scale of `time.monotonic` (default: the app's clock).
        """
        super().__init__("later")
        self._sentence = clean(sentence)
        self._answers = {str(n): (a, clean(words)) for n, (a, words) in enumerate(answers, 1)}
        self._later = later
        self._say = clean(aloud)
        self._clock = clock
        self._keys = FreshKeys()
        self._told = ""
        self.learns = False
        """Whether the teacher has put it off in order to let Tangy learn."""

    def compose(self) -> ComposeResult:
        """Lay out the remark and the answers."""
        yield Static(self._content(), id="remark", classes="box")

    def on_mount(self) -> None:
        """Accept keys from now on."""
        self._keys.watch(self, self._clock)

    def on_resize(self, event: events.Resize) -> None:
        """Keep each key and its words in one line."""
        self.query_one("#remark", Static).update(self._content())

    def on_key(self, event: events.Key) -> None:
        """Answer with a number or esc, if the remark was visible before."""
        if keymap_of(self.app).action(event.key) == "undo":
            return  # it means the last step, whether or not the remark was seen
        learns = keymap_of(self.app).action(event.key) == "learn"
        known = event.key == "escape" or event.key in self._answers or learns
        if not self._keys.take(event):
            self._tell(TOO_EARLY if known else NUMBER_OR_ESC)
        elif event.key == "escape" or learns:
            self.learns = learns
            self.answer("later")
        elif known:
            self.answer(self._answers[event.key][0])
        elif keymap_of(self.app).action(event.key) != "help":
            self._tell(NUMBER_OR_ESC)

    def action_undo(self) -> None:
        """Take the step back that the remark is about."""
        self.answer("undo")

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    @property
    def painted(self) -> bool:
        """Whether it is visible, so that it can be answered."""
        return self._keys.seen

    @property
    def choices(self) -> tuple[str, ...]:
        """The answers in words, which can be spoken too."""
        return tuple(words for _, words in self._answers.values())

    def hear(self, *, yes: bool, alternative: int | None = None) -> str:
        """Handle a spoken answer; return the problem with it, "" if there is none."""
        if not self.painted:
            return SAID_TOO_EARLY
        kinds = tuple(answer for answer, _ in self._answers.values())
        if alternative is not None:
            answer = kinds[alternative - 1] if alternative <= len(kinds) else None
        else:
            answer = answer_by_yes_or_no(kinds, yes=yes)
        if answer is None:
            return SAY_A_NUMBER
        self.answer(answer)
        return ""

    def tell(self, sentence: str, colour: str = "") -> None:
        """Show a sentence about speech input; it has the colour of a warning."""
        if self.is_attached:
            self._tell(clean(sentence))

    def _tell(self, sentence: str) -> None:
        if sentence != self._told:
            self._told = sentence
            self.query_one("#remark", Static).update(self._content())

    def _content(self) -> Content:
        parts: list[str | tuple[str, str] | Content] = [(self._sentence, "$warning")]
        left = 0  # cells of the line
        answers = ((number, words) for number, (_, words) in self._answers.items())
        for key, words in (*answers, ("esc", self._later)):
            cells = len(key) + 1 + cell_len(words)
            fits = GAP + cells <= left
            parts += [" " * GAP if fits else "\n", (key, "$primary bold"), f" {words}"]
            left = (left - GAP if fits else self.app.size.width - 2 * SIDE) - cells
        if self._say:
            kinds = tuple(answer for answer, _ in self._answers.values())
            parts += ["\n", (f"{self._say} {sayable_words(kinds)}.", "$ink-dim")]
        if self._told:
            parts += ["\n", (self._told, "$warning")]
        return Content.assemble(*parts)


def remark_dialog(remark: Remark, teaching: TeachingSession, aloud: str = "") -> RemarkDialog:
    """Create the dialog for a remark of a session; `aloud` as in `RemarkDialog`."""
    activity, game = teaching.activity, teaching.demonstration.id
    answers = zip(answers_to(remark), answer_words(remark, activity), strict=True)
    sentence = remark_words(remark, activity, teaching.name, game)
    return RemarkDialog(sentence, list(answers), later_words(remark), aloud=aloud)
