"""The verification of a command (III-A-1): a pop-up names the behaviour that was understood."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.fresh_keys import Clock, FreshKeys, clock_of
from tangy_tui.ui.widgets.rows import shorten

MOST_ALTERNATIVES = 3
LONGEST_HEARD = 100  # characters: two lines


@dataclass(frozen=True, slots=True)
class Answer:
    """What the teacher said: yes, or no, or no but the alternative of this index (from 0)."""

    yes: bool
    alternative: int | None = None


NO = Answer(False)


class QuestionDialog(Dialog[Answer]):
    """Asks "Did you say: call number?" and takes y for yes, n or esc for no, 1-3 for another.

    Only y and Y execute. Enter and space do nothing. Keys that were typed before the question was
    on the screen do not answer it. On a no the caller puts the text back into the command bar; an
    alternative is verified again by the caller, with a question of its own.
    """

    DEFAULT_CSS = """
    QuestionDialog > .box { width: 60; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "Yes, do it"),
        Binding("n", "nothing", "No, a new command"),
        Binding("1", "nothing", "Take another behaviour", key_display="1-3"),
    ]
    HELP = (
        "Tangy never moves on a guess: it names the behaviour that it understood and waits. "
        "Press y to have it done, n or esc to give the command again, or the number of another "
        "behaviour, which is asked about again."
    )

    def __init__(
        self,
        behaviour: str,
        *,
        heard: str = "",
        confidence: float | None = None,
        alternatives: Sequence[str] = (),
        clock: Clock | None = None,
    ) -> None:
        """Make the question.

        Args:
            behaviour: what was understood, in the words of the activity (with whom, if need be).
            heard: the words that it was understood from.
            confidence: from 0 to 1.
            alternatives: other behaviours it may have been; the first three are offered.
            clock: seconds, on the scale of `time.monotonic` (default: the app's).
        """
        super().__init__(NO)
        self._behaviour = clean(behaviour)
        self._heard = shorten(clean(heard), LONGEST_HEARD)
        self._confidence = confidence
        self._alternatives = tuple(clean(a) for a in alternatives[:MOST_ALTERNATIVES])
        self._numbers = ("1", "2", "3")[: len(self._alternatives)]
        self._clock = clock
        self._keys = FreshKeys()

    @property
    def behaviour(self) -> str:
        """What is asked about."""
        return self._behaviour

    def compose(self) -> ComposeResult:
        """Lay out question, keys, and what it rests on."""
        box = Static(self._content(), id="question", classes="box")
        box.border_title = "Question"
        yield box

    def on_mount(self) -> None:
        """Take note of the moment from which keys count."""
        self.call_after_refresh(self._keys.painted, self._clock or clock_of(self.app))

    def on_key(self, event: events.Key) -> None:
        """Answer by y, n, esc or a number, if the question was on the screen by then."""
        if not self._keys.take(event):
            return
        if event.key in ("y", "Y"):
            self.answer(Answer(True))
        elif event.key in ("n", "N", "escape"):
            self.answer(NO)
        elif event.key in self._numbers:
            self.answer(Answer(False, self._numbers.index(event.key)))

    def action_nothing(self) -> None:
        """Do nothing: `on_key` has the keys, so that each can be looked at."""

    def _content(self) -> Content:
        parts: list[str | tuple[str, str] | Content] = [
            "Did you say: ",
            (self._behaviour, "$accent"),
            "?\n\n",
            ("Y", "$success bold"),
            "  yes, do it\n",
            ("N", "$error bold"),
            "  no, I give the command again",
        ]
        if self._heard:
            parts += ["\n\n", ("Heard       ", "$ink-dim"), self._heard]
        if self._confidence is not None:
            parts += [
                "\n" if self._heard else "\n\n",
                ("Confidence  ", "$ink-dim"),
                f"{self._confidence:.2f}",
            ]
        if self._alternatives:
            parts += ["\n\n", ("Or did you mean", "$ink-dim")]
            for number, alternative in zip(self._numbers, self._alternatives, strict=True):
                parts += ["\n", (number, "$primary bold"), f"  {alternative}"]
        return Content.assemble(*parts)
