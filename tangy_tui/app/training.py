"""Learns from all demonstrations, and stores the policy."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.learning.policy import Policy


def learn(workspace: Workspace) -> Policy:
    """Learn from the finished demonstrations and the teachers' decisions; store the policy.

    Raises:
        NothingToLearnFrom: there is no finished demonstration.
    """
    from tangy_tui.learning.library import read_library
    from tangy_tui.learning.policies import keep_policy, unused_name, without_strange_steps
    from tangy_tui.learning.policy import NothingToLearnFrom, learn_policy

    library = read_library(workspace.store, workspace.activity.name)
    if library.demonstrations and not library.finished:
        raise NothingToLearnFrom(
            "Tangy learns from finished demonstrations, and none is finished yet: play the game to "
            "its end, or type: finish the demonstration."
        )
    used, _ = without_strange_steps(workspace.activity, library.finished)
    policy = learn_policy(workspace.activity, used, resolutions=library.resolutions)
    policy = unused_name(workspace.store, policy)
    keep_policy(workspace.store, policy)
    return policy
