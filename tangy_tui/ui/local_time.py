"""When something was, on the clock of whoever reads it."""

from __future__ import annotations

from datetime import datetime


def local_time(at: str) -> str:
    """Write a UTC time of the log (ISO 8601) as the date and time here."""
    return f"{datetime.fromisoformat(at).astimezone():%Y-%m-%d %H:%M}"
