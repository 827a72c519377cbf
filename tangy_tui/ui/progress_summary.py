"""How far things are: what stands beside the choices of the first screen."""

from __future__ import annotations

from collections.abc import Mapping

from tangy_tui.app.workspace import House
from tangy_tui.learning import library, policies
from tangy_tui.monitoring.drill_sheet import last_sheet
from tangy_tui.text.situations import counted


def how_far(house: House) -> Mapping[str, str]:
    """Say how far each choice of the first screen is, by its id."""
    there = library.read_library(house.store, house.activity.name)
    shown = there.demonstrations
    finished = sum(1 for d in shown if d.finished)
    unfinished = sum(1 for d in shown if d.steps and not d.finished)
    away = sum(1 for entry in there.entries.values() if entry.hidden)
    kept = policies.last_policy(house.store, house.activity.name)
    people = ", ".join(person.name for person in house.people)
    sheet = last_sheet(house.store)
    return {
        "teach": counted(finished, "demonstration")
        + (f", {unfinished} unfinished" if unfinished else ""),
        "library": f"{len(shown)} in use, {away} put away" if away else "",
        "learn": "" if kept is None else f"from {len(kept['demonstrations'])} so far",
        "play": "" if kept is not None else "learn first",
        "live": _robot_of(house) if kept is not None else "learn first",
        "rehearse": "" if sheet is None else f"last: {sheet.points} of {sheet.most} points",
        "policy": "" if kept is None else str(kept["name"]),
        "people": people,
    }


def _robot_of(house: House) -> str:
    return house.robot.title if house.robot.drivers else "on the bench: no robot is named"
