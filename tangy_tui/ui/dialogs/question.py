"""The verification of a command (III-A-1): a pop-up names the recognised behaviour.

If recognition is unsure, it offers up to three behaviours; a chosen one is then verified in turn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from textual.binding import Binding, BindingType
from textual.content import Content
from textual.widgets import Static

from tangy_tui.learning.verification import Asked, Offered, Reply
from tangy_tui.text.hearing import SAID_TOO_EARLY
from tangy_tui.text.questions import (
    DID_YOU_MEAN,
    DID_YOU_SAY,
    NUMBER_OR_NONE,
    OR_DID_YOU_MEAN,
    TOO_EARLY,
    YES_OR_NO,
    yes_words,
)
from tangy_tui.text.refusals import WHICH
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys, yes_key_of
from tangy_tui.ui.widgets.rows import shorten

if TYPE_CHECKING:
    from textual import events
    from textual.app import ComposeResult

MOST_ALTERNATIVES = 3
LONGEST_HEARD = 100  # characters: two lines
LONGEST_TOLD = 150  # characters: three lines
HEARD, TYPED = "heard", "typed"
SURE = "sure"


@dataclass(frozen=True, slots=True)
class Answer:
    """The teacher's answer: yes, no, or the alternative with this index (from 0)."""

    yes: bool
    alternative: int | None = None

    @property
    def reply(self) -> Reply:
        """The answer in the form that a session takes."""
        return Reply(self.yes, None if self.alternative is None else self.alternative + 1)


NO = Answer(False)

Parts = list[str | tuple[str, str] | Content]


