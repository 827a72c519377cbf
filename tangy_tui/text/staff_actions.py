"""Words for the actions of staff, and of the application outside behaviours, in a game."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.session_time import time_in
from tangy_profiles.staff_records import StaffActionKind
from tangy_tui.app.card_news import BY as TANGY
from tangy_tui.app.game_commands import AUTONOMY
from tangy_tui.monitoring.replay import Noted
from tangy_tui.text.control import autonomy_words
from tangy_tui.text.injections import happens_words
from tangy_tui.text.situations import addressed_step

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.text.situations import Name

OF_THE_PROGRAM: tuple[StaffActionKind, ...] = (
    *("heard", "cards dealt", "card learnt", "card doubted"),
    *("robot frozen", "program frozen", "faults planned"),
)
"""What Tangy or the program did; the log names those on duty with some of them."""

PERSON_ID = re.compile(r"\b[a-z]+\d+\b")
"""The ids of people in sentences that an earlier version logged."""


def by_staff(noted: Noted) -> bool:
    """Return whether staff did it, and not Tangy or the program."""
    return bool(noted.by) and noted.by != TANGY and noted.did not in OF_THE_PROGRAM


def with_behaviour(noted: Noted, activity: Activity | None) -> Noted:
    """Replace the behaviour that staff chose by its words, if the activity is known."""
    if activity is None or noted.did != "answered":
        return noted
    return replace(noted, detail=activity.behaviour_words(noted.detail))


def chosen_words(activity: Activity | None, behaviour: str, target: str, name: Name) -> str:
    """Tell which behaviour staff chose, and for whom."""
    does = behaviour if activity is None else activity.behaviour_words(behaviour)
    return _told_to_do(does, name(target) if target else "")


def _told_to_do(does: str, person: str) -> str:
    return f"told Tangy what to do: {addressed_step(does, person)}"


def action_line(noted: Noted, name: Name) -> str:
    """Tell who did what in a sentence: "Ada paused the game."."""
    words = action_words(noted, name)
    if by_staff(noted):
        words = f"{noted.by} {did_words(noted, name)}"
    return f"{words[:1].upper()}{words[1:]}."


def did_words(noted: Noted, name: Name) -> str:
    """Tell what staff did, to follow their name: "paused the game"."""
    detail, person = noted.detail, name(noted.person) if noted.person else ""
    match noted.did:
        case "resumed":
            return "went on with the game after an interruption"
        case "paused":
            return "paused the game"
        case "went on":
            return "ended the pause"
        case "stopped":
            return "stopped the robot"
        case "let go on":
            return "let the robot go on after a stop"
        case "took over":
            return "took over, to say what Tangy does next"
        case "gave back":
            return "let Tangy go on by itself"
        case "answered":
            return _told_to_do(detail, person)
        case "ended":
            return "ended the game"
        case "autonomy":
            return f"chose how much Tangy does by itself: {_autonomy_words(detail)}"
        case "drove":
            return "drove the robot by hand"
        case "called again":
            return f"had the last number called again{f': {detail}' if detail else ''}"
        case "asked for":
            return f"asked Tangy to go to {person}"
        case "told":
            return f"told Tangy about {person or 'the group'}: {detail}"
        case "pace":
            return f"set the pace to a call every {detail} s"
        case "time planned":
            return f"planned to play {_until_words(detail)}"
        case "took back":
            return f"took a call back: {detail}"
        case "claim made":
            return f"asked Tangy to check {card_words(detail, person)}{at_call(noted.calls)}"
        case "claim right":
            return f"had {card_words(detail, person)} checked: it wins"
        case "claim late":
            card = card_words(detail, person)
            return f"had {card} checked: it wins, too, but another card was first"
        case "claim wrong":
            return f"had {card_words(detail, person)} checked: it does not win yet"
        case "patterns":
            return f"chose what is played for: {detail}"
        case "rules":
            return f"chose: {detail}"
        case "came":
            return f"told Tangy that {person} is here"
        case "left":
            return f"told Tangy that {person} has left"
        case "response voided":
            return f"said that {person}'s last response does not count"
        case "card given":
            whose = f"card {detail}" if detail else "another card"
            return f"told Tangy that {person} has {whose}"
        case "fault injected":
            return f"brought about a fault: {happens_words(detail)}"
        case "fault lifted":
            return f"ended a fault: {happens_words(detail)}"
        case "noted":
            return f"noted: {_named(detail, name)}"
        case (
            "heard" | "cards dealt" | "card learnt" | "card doubted" | "robot frozen"
            | "program frozen" | "faults planned"
        ):  # fmt: skip
            return action_words(noted, name)
        case forgotten:
            assert_never(forgotten)


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
        case "gave back":
            return "Tangy went on by itself"
        case "answered":
            return f"somebody {_told_to_do(detail, person)}"
        case "ended":
            return "the game was ended"
        case "autonomy":
            return f"how much Tangy does by itself: {_autonomy_words(detail)}"
        case "drove":
            return "the robot was driven by hand"
        case "called again":
            return f"the last number was called again{f': {detail}' if detail else ''}"
        case "asked for":
            return f"Tangy was asked to go to {person}"
        case "told":
            return f"Tangy was told about {person or 'the group'}: {detail}"
        case "heard":
            return f"Tangy heard from {person or 'the group'}: {detail}"
        case "pace":
            return f"the pace was set to {detail} s"
        case "time planned":
            return f"the session was planned {_until_words(detail)}"
        case "took back":
            return f"a call was taken back: {detail}"
        case "claim made":
            card = card_words(detail, person)
            return f"Tangy was asked to check {card}{at_call(noted.calls)}"
        case "claim right":
            return f"{card_words(detail, person)} was checked: it wins"
        case "claim late":
            card = card_words(detail, person)
            return f"{card} was checked: it wins, too, but another card was first"
        case "claim wrong":
            return f"{card_words(detail, person)} was checked: it does not win yet"
        case "patterns":
            return f"what is played for was chosen: {detail}"
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
            return f"a fault was injected: {happens_words(detail)}"
        case "fault lifted":
            return f"a fault was lifted: {happens_words(detail)}"
        case "faults planned":
            return f"faults will be injected: {detail}"
        case "noted":
            return _named(detail, name)
        case forgotten:
            assert_never(forgotten)


def _until_words(detail: str) -> str:
    """Tell until when the time was planned (ISO 8601); "": without a limit."""
    ends = time_in(detail)
    return "without a time limit" if ends is None else f"until {ends.astimezone():%H:%M}"


def _autonomy_words(level: str) -> str:
    known = next((one for one in AUTONOMY if one == level), None)
    return level if known is None else f"it {autonomy_words(known)}"


def card_words(number: str, person: str) -> str:
    """Name a card by its number and the person who has it; the person may be unknown."""
    return f"{person}'s card {number}" if person else f"card {number}"


def at_call(calls: int) -> str:
    """Tell at which call something was; "" if it is not known."""
    return f" at call {calls}" if calls else ""


def _named(words: str, name: Name) -> str:
    return PERSON_ID.sub(lambda found: name(found[0]), words)
