"""Options and functions about interrupted games that the commands for playing share."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.reading import plain
from tangy_tui.text import interruptions as text

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace

Resume = Annotated[
    bool, typer.Option("--resume", help="Go on with the game that was interrupted, without asking.")
]
Discard = Annotated[
    bool, typer.Option("--discard", help="End the game that was interrupted, and play a new one.")
]


def past_game(
    workspace: Workspace,
    world: GameWorld,
    *,
    resume: bool,
    discard: bool,
    asks: bool,
    lines: bool = False,
    report: str = "",
) -> PastGame | None:
    """Return the interrupted game to resume, None if a new game begins.

    Args:
        workspace: the workspace of the games.
        world: the world to play in.
        resume: resume without asking.
        discard: end the interrupted game.
        asks: a screen asks later; otherwise a new game begins, and a note is printed.
        lines: staff are asked in console mode, if they type there.
        report: the command that makes the report of an ended game.

    Raises:
        TangyError: nothing was interrupted, or its room is not available.
        typer.Exit: staff play nothing now.
    """
    from tangy_tui.app.interruption import end_interrupted, find_interrupted, take_up
    from tangy_tui.console.inputs import is_typed, line_reader

    if resume and discard:
        raise TangyError(text.BOTH)
    past = find_interrupted(workspace, world)
    if past is None:
        if resume:
            raise TangyError(text.NONE)
        return None
    if discard:
        end_interrupted(workspace, past, text.ENDED)
        return None
    if resume:
        names = workspace.names
        taken_up = take_up(workspace, past)
        if taken_up.waiting:
            waiting = text.waiting_words([names[person] for person in taken_up.waiting])
            print(f"tangy: {plain(waiting)}", file=sys.stderr)
        return taken_up.past
    if lines and is_typed(None):
        from tangy_tui.console.interrupted import ask_about_interrupted
        from tangy_tui.text.live_games import report_words
        from tangy_tui.verbs.common import print_line

        chosen = ask_about_interrupted(
            workspace, past, line_reader(None), print_line, report_words(report)
        )
        if chosen is None:
            raise typer.Exit
        return chosen.past
    if not asks:
        calls = len(past.called(workspace.activity))
        verb = "play" if world == SIMULATED else "live"
        print(f"tangy: {text.interrupted_words(past, calls)}", file=sys.stderr)
        print(f"tangy: {text.begins_anew(verb)}", file=sys.stderr)
    return None
