"""Opens a stored policy; notices about it come before it is shown or used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text import program as text
from tangy_tui.text.policies import notice_words

if TYPE_CHECKING:
    from tangy_tui.learning.policy import Policy
    from tangy_tui.ui.program import Program


async def open_policy(program: Program, policy: Policy) -> None:
    """Open the screen of a policy, and wait until it is closed."""
    from tangy_tui.learning.library import effects_of
    from tangy_tui.ui.screens.policy import PolicyScreen

    workspace = program.workspace
    effects = effects_of(workspace.store, workspace.activity, policy)
    await program.push_screen_wait(PolicyScreen(workspace, policy, effects))


async def load_policy(program: Program, wanted: str) -> Policy | None:
    """Learn the stored policy again; None if there is none, or the user rejects it."""
    from tangy_tui.learning import policies

    workspace = program.workspace
    loaded = await program.in_thread(
        text.RECALLING,
        lambda: policies.load_policy(workspace.store, workspace.activity, wanted),
    )
    if loaded is None:
        return None
    policy, notices = loaded
    return (
        policy
        if not notices or await _accept(program, policy, notice_words(notices)[0], wanted)
        else None
    )


async def _accept(program: Program, policy: Policy, notice: str, wanted: str) -> bool:
    """Show how a policy differs from the stored one, and ask before using it."""
    from tangy_tui.learning import policies
    from tangy_tui.ui.dialogs.difference import DifferenceDialog

    workspace = program.workspace
    kept = policies.need_policy(workspace.store, workspace.activity, wanted)
    changes = policies.changes(kept, policy)
    answer = await program.push_screen_wait(DifferenceDialog(workspace.activity, notice, changes))
    if answer == "keep":
        policies.keep_policy(workspace.store, policy)
    return answer != "back"
