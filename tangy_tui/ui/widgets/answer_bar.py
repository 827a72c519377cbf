"""The line to answer in while Tangy asks."""

from __future__ import annotations

from tangy_tui.ui.widgets.command_bar import CommandBar


class AnswerBar(CommandBar):
    """The line to answer in, whose resting text goes with the game."""

    def rest(self, text: str) -> None:
        """Say other keys while the line does not have them."""
        self._texts = (self._texts[0], text)
        if not self._input.has_focus:
            self.on_descendant_blur()
