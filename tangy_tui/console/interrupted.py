"""An interrupted game: staff at the lines say whether it goes on, before another one begins."""

from __future__ import annotations

from collections.abc import Callable

from tangy_profiles.errors import TangyError
from tangy_profiles.past_game import PastGame
from tangy_tui.app.command_grammar import LEAVING, command_reader
from tangy_tui.app.game_commands import EndGame, GoOn, Joins
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.app.interruption import can_join, end_interrupted, take_up
from tangy_tui.app.joining import known_refusal, let_join
from tangy_tui.app.workspace import Workspace
from tangy_tui.text import interruptions as text
from tangy_tui.text.control import noted_words

DISCARDS = ("discard", "discard it", "new game")


def ask_about_interrupted(
    workspace: Workspace,
    past: PastGame,
    read: Callable[[], str | None],
    write: Callable[[str], None],
    report: str,
) -> GameToPlay | None:
    """Ask about an interrupted game; None: nothing is played now.

    Args:
        workspace: the workspace of the games.
        past: the game.
        read: blocks for the next line, and returns None at the end.
        write: writes a line.
        report: the command that makes the report of an ended game.
    """
    joins = can_join(workspace, past)
    write(text.interrupted_words(past, len(past.called(workspace.activity))))
    write(text.lines_ask(joins=joins))
    command = command_reader(workspace.activity, lambda who: workspace.find_person(who).id)
    while (line := read()) is not None:
        words = " ".join(line.split()).strip(" .!").casefold()
        try:
            if words in DISCARDS:
                end_interrupted(workspace, past, text.ENDED)
                return GameToPlay(None)
            if words in LEAVING:
                break
            match command(line):
                case GoOn():
                    names = workspace.names
                    taken_up = take_up(workspace, past)
                    if taken_up.waiting:
                        write(text.waiting_words([names[one] for one in taken_up.waiting]))
                    return GameToPlay(taken_up.past)
                case EndGame():
                    end_interrupted(workspace, past, text.ENDED)
                    write(report)
                    return None
                case Joins() as who if joins:
                    _add(workspace, who, write)
                case _ if words:
                    write(text.lines_ask(joins=joins))
        except TangyError as error:
            write(str(error))
    write(text.KEPT)
    return None


def _add(workspace: Workspace, joins: Joins, write: Callable[[str], None]) -> None:
    if (refused := known_refusal(workspace, joins)) is not None:
        write(noted_words(refused, workspace.name))
        return
    let_join(workspace, joins.name.strip(), guest=joins.guest)
    write(text.joins_words(joins.name.strip()))
