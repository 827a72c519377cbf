"""Formats of times and durations in reports."""

from __future__ import annotations

from datetime import UTC, datetime

from tangy_tui.text.numbers import counted


def local_now() -> datetime:
    """Return the local time of day."""
    return datetime.now(UTC).astimezone()


def clock(seconds: float) -> str:
    """Format a time within a game, in s: "4:05", or "1:02:03" from an hour on."""
    whole = int(seconds)
    hours, minutes = divmod(whole // 60, 60)
    if hours:
        return f"{hours}:{minutes:02}:{whole % 60:02}"
    return f"{minutes}:{whole % 60:02}"


def length(seconds: float) -> str:
    """Format a duration in s: "40 s", "38 min", "1 h 5 min"."""
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


def time_of_day(at: str) -> str:
    """Format a time of the log (ISO 8601) as local time of day."""
    return f"{datetime.fromisoformat(at).astimezone():%H:%M:%S}"


def day_and_time(at: datetime) -> str:
    """Format a local day and time."""
    local = at.astimezone()
    return f"{local.day} {local:%B %Y, %H:%M}"


def local_time(at: str) -> str:
    """Format a time of the log (ISO 8601) as local date and time, of constant width."""
    return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"


def ago(then: datetime, now: datetime) -> str:
    """Tell how long ago something was, as in speech, by local days."""
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
    """Format the local day and time of an event."""
    local = at.astimezone()
    return f"{local.day} {local:%b %Y %H:%M}"
