"""Questions to a teacher before going back, discarding a game, or making a rule."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.learning.teaching_events import Again, Discard, NoRule, SameWhatever
from tangy_tui.text import teaching as text
from tangy_tui.ui.dialogs.choose import ChooseDialog, Option
from tangy_tui.ui.dialogs.confirm import ConfirmDialog

if TYPE_CHECKING:
    from tangy_tui.ui.screens.teach import TeachScreen


async def show_again(screen: TeachScreen, command: Again) -> None:
    """Demonstrate a game again, if the teacher agrees to undo steps of this one."""
    present = screen.teaching.demonstration
    steps = len(present.steps)
    if command.demonstration == present.id and 0 <= command.kept < steps:
        asked = text.again_words(command.kept + 1, steps)
        dialog = ConfirmDialog(*asked, yes=text.GO_BACK, no=text.GO_ON)
        if not await screen.alone(dialog):
            screen.listen()
            return
    screen.follow(command)


async def put_away(screen: TeachScreen) -> None:
    """Discard the present game, if the teacher confirms."""
    steps = len(screen.teaching.demonstration.steps)
    dialog = ConfirmDialog(*text.discard_words(steps), yes=text.DISCARD, no=text.KEEP)
    if not steps or await screen.alone(dialog):
        screen.follow(Discard())
    screen.listen()


async def add_rule(screen: TeachScreen) -> None:
    """Make the last step a rule: the teacher chooses the facts that make no difference."""
    choices = screen.teaching.rules.choices(screen.teaching.demonstration)
    if isinstance(choices, NoRule):
        screen.follow(SameWhatever())  # tells why there is none
        return
    activity, step = screen.teaching.activity, screen.teaching.demonstration.steps[-1]
    options = [
        Option(str(number), text.whatever_words(one), text.covers_words(one.covers))
        for number, one in enumerate(choices)
    ]
    chosen = await screen.alone(ChooseDialog(text.rule_question(step, activity), options))
    if chosen is not None:
        screen.follow(SameWhatever(choices[int(chosen)].facts))
    screen.listen()


async def confirm_rule(screen: TeachScreen, command: SameWhatever) -> None:
    """Make the last step a rule, if the teacher agrees; otherwise tell why it cannot be one."""
    teaching = screen.teaching
    rule = teaching.rules.would(teaching.demonstration, command)
    if not isinstance(rule, NoRule):
        asked = text.rule_words_asked(rule, teaching.activity)
        if not await screen.alone(ConfirmDialog(*asked, yes=text.RULE, no=text.NO_RULE)):
            screen.listen()
            return
    screen.follow(command)
    screen.listen()
