"""The score sheets of drills in the log."""

from __future__ import annotations

from dataclasses import replace

from tangy_profiles.drill_sheet import Sheet
from tangy_profiles.game_records import DrillAnswered, DrillHeld
from tangy_profiles.store import Event, Store


def read_sheets(store: Store, who: str = "") -> list[Sheet]:
    """Read the logged sheets (of one person), oldest first."""
    sheets = [_sheet(event) for event in store.events(DrillHeld)]
    return [sheet for sheet in sheets if not who or sheet.by(who)]


def last_sheet(store: Store) -> Sheet | None:
    """Return the latest sheet, or None."""
    event = store.last(DrillHeld)
    return None if event is None else _sheet(event)


def interrupted_sheet(store: Store, who: str, activity: str) -> Sheet | None:
    """Return the sheet of a person's latest drill if it was interrupted, else None."""
    last: Event[DrillAnswered] | None = None
    for event in store.events(DrillAnswered):
        if event.record.sheet.by(who):
            last = event
    if last is None or last.record.sheet.activity != activity:
        return None
    held = (event.record.sheet for event in store.events(DrillHeld, after=last.seq))
    return None if any(sheet.by(who) for sheet in held) else _sheet(last)


def keep_interrupted(store: Store, sheet: Sheet) -> None:
    """Log the sheet of an interrupted drill as it is, unfinished."""
    store.append(DrillHeld(sheet=replace(sheet, at="")))


def _sheet(event: Event[DrillHeld] | Event[DrillAnswered]) -> Sheet:
    return replace(event.record.sheet, at=event.at)
