"""Explains during teaching what Tangy would do after the demonstrations so far."""

from __future__ import annotations

from typing import Any

from textual.screen import Screen
from textual.worker import Worker, WorkerCancelled, WorkerFailed

from tangy_profiles.demonstration import Demonstration
from tangy_profiles.errors import TangyError
from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.explanation import DecisionReasons
from tangy_tui.text.program import THINKING


async def show_why(
    screen: Screen[Any], workspace: Workspace, present: Demonstration, situation: Situation
) -> None:
    """Learn in the background from all demonstrations and the present game; explain a situation."""
    from tangy_tui.ui.dialogs.why import WhyDialog

    app: Any = screen.app
    app.show_work(THINKING)
    worker: Worker[DecisionReasons] = screen.run_worker(
        lambda: grounds(workspace, present, situation),
        thread=True,
        exit_on_error=False,
        group="why",
    )
    try:
        why = await worker.wait()
    except WorkerCancelled:
        app.clear_notifications()
        return  # it is no longer wanted, or the screen is closing
    except WorkerFailed as failed:
        if not isinstance(failed.error, TangyError):
            raise
        app.clear_notifications()
        app.say(str(failed.error))
        return
    app.clear_notifications()
    if app.screen is screen:
        app.push_screen(WhyDialog(workspace, why))


def grounds(workspace: Workspace, present: Demonstration, situation: Situation) -> DecisionReasons:
    """Return the reasons for Tangy's behaviour in a situation."""
    from tangy_tui.learning.explanation import explain, foresee
    from tangy_tui.learning.library import read_library

    library = read_library(workspace.store, workspace.activity.name)
    there = {d.id: d for d in library.finished}
    if present.id not in library.entries:  # it has no logged step to open yet
        return explain(
            foresee(workspace.store, workspace.activity, None), list(there.values()), situation
        )
    shown = list((there | {present.id: present}).values())
    return explain(foresee(workspace.store, workspace.activity, present), shown, situation)
