"""When something was, and how long it took, as reports write it."""

from __future__ import annotations

from datetime import datetime

from tangy_tui.text.numbers import counted


def clock(seconds: float) -> str:
    """Write a time within a game: "4:05", or "1:02:03" from an hour on."""
    whole = int(seconds)
    hours, minutes = divmod(whole // 60, 60)
    if hours:
        return f"{hours}:{minutes:02}:{whole % 60:02}"
    return f"{minutes}:{whole % 60:02}"


def length(seconds: float) -> str:
    """Write how long something took: "40 s", "38 min", "1 h 5 min"."""
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def time_of_day(at: str) -> str:
    """Write a time of the log (ISO 8601) on the clock of the place we are in."""
    return f"{datetime.fromisoformat(at).astimezone():%H:%M:%S}"


def day_and_time(at: datetime) -> str:
    """Write a day and a time on the clock of the place we are in."""
    local = at.astimezone()
    return f"{local.day} {local:%B %Y, %H:%M}"


def local_time(at: str) -> str:
    """Write a time of the log (ISO 8601) as the date and time here, as wide in every row."""
    return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"


def ago(then: datetime, now: datetime) -> str:
    """Say how long ago something was, as people do; days are those of the place we are in."""
    days = (now.astimezone().date() - then.astimezone().date()).days
    if days < 1:
        return "today"
    if days < 2:
        return "yesterday"
    for unit, each, most in (("day", 1, 14), ("week", 7, 61), ("month", 30.44, 700)):
        if days < most:
            return f"{counted(int(days / each), unit)} ago"
    return f"{max(2, round(days / 365.25))} years ago"


def on_day(at: datetime) -> str:
    """Write the day and the time of something, in the time of the place we are in."""
    local = at.astimezone()
    return f"{local.day} {local:%b %Y %H:%M}"
