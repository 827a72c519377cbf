"""The dialogs that explain a step of a game, a row of a policy, and a question."""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.explanation import DecisionReasons, explain
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import Policy
from tangy_tui.text.decisions import WHY_ASKED, answered_words, why_row_title, why_step_title
from tangy_tui.ui.dialogs.why import WhyDialog


@dataclass(frozen=True, slots=True)
class DecisionGround:
    """The ground of a step: the policy at that moment, the event, and who answered."""

    policy: Policy
    acted: Acted
    teacher: str = ""


def why_of(workspace: Workspace, policy: Policy, situation: Situation) -> DecisionReasons:
    """Explain a policy's decision, also by hidden demonstrations."""
    entries = read_library(workspace.store, workspace.activity.name).entries.values()
    return explain(policy, [entry.demonstration for entry in entries], situation)


def why_step(workspace: Workspace, ground: DecisionGround, number: int) -> WhyDialog:
    """Explain a step of a game."""
    acted = ground.acted
    done = answered_words(ground.teacher, acted.action.behaviour.question)
    return WhyDialog(
        workspace,
        why_of(workspace, ground.policy, acted.state.situation),
        acted.choice,
        title=why_step_title(number),
        remarks=(done,) if ground.teacher else (),
    )


def why_row(workspace: Workspace, policy: Policy, situation: Situation) -> WhyDialog:
    """Explain a row of a policy."""
    return WhyDialog(
        workspace, why_of(workspace, policy, situation), title=why_row_title(policy.name)
    )


def why_asked(workspace: Workspace, policy: Policy, situation: Situation) -> WhyDialog:
    """Explain why Tangy asks."""
    return WhyDialog(workspace, why_of(workspace, policy, situation), title=WHY_ASKED)
