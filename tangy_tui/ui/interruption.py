"""The question about an interrupted game or drill, before another one begins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_tui.app.game_to_play import GameToPlay
from tangy_tui.text import interruptions as text

if TYPE_CHECKING:
    from tangy_profiles.drill_sheet import Sheet
    from tangy_profiles.game_world import GameWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.ui.program import Program


async def ask_about_interrupted(program: Program, world: GameWorld) -> GameToPlay | None:
    """Ask about a game that was interrupted in a world; None: nothing is played now."""
    from tangy_tui.app.interruption import end_interrupted, find_interrupted

    workspace = program.workspace
    past = find_interrupted(workspace, world)
    if past is None:
        return GameToPlay(None)
    answer = await _ask(program, past)
    while answer == text.ADD[0]:
        await _add(program)
        answer = await _ask(program, past)
    try:
        match answer:
            case "resume":
                return await _resume(program, past)
            case "discard":
                end_interrupted(workspace, past, text.ENDED)
                return GameToPlay(None)
            case "end":
                end_interrupted(workspace, past, text.ENDED)
                await _report(program, workspace, past)
    except TangyError as error:
        await program.tell(str(error), title=text.TITLE)
    return None


async def _ask(program: Program, past: PastGame) -> str | None:
    """Ask what becomes of a game that was interrupted."""
    from tangy_tui.app.interruption import can_join
    from tangy_tui.ui.dialogs.choose import ChooseDialog, Option

    workspace = program.workspace
    words = text.interrupted_words(past, len(past.called(workspace.activity)))
    ways = [text.RESUME, text.END, text.DISCARD]
    if can_join(workspace, past):
        new = [name for id, name in workspace.names.items() if id not in past.beginning.people]
        ways[:1] = [(*text.RESUME[:2], text.with_words(new)), text.ADD]
    return await program.push_screen_wait(ChooseDialog(words, [Option(*way) for way in ways]))


async def _add(program: Program) -> None:
    """Ask who has come, and add them to the participants."""
    from tangy_tui.app.joining import let_join
    from tangy_tui.ui.joining import ask_who_joins

    who = await ask_who_joins(program)
    if who is not None:
        try:
            let_join(program.workspace, who[0], guest=who[1])
        except TangyError as error:
            await program.tell(str(error), title=text.TITLE)


async def _resume(program: Program, past: PastGame) -> GameToPlay:
    """Restore the seats, and tell who cannot join."""
    from tangy_tui.app.interruption import take_up

    names = program.workspace.names
    taken_up = take_up(program.workspace, past)
    if taken_up.waiting:
        waiting = [names[person] for person in taken_up.waiting]
        await program.tell(text.waiting_words(waiting), title=text.TITLE)
    return GameToPlay(taken_up.past)


@dataclass(frozen=True, slots=True)
class DrillToHold:
    """The drill to run: the sheet of an interrupted one, or (None) a new one."""

    past: Sheet | None


async def ask_about_drill(program: Program, who: str) -> DrillToHold | None:
    """Ask about a person's interrupted drill; None: rehearse nothing now."""
    from tangy_tui.monitoring.drill_log import interrupted_sheet, keep_interrupted
    from tangy_tui.text.drills import GO_ON, NEW_DRILL, interrupted_words
    from tangy_tui.ui.dialogs.choose import ChooseDialog, Option

    workspace = program.workspace
    past = interrupted_sheet(workspace.store, who, workspace.activity.name)
    if past is None:
        return DrillToHold(None)
    options = [Option(*GO_ON), Option(*NEW_DRILL)]
    answer = await program.push_screen_wait(ChooseDialog(interrupted_words(past), options))
    if answer is None:
        return None
    if answer == GO_ON[0]:
        return DrillToHold(past)
    keep_interrupted(workspace.store, past)
    return DrillToHold(None)


async def _report(program: Program, workspace: Workspace, past: PastGame) -> None:
    """Write the report of an ended game to the data folder, and show its path."""
    from tangy_tui.app.register import guest_ids
    from tangy_tui.monitoring.games import find_games, read_games
    from tangy_tui.text.register import with_guests
    from tangy_tui.text.session_reports import printed_page_words
    from tangy_tui.ui.dialogs.message import MessageDialog
    from tangy_tui.ui.printed_report import write_page

    store = workspace.store
    found = find_games(read_games(store), past.beginning.game)
    names = with_guests(workspace.names, guest_ids(store))
    try:
        said = printed_page_words(str(write_page(workspace, found, names)))
    except TangyError as error:
        said = str(error)
    await program.push_screen_wait(MessageDialog(said, title=text.TITLE))
