"""The rules that the last step can get, for a line."""

from __future__ import annotations

from tangy_tui.learning.teaching_events import NoRule
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.text.teaching import rule_lines, rule_words


def rules_to_type(teaching: TeachingSession) -> list[str]:
    """Return what to type to make the last step a rule, or why it cannot be one."""
    choices = teaching.rules.choices(teaching.demonstration)
    if isinstance(choices, NoRule):
        return [rule_words(choices, teaching.activity)]
    return rule_lines(choices)
