"""What staff were told before a game was interrupted, in sentences made from its log."""

from __future__ import annotations

from datetime import datetime
from typing import TYPE_CHECKING

from tangy_tui.monitoring.earlier import EarlierPart
from tangy_tui.monitoring.replay import AnsweredRequest, Done, Moment, Noted
from tangy_tui.text.faults import list_lines
from tangy_tui.text.log import told_lines
from tangy_tui.text.messages import one_sentence, timed_message
from tangy_tui.text.times import day_and_time

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.staff_records import StaffActionKind
    from tangy_tui.monitoring.fault import Fault
    from tangy_tui.text.situations import Name

BEFORE = "Before the interruption"
SINCE = "Since then:"
NONE_SINCE = "No faults since the game went on."
WAS_OPEN = "open then"
"""The state of a fault that was not over when the game was interrupted."""
UNTOLD: tuple[StaffActionKind, ...] = ("cards dealt", "faults planned")
"""What the log notes for researchers alone."""


def before_words(at: datetime) -> str:
    """Write the heading of what happened up to an interruption."""
    return f"{BEFORE} ({day_and_time(at)})"


def earlier_messages(
    part: EarlierPart, activity: Activity, name: Name
) -> list[tuple[datetime, str]]:
    """Return the messages of a log, with local times, the oldest first.

    Tangy's steps and people's answers are no messages: they are in the log.
    """
    return [
        (datetime.fromisoformat(moment.at).astimezone(), _sentence(moment, activity, name))
        for moment in part.moments
        if _is_message(moment)
    ]


def earlier_lines(part: EarlierPart, activity: Activity, name: Name) -> list[str]:
    """List the messages of a log in lines, below a heading; none if the program only goes on."""
    told = [] if part.joined else earlier_messages(part, activity, name)
    lines = [f"  {timed_message(*one)}" for one in told]
    return [f"{before_words(part.at)}:", *lines] if lines else []


def earlier_fault_lines(part: EarlierPart | None, faults: list[Fault]) -> list[str]:
    """List the faults of a game with their recoveries: first those before an interruption."""
    if part is None or not part.faults:
        return list_lines(faults)
    earlier = list_lines(list(part.faults))
    if part.joined:
        return list_lines([*part.faults, *faults])
    since = [SINCE, *list_lines(faults)] if faults else [NONE_SINCE]
    return [f"{before_words(part.at)}:", *earlier, *since]


def _is_message(moment: Moment) -> bool:
    what = moment.what
    noise = isinstance(what, Noted) and what.did in UNTOLD
    return not (noise or isinstance(what, Done | AnsweredRequest))


def _sentence(moment: Moment, activity: Activity, name: Name) -> str:
    words = one_sentence(moment.what, told_lines(moment, activity, name))
    return f"{words[:1].upper()}{words[1:]}"
