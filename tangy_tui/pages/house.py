"""The reports of a person over time, and of a care home over months."""

from __future__ import annotations

from collections.abc import Sequence

from tangy_profiles.game_world import GameWorld
from tangy_tui.monitoring.house import PersonOverTime, RobotLog, by_month, of_world
from tangy_tui.pages.page import document, heading, paragraph, table
from tangy_tui.pages.staff_parts import STYLE
from tangy_tui.text import house as say


def house_page(
    logs: Sequence[RobotLog],
    world: GameWorld,
    people: Sequence[PersonOverTime],
    others: Sequence[GameWorld],
) -> str:
    """Return the report of a house: its months, people and faults.

    Args:
        logs: the logs of its robots.
        world: the world whose games are reported.
        people: the people in these games.
        others: other worlds that also have games.
    """
    games = of_world(logs, world)
    parts = [*map(paragraph, say.notes(logs, games, others)), heading(say.MONTHS)]
    parts += [table(say.MONTH_COLUMNS, say.month_rows(by_month(games)))]
    parts += [heading(say.WHO), table(say.WHO_COLUMNS, say.who_rows(people))]
    if faults := list(say.fault_rows(games)):
        parts += [heading(say.FAULTS), table(say.FAULT_COLUMNS, faults)]
    if len(logs) > 1:
        parts += [heading(say.ROBOTS), table(say.ROBOT_COLUMNS, say.robot_rows(logs, world))]
    return document(say.house_title(logs), say.scope(world, len(games)), parts, STYLE)


def person_page(
    person: PersonOverTime,
    logs: Sequence[RobotLog],
    world: GameWorld,
    others: Sequence[GameWorld],
) -> str:
    """Return the report of one person: game by game, and what works with them.

    Args:
        person: the person, with the games to report.
        logs: the logs of the robots.
        world: the world whose games are reported.
        others: other worlds that also have games.
    """
    games = [(one.log, one.replay) for one in person.games]
    parts = [*map(paragraph, say.notes(logs, games, others))]
    parts += [table(say.WHO_COLUMNS, say.who_rows([person]))]
    if strategies := list(say.strategy_rows(person)):
        parts += [heading(say.WORKS), table(say.STRATEGY_COLUMNS, strategies)]
    parts += [heading(say.GAMES), table(say.GAME_COLUMNS, say.game_rows(person.games))]
    return document(person.name, say.scope(world, len(person.games)), parts, STYLE)
