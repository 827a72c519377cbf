"""The progress notes beside the choices of the home screen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from tangy_profiles.game_world import SIMULATED
from tangy_profiles.past_game import interrupted_game
from tangy_tui.learning import library, policies
from tangy_tui.monitoring.drill_log import last_sheet
from tangy_tui.text.interruptions import still_open_words
from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


def how_far(workspace: Workspace) -> Mapping[str, str]:
    """Return the note of each choice of the home screen, by its id."""
    there = library.read_library(workspace.store, workspace.activity.name)
    shown = there.demonstrations
    finished = sum(1 for d in shown if d.finished)
    unfinished = sum(1 for d in shown if d.steps and not d.finished)
    away = sum(1 for entry in there.entries.values() if entry.hidden)
    kept = policies.last_policy(workspace.store, workspace.activity.name)
    people = ", ".join(person.name for person in workspace.people)
    sheet = last_sheet(workspace.store)
    play = "" if kept is not None else "learn first"
    live = _robot_of(workspace) if kept is not None else "learn first"
    if kept is not None and (past := interrupted_game(workspace.store, workspace.activity.name)):
        words = still_open_words(past, len(past.called(workspace.activity)))
        play, live = (words, live) if past.world == SIMULATED else (play, words)
    return {
        "teach": counted(finished, "demonstration")
        + (f", {unfinished} unfinished" if unfinished else ""),
        "library": f"{len(shown)} in use, {away} put away" if away else "",
        "learn": "" if kept is None else f"from {len(kept.demonstrations)} so far",
        "play": play,
        "live": live,
        "rehearse": "" if sheet is None else f"last: {sheet.points} of {sheet.most} points",
        "policy": "" if kept is None else kept.name,
        "people": people,
        "activity": workspace.activity.title,
        "name": workspace.teacher,
    }


def _robot_of(workspace: Workspace) -> str:
    return workspace.robot.title if workspace.robot.drivers else "on the bench: no robot is named"
