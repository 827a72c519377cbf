"""Explanations on the teaching screen: what Tangy would do, computed in the background."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen
from textual.worker import Worker

from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.ui.policy_preview import show_why


class TeachWhy:
    """Explains a step or the present situation, one at a time; it can be cancelled."""

    def __init__(
        self, screen: Screen[Any], workspace: Workspace, teaching: TeachingSession
    ) -> None:
        self._screen = screen
        self._workspace = workspace
        self._teaching = teaching
        self._thinking: Worker[None] | None = None

    @property
    def thinks(self) -> bool:
        """Whether an explanation is being computed."""
        return self._thinking is not None and not self._thinking.is_finished

    def show(self, number: int | None) -> None:
        """Explain a step by its number, or the present situation."""
        if self.thinks:
            return
        present = self._teaching.demonstration
        state = (
            self._teaching.world.observe() if number is None else present.steps[number - 1].state
        )
        thinking = show_why(self._screen, self._workspace, present, state.situation)
        self._thinking = self._screen.run_worker(thinking, name="why")

    def cancel(self) -> None:
        """Cancel the computation."""
        if self._thinking is not None:
            self._thinking.cancel()
