"""The lines of the set-up: people at tables, choices for the game, and checks."""

from __future__ import annotations

from rich.cells import cell_len

from tangy_tui.app.set_up import SetUp
from tangy_tui.text import set_up as text
from tangy_tui.text.missing_devices import missing_words
from tangy_tui.text.register import staff_names
from tangy_tui.text.rooms import room_words
from tangy_tui.text.typed_commands import AWAY
from tangy_tui.ui.widgets.set_up_list import SetUpLine
from tangy_tui.ui.widgets.wrapping import wrap

NARROWEST = 20
"""The least width in cells into which the patterns are wrapped."""
INKS = {"ready": "good", "not ready": "warn", "off": "dim", "not told": "dim"}


def people_lines(setup: SetUp) -> list[SetUpLine]:
    """Return a line for each person, table by table."""
    name = staff_names(setup.workspace.name)
    lines = [SetUpLine("head", "people", text.PEOPLE, text.people_words(setup))]
    several, seat = len(setup.tables) > 1, 0
    for table, sitting in enumerate(setup.tables):
        for place, person in enumerate(sitting):
            seat += 1
            away = person in setup.away
            value = (AWAY if several else text.NOT_HERE) if away else text.HERE
            label = f"{seat:>2} {name(person)}" if several else f"{seat:>2}  {name(person)}"
            at, ink = (table, place) if several else None, "dim" if away else "good"
            lines.append(SetUpLine("person", person, label, value, ink, at))
    return lines


def game_lines(setup: SetUp, width: int) -> list[SetUpLine]:
    """Return the choices for the game below its patterns, for a width in cells."""
    workspace = setup.workspace
    rows = [
        ("activity", text.ACTIVITY, workspace.activity.title),
        ("room", text.ROOM, room_words(workspace.room, workspace.chosen_room)),
        ("patterns", "Played for", text.patterns_words(setup)),
        ("several", "Winners", text.winners_words(setup)),
        ("pace", "Pace", text.pace_words(setup.pace)),
        ("visits", "Visits", text.visits_words(setup)),
        ("strength", "Tangy's words", text.strength_words(setup)),
        ("minutes", "Time", text.minutes_words(setup.minutes)),
        ("duty", text.ON_DUTY, setup.on_duty),
    ]
    rules = workspace.activity.rules
    if not setup.calls:
        rows = [row for row in rows if row[0] != "pace"]
    if not rules.patterns:
        rows = [row for row in rows if row[0] not in ("patterns", "several", "visits")]
    beside = width - cell_len(text.GAME) - 3
    first, *more = wrap(text.pattern_keys(setup), max(NARROWEST, beside)) or [""]
    heads = [SetUpLine("head", "game", text.GAME, first)]
    blank = " " * cell_len(text.GAME)
    heads += [SetUpLine("head", f"game{at}", blank, one) for at, one in enumerate(more)]
    return [*heads, *(SetUpLine("choice", id, label, value) for id, label, value in rows)]


def check_lines(setup: SetUp) -> list[SetUpLine]:
    """Return the checks, and the robot's missing devices."""
    lines = [SetUpLine("head", "checks", text.READY, "")]
    for check in setup.checks():
        ink = INKS.get(check.state, "text")
        label, value = text.NAMES[check.name], text.check_words(check)
        lines.append(SetUpLine("check", check.name, label, value, ink))
    told = missing_words(setup.workspace.robot, setup.workspace.activity)
    return [*lines, *(SetUpLine("head", "missing", "", one) for one in told)]