class VerifyingDialog(Dialog[Answer]):
    """Base of both dialogs: the recognised words, numbered choices, and guarded keys.

    It replaces the command bar, so that little changes on the screen. Enter and space do nothing.
    Keys typed, or words spoken, before it was visible do not answer it. On a no, the caller puts
    the text back into the command bar.
    """

    DEFAULT_CSS = """
    VerifyingDialog { align: left bottom; background: transparent; }
    VerifyingDialog > .box {
        width: 100%; max-width: 100%; border: none; padding: 0 1; background: $surface;
    }
    """
    ID: ClassVar[str]
    typed = False
    """Whether the words were typed, and not spoken; set before it is shown."""

    def __init__(
        self,
        *,
        heard: str = "",
        confidence: float | None = None,
        choices: Sequence[str] = (),
        aloud: str = "",
        clock: Clock | None = None,
    ) -> None:
        """Create the dialog.

        Args:
            heard: the recognised words.
            confidence: of the recognition, from 0 to 1.
            choices: behaviours in the words of the activity; the first three are offered.
            aloud: the words before the spoken answers ("Or say"), "" if answers cannot be spoken.
            clock: returns seconds, on the scale of `time.monotonic` (default: the app's clock).
        """
        super().__init__(NO)
        self._heard = shorten(clean(heard), LONGEST_HEARD)
        self._confidence = confidence
        self._choices = tuple(clean(choice) for choice in choices[:MOST_ALTERNATIVES])
        self._numbers = ("1", "2", "3")[: len(self._choices)]
        self._say = clean(aloud)
        self._told: tuple[str, str] | None = None  # a sentence and its colour
        self._clock = clock
        self._keys = FreshKeys()
        self.yes_key = "y"

    @property
    def painted(self) -> bool:
        """Whether it is visible, so that it can be answered."""
        return self._keys.seen

    def compose(self) -> ComposeResult:
        """Lay out question, keys, and the recognised words."""
        self.yes_key = yes_key_of(self.app)
        yield Static(self._content(), id=self.ID, classes="box")

    def on_mount(self) -> None:
        """Accept keys from now on."""
        self._keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Answer with the key for yes, n, esc or a number, if the question was visible before."""
        key = event.key.lower()
        if not self._keys.take(event):
            if key in (self.yes_key, "y", "n", "escape", *self._numbers):
                self.tell(TOO_EARLY, "$warning")
        elif key == self.yes_key:
            self._yes()
        elif key == "y":
            self.tell(yes_words(self.yes_key), "$warning")
        elif key in ("n", "escape"):
            self.answer(NO)
        elif key in self._numbers:
            self.answer(Answer(False, self._numbers.index(key)))

    @property
    def choices(self) -> tuple[str, ...]:
        """The choices, by number or by their words."""
        return self._choices

    def hear(self, *, yes: bool, alternative: int | None = None) -> str:
        """Handle a spoken answer; return the problem with it, "" if there is none."""
        if not self.painted:
            return SAID_TOO_EARLY
        if alternative is not None and alternative <= len(self._choices):
            self.answer(Answer(False, alternative - 1))
            return ""
        if yes:
            return self._yes()
        self.answer(NO)
        return ""

    def tell(self, sentence: str, colour: str = "$foreground") -> None:
        """Show a sentence about speech input at the foot, instead of the last one; "" shows none.

        The dialog may cover the log, which also has the sentence.
        """
        told = (shorten(clean(sentence), LONGEST_TOLD), colour) if sentence else None
        if told != self._told and self.is_attached:
            self._told = told
            self._write()

    def on_resize(self, event: events.Resize) -> None:
        """Show as much as fits."""
        if self._told is not None:
            self._write()

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    def _write(self) -> None:
        self.query_one(f"#{self.ID}", Static).update(self._content())

    def _yes(self) -> str:
        """Handle a yes; return the problem with it."""
        raise NotImplementedError

    @property
    def _sayable(self) -> str:
        """The answers that can be spoken."""
        return YES_OR_NO

    def _content(self) -> Content:
        """Format the question."""
        raise NotImplementedError

    def _listed(self, before: str = "   ") -> Parts:
        parts: Parts = []
        for number, choice in zip(self._numbers, self._choices, strict=True):
            parts += [before, (number, "$primary bold"), f" {choice}"]
        return parts

    def _grounds(self) -> Parts:
        grounds: list[Parts] = []
        if self._heard:
            told = TYPED if self.typed else HEARD
            grounds.append([(f"{told} ", "$ink-dim"), self._heard])
        if self._confidence is not None:
            grounds.append([f"{self._confidence:.0%}", (f" {SURE}", "$ink-dim")])
        parts: Parts = []
        for ground in grounds:
            parts += ["   " if parts else "\n", *ground]
        return parts

    def _foot(self) -> Parts:
        parts: Parts = []
        if self._say:
            parts += ["\n", (f"{self._say} {self._sayable}.", "$ink-dim")]
        if self._told is not None:
            parts += ["\n", self._told]
        return parts


class QuestionDialog(VerifyingDialog):
    """Asks "Did you say: call number?" : y is yes, n or esc no, 1-3 another behaviour.

    Only y and Y execute. The caller verifies an alternative with another question.
    """

    ID = "question"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "Yes, do it"),
        Binding("n", "nothing", "No, a new command"),
        Binding("1", "nothing", "Take another behaviour", key_display="1-3"),
    ]
    HELP = (
        "Tangy never moves on a guess: it names the behaviour that it understood and waits. "
        "Press {yes} to do it, n or esc to give the command again, or the number of another "
        "behaviour; Tangy then asks about that one."
    )

    def __init__(
        self,
        behaviour: str,
        *,
        heard: str = "",
        confidence: float | None = None,
        alternatives: Sequence[str] = (),
        aloud: str = "",
        clock: Clock | None = None,
    ) -> None:
        """Create the question.

        Args:
            behaviour: the recognised behaviour, in the words of the activity, with its target if
                any.
            heard: the typed or recognised words.
            confidence: of the recognition, from 0 to 1.
            alternatives: other possible behaviours; the first three are offered.
            aloud: the words before the spoken answers, "" if answers cannot be spoken.
            clock: returns the time, in s.
        """
        super().__init__(
            heard=heard, confidence=confidence, choices=alternatives, aloud=aloud, clock=clock
        )
        self._behaviour = clean(behaviour)

    @property
    def behaviour(self) -> str:
        """The behaviour in question."""
        return self._behaviour

    def _yes(self) -> str:
        self.answer(Answer(True))
        return ""

    def _content(self) -> Content:
        parts: Parts = [
            DID_YOU_SAY,
            (self._behaviour, "$accent bold"),
            "?",
            *self._grounds(),
            "\n",
            (self.yes_key.upper(), "$success bold"),
            " yes, do it   ",
            ("N", "$error bold"),
            " no, let me change it",
        ]
        if self._choices:
            parts += ["\n", (OR_DID_YOU_MEAN, "$ink-dim"), *self._listed()]
        return Content.assemble(*parts, *self._foot())


class ChoicesDialog(VerifyingDialog):
    """Asks "Did you mean" with up to three choices: 1-3 choose one, which is then verified.

    n or esc choose none. A yes only chooses if there is a single choice.
    """

    ID = "choices"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("1", "nothing", "Ask me about this one", key_display="1-3"),
        Binding("n", "nothing", "None of these, a new command"),
    ]
    HELP = (
        "Tangy is not sure what it heard, and does nothing on a guess. Press the number of what "
        "you meant: it is asked about before it is done. n or esc: none of these; "
        "give the command again."
    )

    def _yes(self) -> str:
        if len(self._choices) != 1:
            return WHICH
        self.answer(Answer(False, 0))
        return ""

    @property
    def _sayable(self) -> str:
        return YES_OR_NO if len(self._choices) == 1 else NUMBER_OR_NONE

    def _content(self) -> Content:
        return Content.assemble(
            (DID_YOU_MEAN, "$accent bold"),
            *self._listed("\n"),
            *self._grounds(),
            "\n",
            ("N", "$error bold"),
            " none of these, let me change it",
            *self._foot(),
        )


def dialog_for(question: Asked | Offered, aloud: str = "") -> VerifyingDialog:
    """Create the dialog for a session's question; exactly typed words are not repeated."""
    dialog: VerifyingDialog
    if isinstance(question, Offered):
        dialog = ChoicesDialog(
            heard=question.heard,
            confidence=None if question.confidence >= 1 else question.confidence,
            choices=question.questions,
            aloud=aloud,
        )
    else:
        certain = question.confidence >= 1
        dialog = QuestionDialog(
            question.question,
            heard="" if certain else question.heard,
            confidence=None if certain else question.confidence,
            alternatives=question.others,
            aloud=aloud,
        )
    dialog.typed = question.typed
    return dialog
