"""Drills in the application: resume an interrupted one if wanted, and open the screen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text import program as text
from tangy_tui.ui.interruption import DrillToHold, ask_about_drill

if TYPE_CHECKING:
    from tangy_profiles.drill_sheet import Sheet
    from tangy_tui.ui.program import Program


async def hold_drill(
    program: Program,
    rounds: int | None = None,
    seed: int | None = None,
    who: str = "",
    past: Sheet | None = None,
) -> None:
    """Open a drill for rehearsing faults, by default with the usual number of rounds.

    Resumes a `past` drill, or asks about an interrupted one.
    """
    from tangy_tui.app.drill_opening import open_drill
    from tangy_tui.monitoring.drill import ROUNDS
    from tangy_tui.ui.screens.drill import DrillScreen

    workspace = program.workspace
    name = who or workspace.teacher
    chosen = await ask_about_drill(program, name) if past is None else DrillToHold(past)
    if chosen is None:
        return
    made = await program.in_thread(
        text.PREPARING_DRILL,
        lambda: open_drill(
            workspace,
            name,
            seed=seed,
            rounds=rounds or ROUNDS,
            clock=program.clock,
            past=chosen.past,
        ),
    )
    if made is not None:
        await program.push_screen(DrillScreen(made))
