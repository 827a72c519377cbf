"""Words for the actions of staff, and of the application outside behaviours, in a game."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, assert_never

from tangy_tui.monitoring.replay import Noted

if TYPE_CHECKING:
    from tangy_tui.text.situations import Name

PERSON_ID = re.compile(r"\b[a-z]+\d+\b")
"""The ids of people in sentences that an earlier version logged."""


def action_line(noted: Noted, name: Name) -> str:
    """Tell what was done, and who did it, in a sentence."""
    return f"{action_words(noted, name)}{f', by {noted.by}' if noted.by_staff else ''}."


def action_words(noted: Noted, name: Name) -> str:
    """Tell what was done, without a full stop."""
    detail, person = noted.detail, name(noted.person) if noted.person else ""
    match noted.did:
        case "resumed":
            return "the game went on after an interruption"
        case "paused":
            return "the game was paused"
        case "went on":
            return "the game went on after a pause"
        case "stopped":
            return "the robot was stopped"
        case "let go on":
            return "the robot was released after a stop"
        case "took over":
            return "control was taken over"
        case "ended":
            return "the game was ended"
        case "autonomy":
            return f"autonomy: {detail}"
        case "drove":
            return "the robot was driven by hand"
        case "called again":
            return f"the last number was called again{f': {detail}' if detail else ''}"
        case "asked for":
            return f"Tangy was told that {person} asks for help"
        case "told":
            return f"Tangy was told about {person or 'the group'}: {detail}"
        case "heard":
            return f"Tangy heard from {person or 'the group'}: {detail}"
        case "pace":
            return f"the pace was set to {detail} s"
        case "took back":
            return f"a call was taken back: {detail}"
        case "claim right":
            return f"{_card(detail, person)} was checked: it wins"
        case "claim wrong":
            return f"{_card(detail, person)} was checked: it does not win yet"
        case "patterns":
            return f"the game went on for: {detail}"
        case "rules":
            return f"chosen: {detail}"
        case "came":
            return f"{person} came"
        case "left":
            return f"{person} left"
        case "response voided":
            return f"{person}'s last response does not count"
        case "card given":
            return f"{person} has {f'card {detail}' if detail else 'another card'}"
        case "cards dealt":
            return f"cards dealt: {_named(detail, name)}"
        case "card learnt":
            return f"Tangy takes card {detail} to be {person}'s"
        case "card doubted":
            return f"Tangy did not judge the card in front of {person} ({detail})"
        case "robot frozen":
            return f"the robot process was frozen for {detail} s"
        case "program frozen":
            return f"the program was frozen for {detail} s"
        case "fault injected":
            return f"a fault was injected: {detail}"
        case "fault lifted":
            return f"a fault was lifted: {detail}"
        case "faults planned":
            return f"faults will be injected: {detail}"
        case "noted":
            return _named(detail, name)
        case forgotten:
            assert_never(forgotten)


def _card(number: str, person: str) -> str:
    return f"{person}'s card {number}" if person else f"card {number}"


def _named(words: str, name: Name) -> str:
    return PERSON_ID.sub(lambda found: name(found[0]), words)
