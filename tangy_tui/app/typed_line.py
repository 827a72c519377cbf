"""What staff type on the screen of a game: commands, questions about people, and keys in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from tangy_profiles.game_rules import NO_RULES, GameRules
from tangy_tui.app.game_commands import GameCommand
from tangy_tui.app.game_questions import AsksGame, read_saying
from tangy_tui.app.inquiry_grammar import Question, read_question
from tangy_tui.app.plan_grammar import lines_of
from tangy_tui.app.screen_grammar import Perform, read_screen


@dataclass(frozen=True, slots=True)
class Several:
    """Commands that one line gives, one for each person that it names."""

    commands: tuple[GameCommand, ...]


def commands_in(typed: GameCommand | Several) -> tuple[GameCommand, ...]:
    """Return the commands of a line, in their order."""
    return typed.commands if isinstance(typed, Several) else (typed,)


EXPLAINED = ("why", "help", "phrases")
"""Actions that explain; a question about the game comes first."""

Typed: TypeAlias = GameCommand | Several | Question | Perform


def read_typed(
    typed: str,
    read: Callable[[str], GameCommand | None],
    find_person: Callable[[str], str],
    can: Callable[[str], bool],
    rules: GameRules = NO_RULES,
    *,
    asks: bool = False,
) -> Typed | None:
    """Parse a line that staff typed; None if it is nothing of this.

    Args:
        typed: the line.
        read: parses a command.
        find_person: returns the id of a person by name or id.
        can: returns whether the screen has an action of the keymap.
        rules: the choices that the activity gives staff.
        asks: whether Tangy asks what to do; then thanks and the like may be the answer.

    Raises:
        TangyError: it resembles a command, but a part of it is wrong; one sentence.
    """
    each = [read(line) for line in lines_of(typed, read)]
    commands = tuple(command for command in each if command is not None)
    if len(commands) > 1:
        return Several(commands)
    if commands:
        return commands[0]
    word = read_screen(typed)
    if isinstance(word, Perform) and word.action not in EXPLAINED:
        if can(word.action):
            return word
        return AsksGame("new game") if word.action == "next" else None
    question = read_question(typed, find_person)
    if question is not None:
        return question
    if word is not None:
        return word if can(word.action) else None
    said = None if asks else read_saying(typed, find_person, rules)
    if said is not None and said.topic == "new game" and can("next"):
        return Perform("next")
    return said
