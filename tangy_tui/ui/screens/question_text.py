"""The text above the answer line: why Tangy asks, and what it sees."""

from __future__ import annotations

from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.questions import acceptable_words, asked_words, given_words
from tangy_tui.text.situations import state_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.reasons import why_of


def question_words(workspace: Workspace, game: Supervision, question: Unsure) -> str:
    """Tell why Tangy asks, and which answers were given before."""
    if game.acceptable:
        return clean(acceptable_words(question.reason))
    if not question.fault and question.decision.seen:
        why = why_of(workspace, game.policy, question.state.situation)
        return clean(asked_words(question.reason, given_words(workspace.activity, why)))
    return clean(asked_words(question.reason))


def seen_words(workspace: Workspace, game: Supervision, question: Unsure) -> str:
    """Describe what Tangy sees."""
    scene = game.world.scene()
    words = state_words(workspace.activity, question.state, scene, workspace.name)
    return clean(f"Now: {words}")
