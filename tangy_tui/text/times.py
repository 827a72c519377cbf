"""When something was, and how long it took, as reports write it."""

from __future__ import annotations

from datetime import datetime


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
