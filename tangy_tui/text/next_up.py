"""Who or what comes next in a game, in one or two sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.text.names import turn_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.staff_view import settled_words
from tangy_tui.text.whose_turn import because_words, held_words, on_its_way

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.app.game_moment import GameMoment
    from tangy_tui.text.situations import Name

WHAT_NEXT = "Who or what is next?"
"""The title of the answer."""


def next_lines(activity: Activity, moment: GameMoment, name: Name) -> list[str]:
    """Tell who or what comes next, after what Tangy does now.

    Args:
        activity: the activity that is played.
        moment: the present moment.
        name: returns a person's name for an id.
    """
    told = [held_words(moment)]
    if moment.holder not in ("idle", "over"):
        told += [_now_words(moment, name), _next_words(activity, moment, name)]
    return [one for one in told if one]


def _now_words(moment: GameMoment, name: Name) -> str:
    """Tell what comes to its end first; "" if nothing does."""
    if (near := moment.with_robot) is not None:
        there = on_its_way(moment) if near.state == "comes" else "Tangy is with"
        return f"{there} {name(near.id)}."
    return f"Tangy is calling {moment.calling}." if moment.calling else ""


def _next_words(activity: Activity, moment: GameMoment, name: Name) -> str:
    """Tell what follows; "" if that is not known yet."""
    if moment.turns:
        return f"{turn_words(name(moment.turns[0]))}."
    settled, goes_to = settled_words(moment.claim, moment.plays_on, name)
    if goes_to:
        return f"{name(goes_to)} is next, because of the claim."
    if settled or moment.won:
        return settled or "Somebody has won, so nobody else gets a visit for now."
    busy = moment.with_robot is not None or bool(moment.calling)
    calls = counted(moment.calls_first, "number") if moment.calls_first else ""
    if moment.waiting:
        first = moment.waiting[0]
        then = "After that, " if busy else ""
        if calls:
            before = f"Tangy calls {calls} first. "
            return f"{before}After that, {name(first.id)} is next."
        return f"{then}{name(first.id)} is next{because_words(moment, first, name)}."
    if any(one.calls for one in activity.behaviours.values()):
        then = "After that, Tangy" if busy else "Tangy"
        nobody = "Nobody else waits" if moment.with_robot is not None else "Nobody waits"
        return f"{nobody}. {then} calls the next number."
    decision = moment.decision
    if busy or decision is None or not decision.sure:
        return "Nobody else waits." if busy else ""
    return f"Next: {activity.behaviour_words(decision.behaviour)}."
