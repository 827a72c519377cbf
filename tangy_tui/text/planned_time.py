"""Words for the time of a game, and for the planned time of its session."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

from tangy_profiles.game_world import SIMULATED
from tangy_tui.text.numbers import counted
from tangy_tui.text.times import local_now

if TYPE_CHECKING:
    from tangy_profiles.session_time import SessionTime
    from tangy_tui.app.game_controller import GameController

Fact: TypeAlias = str | tuple[str, ...]
"""A fact in words; several: the same in shorter and shorter words."""

HOW_LONG = "How long do you play?"
"""The title of the answer about the planned time."""
MORE = "To plan more, type: plan 20 minutes."
MORE_BY_KEY = "To plan more, press {command} and type: plan 20 minutes."
NO_END = "You planned no end. To plan one, type: plan 20 minutes."
PAUSES_COUNT = "Pauses count: the end stays the same."
SIMULATED_TIME = "A simulated game has no planned time."


def clock_words(seconds: float) -> str:
    """Format a time in s as minutes and seconds."""
    whole = max(0, int(seconds))
    return f"{whole // 60}:{whole % 60:02}"


def end_words(at: datetime, now: datetime) -> str:
    """Write the local time of day, with the day unless that is today."""
    local, today = at.astimezone(), now.astimezone()
    return f"{local:%H:%M}" if local.date() == today.date() else f"{local.day} {local:%b %H:%M}"


def time_words(
    seconds: float,
    ends: datetime | None,
    paused: float | None = None,
    now: datetime | None = None,
    *,
    stopped: bool = False,
    until: bool = True,
    left: bool = True,
    lasted: bool = True,
) -> str:
    """Tell how long the game has lasted (s), and how much of the session's planned time is left.

    Args:
        seconds: since the game began, pauses included.
        ends: when the planned time is over; None: no limit.
        paused: how long the pause has lasted (s); None: the game is not paused.
        now: the local time of day; None: the game is not played in the time of the home.
        stopped: whether the robot was stopped, so that the game stands for this reason.
        until: whether to tell the time of day at which the planned time is over.
        left: whether to tell how much time is left.
        lasted: whether to tell how long the game has lasted.
    """
    told = [f"{clock_words(seconds)} so far"] if lasted else []
    if paused is not None and paused >= 1:
        told.append(f"{'stopped' if stopped else 'paused'} {clock_words(paused)}")
    if ends is not None and now is not None:
        remains = (ends - now).total_seconds()
        if left:
            told.append(f"{clock_words(remains)} left" if remains > 0 else "time is up")
        if until and remains > 0:
            told.append(f"until {end_words(ends, now)}")
        elif until:
            told[-1] += f" since {end_words(ends, now)}"
    return ", ".join(told)


def time_facts(
    seconds: float,
    ends: datetime | None,
    paused: float | None,
    now: datetime | None,
    *,
    stopped: bool = False,
) -> Fact:
    """Tell the same with the time of day, and in two shorter ways for less room."""
    words = partial(time_words, seconds, ends, paused, now, stopped=stopped)
    if paused is None or ends is None or now is None:
        return words(), words(until=False)
    over = ends <= now
    return words(), words(lasted=False), words(lasted=False, left=over, until=not over)


def time_is_up_words(ends: datetime, now: datetime) -> str:
    """Tell that the planned time is over while a game goes on."""
    until = end_words(ends, now)
    return (
        f"Time is up: you planned to play until {until}. The game goes on. Type end to end it. "
        f"{MORE}"
    )


def after_end_words(ends: datetime, now: datetime, *, by_key: bool = False) -> str:
    """Tell that a game begins after the planned time, and how to plan more."""
    more = MORE_BY_KEY if by_key else MORE
    return f"The planned time has been over since {end_words(ends, now)}. {more}"


def left_words(ends: datetime | None, now: datetime, *, by_key: bool = False) -> str:
    """Tell what is left of the planned time; "" if there is no limit."""
    if ends is None:
        return ""
    if ends <= now:
        return after_end_words(ends, now, by_key=by_key)
    minutes = max(1, round((ends - now).total_seconds() / 60))
    return f"You planned to play until {end_words(ends, now)}: {counted(minutes, 'minute')} left."


def planned_words(ends: str, minutes: str) -> str:
    """Tell until when the time is planned now (ISO 8601); "": without a limit."""
    if not ends:
        return "No time limit: you play as long as you like."
    until = end_words(datetime.fromisoformat(ends), local_now())
    return f"You play until {until} ({counted(int(minutes), 'minute')} from now)."


def time_lines(control: GameController) -> list[str]:
    """Answer how long the session has lasted, and when it ends."""
    view, world = control.view(), control.supervision.world
    lasted = time_words(view.seconds, None, view.paused, stopped=control.stopped)
    game = f"This game: {lasted}."
    if world.played_in == SIMULATED:
        return [game, SIMULATED_TIME]
    if (time := control.time.now) is None:
        return [game]
    now = control.time.clock()
    told = [game, f"You began at {end_words(time.begins, now)}."]
    if time.ends is None:
        return [*told, NO_END]
    told += [left_words(time.ends, now), PAUSES_COUNT]
    return told if time.ends <= now else [*told, MORE]  # it has told MORE if the time is over


def planned_until_words(times: Sequence[SessionTime]) -> str:
    """Tell until when the sessions of a report were planned; "" if none had a limit."""
    ends = [f"{one.ends.astimezone():%H:%M}" for one in times if one.ends is not None]
    return f"planned until {', then '.join(ends)}" if ends else ""
