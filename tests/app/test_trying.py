"""A game that is tried tells everything that people did after each step, and who said nothing."""

from __future__ import annotations

from pathlib import Path

from tangy_tui.app.trying import tried_game
from tangy_tui.text.activities import SAYS_NOTHING, people_did
from tests.support.changed import changed_trivia
from tests.support.declared import declared


def test_everything_that_a_person_did_after_a_step_is_told() -> None:
    told = [
        did
        for seed in range(1, 6)
        for step in tried_game(declared("exercises"), 3, seed)
        for did in step.doing.values()
    ]
    assert any(", " in did for did in told)


def test_who_says_nothing_and_is_asked_again_is_told(tmp_path: Path) -> None:
    rarely = ('turn is yes"], chance = 0.4', 'turn is yes"], chance = 0.1')
    steps = list(tried_game(changed_trivia(tmp_path, rarely), 2, 1))
    silent = [step for step in steps if step.silent]
    assert {step.behaviour for step in silent} == {"ask question"}
    assert SAYS_NOTHING in people_did(silent[0].doing, silent[0].silent)
