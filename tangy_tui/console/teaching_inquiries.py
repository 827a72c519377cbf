"""Questions of a teacher in the console: help, situation, explanation, coverage."""

from __future__ import annotations

from collections.abc import Callable

from tangy_tui.app.inquiry_grammar import Inquiry
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.coach import coach_words, with_examples
from tangy_tui.text.learnt import NOT_SHOWN
from tangy_tui.text.situations import state_words
from tangy_tui.text.teaching import now_words
from tangy_tui.text.teaching_commands import HELP, MEANINGS


class TeachingInquiries:
    """Answers typed questions about a teaching session."""

    def __init__(
        self,
        teaching: TeachingSession,
        seen: Callable[[], list[str]],
        why: Callable[[], list[str]],
    ) -> None:
        """Answer with the coverage (`seen`) and the explanations (`why`) of a session."""
        self._teaching = teaching
        self._seen, self._why = seen, why

    def lines(self, what: Inquiry) -> list[str]:
        """Return the answer to a question."""
        match what:
            case "shown":
                count, *missing = self._seen() or [""]
                return [count, *([NOT_SHOWN, *missing] if missing else ())]
            case "why":
                return self._why()
            case "where":
                return [self.where(fully=True)]
        behaviours = self._teaching.activity.behaviours.values()
        return [
            HELP,
            *(f"  {one.question}: say {one.phrases[0]!r}" for one in behaviours),
            *(f"  {word}: {meaning}" for word, meaning in MEANINGS),
        ]

    def where(self, *, fully: bool = False) -> str:
        """Describe the present situation."""
        teaching = self._teaching
        state, scene = teaching.world.observe(), teaching.world.scene()
        activity, name = teaching.activity, teaching.name
        said = coach_words(activity, state, scene, name)
        words = with_examples(said, activity, state, teaching.sayable)
        if fully:
            words = f"{activity.in_words(state.situation)}. "
            words += state_words(activity, state, scene, name)
        return now_words(words)
