"""Suggestions of commands for words that are none."""

from __future__ import annotations

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import GameRules
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.inquiry_grammar import read_inquiry
from tangy_tui.app.similar_commands import (
    ABOUT_PERSON,
    COMMANDS,
    NUMBERED,
    nearest_command,
    nearest_commands,
)
from tangy_tui.app.workspace import Workspace

NAMES = ("Rosa", "Emil", "Otto")


def find(who: str) -> str:
    for name in NAMES:
        if name.casefold() == who.casefold():
            return name
    raise TangyError("nobody")


@pytest.fixture
def rules(workspace: Workspace) -> GameRules:
    return workspace.activity.rules


def test_the_nearest_command_is_named() -> None:
    assert nearest_command("pasue") == "pause"
    assert nearest_command("qwertz") == ""


@pytest.mark.parametrize(
    ("typed", "near"),
    [
        ("help Emil", "ask for Emil"),
        ("Emil needs something", "ask for Emil"),
        ("make it slower please", "slower"),
        ("go more slowly", "slower"),
        ("can you speed up a bit", "faster"),
        ("a number every 20 seconds", "pace 20"),
        ("check rosa's card", "bingo Rosa"),
        ("rosa has won", "bingo Rosa"),
        ("otto is out", "left Otto"),
        ("goodbye otto and emil", "left Emil and Otto"),
        ("rosa lef", "left Rosa"),
        ("roosa joined", "here Rosa"),
        ("rosa, emil and otto joined us", "here Rosa, Emil and Otto"),
        ("rosa and otto need help", "ask for Otto"),
        ("it is a mistake", "take back"),
        ("repaet the last one", "call again"),
        ("pasue", "pause"),
        ("what do you mean by that", "why"),
    ],
)
def test_words_suggest_a_command(typed: str, near: str, rules: GameRules) -> None:
    assert near in nearest_commands(typed, NAMES, rules)


def test_words_that_hint_at_nothing_suggest_nothing(rules: GameRules) -> None:
    assert nearest_commands("the soup was lovely", NAMES, rules) == ()


def test_no_claim_is_suggested_without_claims() -> None:
    assert nearest_commands("check card 17", NAMES) == ()


def test_each_suggestion_is_a_command(rules: GameRules) -> None:
    lines = [f"{hint} Rosa" for hints in ABOUT_PERSON.values() for hint in hints]
    lines += [hint for hints in (*COMMANDS.values(), *NUMBERED.values()) for hint in hints]
    suggested = {near for line in lines for near in nearest_commands(line, NAMES, rules)}
    assert suggested >= {*COMMANDS}
    for near in suggested - {"autonomy", "drive"}:
        read = read_command(near, find, rules=rules)
        assert read is not None or read_inquiry(near) is not None, near
