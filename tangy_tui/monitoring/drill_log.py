"""The score sheets of drills that the log holds."""

from __future__ import annotations

from dataclasses import replace

from tangy_profiles.drill_sheet import Sheet
from tangy_profiles.game_records import DrillHeld
from tangy_profiles.store import Event, Store


def read_sheets(store: Store, who: str = "") -> list[Sheet]:
    """Read the sheets that were kept (of one person), the oldest first."""
    sheets = [_sheet(event) for event in store.events(DrillHeld)]
    return [sheet for sheet in sheets if not who or sheet.by(who)]


def last_sheet(store: Store) -> Sheet | None:
    """Return the newest sheet, or None."""
    event = store.last(DrillHeld)
    return None if event is None else _sheet(event)


def _sheet(event: Event[DrillHeld]) -> Sheet:
    return replace(event.record.sheet, at=event.at)
