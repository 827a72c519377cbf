"""What is written over the line to answer in: why Tangy asks, and what it sees."""

from __future__ import annotations

from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Unsure
from tangy_tui.learning.explanation import Why
from tangy_tui.monitoring.supervision import Supervision
from tangy_tui.text.numbers import counted
from tangy_tui.text.situations import ALL_RIGHT, state_words
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.reasons import why_of


def question_words(workspace: Workspace, game: Supervision, question: Unsure) -> str:
    """Write why Tangy asks; where answers were given, which."""
    words = question.reason
    if game.acceptable:
        return clean(f"{words} If all is well, type: {ALL_RIGHT[0]}. If not, what to do?")
    if not question.fault and question.decision.seen:
        why = why_of(workspace, game.policy, question.state.situation)
        words = f"{words} {_answers_words(why)}"
    return clean(f"{words} What should Tangy do?")


def seen_words(workspace: Workspace, game: Supervision, question: Unsure) -> str:
    """Write what Tangy sees where it asks."""
    scene = game.world.scene()
    words = state_words(workspace.activity, question.state, scene, workspace.name)
    return clean(f"Now: {words}")


def _answers_words(why: Why) -> str:
    """Say which answers demonstrations give in a situation, how often and by whom."""
    given: dict[str, list[str]] = {}
    for shown in (*why.rests_on, *why.against):
        given.setdefault(shown.step.behaviour, []).append(shown.teacher)
    parts = [
        f"{behaviour} ({counted(len(teachers), 'time')}, by {', '.join(dict.fromkeys(teachers))})"
        for behaviour, teachers in given.items()
    ]
    return f"Shown so far: {', '.join(parts)}." if parts else ""
