"""The dialogs that explain a step of a game, a row of a policy, and a question."""

from __future__ import annotations

from dataclasses import dataclass

from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.explanation import DecisionReasons, explain
from tangy_tui.learning.library import read_library
from tangy_tui.learning.policy import Policy
from tangy_tui.text.decisions import (
    WHY_ASKED,
    WHY_NOW,
    answered_words,
    last_step_heading,
    why_row_title,
    why_step_title,
)
from tangy_tui.ui.dialogs.why import ComingStep, WhyDialog


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
    return WhyDialog(
        workspace,
        why_of(workspace, ground.policy, acted.state.situation),
        acted.choice,
        title=why_step_title(number),
        remarks=_answered(ground),
    )


def why_now(
    workspace: Workspace,
    policy: Policy,
    coming: tuple[str, Situation],
    last: DecisionGround | None,
) -> WhyDialog:
    """Explain the next step of a game (its words, and its situation), and the last one if any."""
    words, situation = coming
    next_why = why_of(workspace, policy, situation)
    if last is None:
        return WhyDialog(workspace, next_why, title=WHY_NOW, remarks=(words,))
    acted = last.acted
    before = last_step_heading(acted.number, acted.action.behaviour.question)
    return WhyDialog(
        workspace,
        why_of(workspace, last.policy, acted.state.situation),
        acted.choice,
        title=WHY_NOW,
        remarks=_answered(last),
        coming=ComingStep(words, next_why, before),
    )


def _answered(ground: DecisionGround) -> tuple[str, ...]:
    """Tell who answered, if Tangy asked what to do."""
    behaviour = ground.acted.action.behaviour.question
    return (answered_words(ground.teacher, behaviour),) if ground.teacher else ()


def why_row(workspace: Workspace, policy: Policy, situation: Situation) -> WhyDialog:
    """Explain a row of a policy."""
    return WhyDialog(
        workspace, why_of(workspace, policy, situation), title=why_row_title(policy.name)
    )


def why_asked(workspace: Workspace, policy: Policy, situation: Situation) -> WhyDialog:
    """Explain why Tangy asks."""
    return WhyDialog(workspace, why_of(workspace, policy, situation), title=WHY_ASKED)
