"""One answer to a situation, with the steps that gave it: a column beside other answers."""

from __future__ import annotations

from collections.abc import Sequence

from textual.message import Message

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.conflicts import DemonstratedStep
from tangy_tui.learning.library_entries import Library
from tangy_tui.text.conflicts import ANSWER_HELP
from tangy_tui.text.numbers import often
from tangy_tui.text.times import local_time
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choice_list import ChoiceLine, ChoiceList
from tangy_tui.ui.widgets.rows import shorten

LINES_OF_A_STEP = 3


class AnswerSteps(ChoiceList):
    """The steps with one answer: where, by whom, and what followed; Enter opens one."""

    class Chosen(Message):
        """A step was chosen with Enter."""

        def __init__(self, answer: AnswerSteps, shown: DemonstratedStep) -> None:
            super().__init__()
            self.answer = answer
            self.shown = shown

        @property
        def control(self) -> AnswerSteps:
            """The column that it was chosen in."""
            return self.answer

    def __init__(
        self,
        workspace: Workspace,
        library: Library,
        number: int,
        behaviour: str,
        steps: Sequence[DemonstratedStep],
    ) -> None:
        super().__init__(
            f"{number} {clean(workspace.activity.behaviour_words(behaviour))}",
            ANSWER_HELP,
        )
        self.border_subtitle = often(len(steps))
        self._workspace = workspace
        self._steps = tuple(steps)
        self._library = library
        self._write = self._lines

    def _lines(self, width: int, height: int) -> list[ChoiceLine]:
        lines = []
        for index, shown in enumerate(self._steps):
            name = self._library.name(shown.demonstration)
            entry = self._library.entries.get(shown.demonstration)
            when = f", {local_time(entry.at)}" if entry is not None else ""
            where = f"{name}, step {shown.number}"
            who = f" {clean(shown.teacher)}{when}"
            lines.append(ChoiceLine(((shorten(where, width), "text"),), index))
            lines.append(ChoiceLine(((shorten(who, width), "dim"),), index))
            if height >= LINES_OF_A_STEP:
                lines.append(ChoiceLine(((shorten(self._followed(shown), width), "dim"),), index))
        return lines

    def _followed(self, shown: DemonstratedStep) -> str:
        """Describe the person the step was for, and the situation that followed."""
        step = shown.step
        whom = f"for {self._workspace.name(step.target)}, " if step.target else ""
        then = self._workspace.activity.in_words(step.after.situation)
        return clean(f" {whom}then {then}")

    def _tell(self, index: int) -> None:
        self.post_message(self.Chosen(self, self._steps[index]))
