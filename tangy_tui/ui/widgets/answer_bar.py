"""The input line for answers to Tangy's questions."""

from __future__ import annotations

from tangy_tui.ui.widgets.command_bar import CommandBar


class AnswerBar(CommandBar):
    """A command bar whose placeholder without focus changes with the game."""

    def rest(self, text: str) -> None:
        """Set the placeholder shown while the bar does not have the focus."""
        self._texts = (self._texts[0], text)
        if not self._input.has_focus:
            self.on_descendant_blur()
