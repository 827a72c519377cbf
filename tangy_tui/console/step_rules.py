"""The possible rules for the last step, in the console."""

from __future__ import annotations

from tangy_tui.learning.teaching_events import NoRule
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.teaching import rule_lines, rule_words


def rules_to_type(teaching: TeachingSession) -> list[str]:
    """Return the commands that make the last step a rule, or why it cannot be one."""
    choices = teaching.rules.choices(teaching.demonstration)
    if isinstance(choices, NoRule):
        return [rule_words(choices, teaching.activity)]
    return rule_lines(choices)
