"""The playing screen explains: why Tangy does something, and when it goes to people."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen

from tangy_profiles.game_world import SIMULATED
from tangy_tui.app.inquiry_grammar import Question
from tangy_tui.text.answers import answer_to
from tangy_tui.text.decisions import WHY_NOW
from tangy_tui.text.games import ANOTHER_DETAIL, NOTHING_DECIDED
from tangy_tui.text.planned_time import left_words
from tangy_tui.text.register import staff_names
from tangy_tui.text.times import local_now
from tangy_tui.text.whose_turn import why_now_lines
from tangy_tui.ui.dialogs.message import MessageDialog
from tangy_tui.ui.dialogs.why import WhyDialog
from tangy_tui.ui.screens.play_panels import PlayPanels
from tangy_tui.ui.screens.play_view import next_line
from tangy_tui.ui.screens.question_panel import AskingPanel
from tangy_tui.ui.widgets.policy_table import PolicyTable
from tangy_tui.ui.widgets.transcript import Transcript


class PlayAnswers(PlayPanels):
    """Answers the questions of staff about a game."""

    def action_why(self) -> None:
        """Explain the chosen step, Tangy's question, or the next step and the last one."""
        chosen = self.query_one(Transcript).chosen
        fault = self._faults.asked_about if chosen is None else None
        coming = "" if self._supervision.over else next_line(self._source())
        name = staff_names(self._workspace.name)
        plain = why_now_lines(self.control, name) if chosen is None else []
        dialog: Screen[Any] | None
        dialog = self._faults.dialog(fault.id) if fault else self.picture.why(chosen, coming)
        if isinstance(dialog, WhyDialog):
            dialog.plain = plain
            if plain and self._supervision.world.played_in != SIMULATED:
                dialog.at = f"{local_now():%H:%M:%S}"
        if dialog is None and plain:
            dialog = MessageDialog("\n".join(plain), WHY_NOW)
        if dialog is not None:
            self.app.push_screen(dialog)
        else:
            self._tell_now(NOTHING_DECIDED, "dim")

    def answer_about(self, about: Question) -> None:
        """Answer a typed question about the game or its people."""
        answer = answer_to(about, self.control, staff_names(self._workspace.name))
        self.app.push_screen(MessageDialog("\n".join(answer.lines), answer.title))

    def on_transcript_chosen(self, event: Transcript.Chosen) -> None:
        """Explain the step chosen with Enter."""
        event.stop()
        if (dialog := self.picture.why_step(event.number)) is not None:
            self.app.push_screen(dialog)

    def on_policy_table_chosen(self, event: PolicyTable.Chosen) -> None:
        """Explain the row of the policy chosen with Enter."""
        event.stop()
        self.app.push_screen(self.picture.why_row(event.index))

    def on_asking_panel_why_wanted(self, event: AskingPanel.WhyWanted) -> None:
        """Explain why Tangy asks, or when it goes to people."""
        event.stop()
        if event.about is not None:
            self.answer_about(event.about)
            return
        self.query_one(Transcript).release()
        self.action_why()

    def _another_detail(self) -> str:
        """Tell when another game begins, and what is left of the planned time."""
        begins = "" if self._supervision.over else ANOTHER_DETAIL
        time = self.control.time
        left = left_words(time.ends, time.clock(), by_key=True)
        return " ".join(filter(None, (begins, self._told(left))))
