"""The comparison of two chosen policies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text import program as text
from tangy_tui.text.policies import notice_words

if TYPE_CHECKING:
    from tangy_tui.ui.program import Program


async def compare_policies(program: Program, first: str | None) -> None:
    """Let the user choose two policies (`first` is one already), and open their comparison."""
    from tangy_tui.learning.comparison import find_policy
    from tangy_tui.ui.screens.compare import CompareScreen, choose_two

    workspace = program.workspace
    wanted = await choose_two(program, workspace, first)
    if len(wanted) < 2:
        return
    found = await program.in_thread(
        text.RECALLING_BOTH,
        lambda: [find_policy(workspace.store, workspace.activity, one) for one in wanted],
    )
    if found is not None:
        (a, of_a), (b, of_b) = found
        await program.push_screen(CompareScreen(workspace, a, b, notice_words([*of_a, *of_b])))
