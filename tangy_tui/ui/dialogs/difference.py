"""The rows in which a policy differs from the stored one, shown before it is used."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, Literal

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content

from tangy_profiles.activity import Activity
from tangy_tui.learning.policies import DecisionChange
from tangy_tui.text.policies import NOT_AS_KEPT, OTHER_DECISIONS, SAME_DECISIONS, change_words
from tangy_tui.ui.base import Dialog
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.type_ahead_guard import Clock, FreshKeys
from tangy_tui.ui.widgets.page import Page, PageLine, heading, paragraph

Use = Literal["use", "keep", "back"]
"""What to do with the policy: use it once, store and use it, or not use it."""

ANSWERS: dict[str, Use] = {"y": "use", "1": "keep", "n": "back", "escape": "back"}


class DifferenceDialog(Dialog[Use]):
    """Tells why the policy differs, shows the rows, and asks before using it."""

    DEFAULT_CSS = """
    DifferenceDialog > .box { width: 76; padding: 0 1; }
    DifferenceDialog Page { height: auto; max-height: 1fr; }
    """
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y", "nothing", "Use it this time"),
        Binding("1", "nothing", "Keep it as it is now, and use it"),
        Binding("n", "nothing", "Go back, and do not use it"),
    ]
    HELP = (
        "The policy was learnt again from its demonstrations, and did not come out as it was "
        "kept. Look at the rows that differ: y uses it this time, 1 keeps it as it is now, so "
        "that it is not asked about again, and n or esc goes back."
    )

    def __init__(
        self,
        activity: Activity,
        notice: str,
        changes: Sequence[DecisionChange],
        *,
        clock: Clock | None = None,
    ) -> None:
        super().__init__("back")
        self._activity = activity
        self._notice = notice
        self._changes = tuple(changes)
        self._clock = clock
        self.fresh_keys = FreshKeys()

    def compose(self) -> ComposeResult:
        """Lay out the notice, the rows, and the keys."""
        box = Vertical(Page(self._write), id="difference", classes="box")
        box.border_title = Content(NOT_AS_KEPT)
        box.border_subtitle = "y use it   1 keep it so   n go back"
        yield box

    def on_mount(self) -> None:
        """Focus the page, and accept keys from now on."""
        self.query_one(Page).focus()
        self.fresh_keys.watch(self, self._clock)

    def on_key(self, event: events.Key) -> None:
        """Answer with y, 1, n or esc; the arrows scroll."""
        answer = ANSWERS.get(event.key.lower())
        if answer is not None and self.fresh_keys.take(event):
            self.answer(answer)

    def action_nothing(self) -> None:
        """Do nothing: `on_key` handles the keys, to check each of them."""

    def _write(self, width: int) -> list[PageLine]:
        lines = paragraph(clean(self._notice), width)
        if not self._changes:
            return [*lines, *paragraph(SAME_DECISIONS, width)]
        lines += heading(OTHER_DECISIONS)
        for change in self._changes:
            words = clean(self._activity.in_words(change.situation))
            lines += paragraph(words, width, "strong")
            was_and_is = clean(change_words(change.before, change.after))
            lines += paragraph(f"  {was_and_is}", width)
        return lines
