"""Typed lines that are no behaviour: actions of keys, and questions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tangy_tui.app.screen_grammar import Perform
from tangy_tui.app.teaching_grammar import AgainFrom, Leave, TeachAs, TeachingWord
from tangy_tui.learning.teaching_events import Discard, Finish, Next, Redo, SameWhatever, Undo
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.text.teaching import left_words
from tangy_tui.ui.base import perform
from tangy_tui.ui.screens.teach_choices import confirm_rule
from tangy_tui.ui.widgets.command_bar import CommandBar

if TYPE_CHECKING:
    from tangy_tui.ui.screens.teach import TeachScreen


def follow_word(screen: TeachScreen, word: TeachingWord | None, typed: str) -> None:
    """Carry out a typed command or question; other lines are commands to Tangy."""
    match word:
        case None | "where" | "what to do" | "faults":
            screen.follow(Say(typed))
        case StopCommand():
            screen.app.run_worker(screen.run_action("app.stop"))
        case Undo() | Redo() | Finish() | Next():
            screen.follow(word)
        case SameWhatever():
            screen.query_one(CommandBar).ready()
            screen.run_worker(confirm_rule(screen, word), name="rule")
        case Discard():
            screen.action_discard()
        case Leave():
            go_home(screen)
        case TeachAs(name):
            screen.query_one(CommandBar).ready()
            app: Any = screen.app
            app.rename_teacher(name)
        case AgainFrom(step):
            screen.again_from(step)
        case "why":
            screen.action_why()
        case "shown":
            screen.query_one(CommandBar).ready()
            screen.action_coverage()
        case "help" | "phrases":
            _perform(screen, Perform(word))
        case Perform("rule"):
            screen.action_rule()
        case Perform():
            _perform(screen, word)


def go_home(screen: TeachScreen, *, watching: bool = False) -> None:
    """Close the screen, and tell what is stored of an unfinished game, unless scripted."""
    shown = screen.teaching.demonstration
    if screen.is_active and shown.steps and not (shown.finished or watching):
        screen.app.notify(left_words(len(shown.steps)), markup=False)
    screen.close(False)


def _perform(screen: TeachScreen, word: Perform) -> None:
    screen.query_one(CommandBar).ready()
    screen.app.run_worker(perform(screen, word.action, word.on))
