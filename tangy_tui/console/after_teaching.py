"""Commands after teaching in the console: let Tangy learn, and let it play."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tangy_profiles.errors import TangyError
from tangy_tui.app.screen_grammar import Perform
from tangy_tui.text.teaching_commands import NOW_PLAY, ON_THE_SCREEN


@dataclass(frozen=True, slots=True)
class AfterTeaching:
    """Learns from demonstrations, and checks that there is a policy to play by.

    `learn` learns and describes the result; `check` raises TangyError if nothing was learnt yet.
    """

    learn: Callable[[], list[str]]
    check: Callable[[], object]

    def perform(self, word: Perform) -> tuple[list[str], bool]:
        """Carry out a command; return the sentences to write, and whether to play a game."""
        try:
            match word.action:
                case "learn":
                    return [*self.learn(), NOW_PLAY], False
                case "begin":
                    self.check()
                    return [], True
        except TangyError as error:
            return [str(error)], False
        return [ON_THE_SCREEN], False
