"""`tangy report`: reports on a session, a person over time, or the house; and tables."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import report_in
from tangy_tui.verbs.common import Data, Json, hand_on_options, print_json, print_line
from tangy_tui.verbs.log import Of, known_activities_of, open_log

if TYPE_CHECKING:
    from tangy_profiles.game_world import GameWorld
    from tangy_tui.monitoring.house import PersonOverTime, RobotLog

app = typer.Typer(
    rich_markup_mode=None,
    help="Report on a session, a person, or the house. Without a command: on the last session.",
)

Which = Annotated[
    str,
    typer.Argument(
        metavar="WHICH",
        help="'session' (the last games together), 'last' (game), 'all', a number, a day, an id.",
    ),
]
Html = Annotated[Path | None, typer.Option("--html", help="Write it as a page to this file.")]
Also = Annotated[
    list[Path] | None,
    typer.Option("--also", help="The data folder of another robot to include. Repeatable."),
]
WhichWorld = Annotated[
    str,
    typer.Option(
        "--world",
        help="Which games: live, bench, simulated. Default: the first of these with games.",
    ),
]
Full = Annotated[
    bool, typer.Option("--full", help="Add details for researchers: beliefs, full faults, totals.")
]


@app.callback(invoke_without_command=True)
def report(context: typer.Context, data: Data = None, as_json: Json = False) -> None:
    """Report on the last session, without a verb."""
    if context.invoked_subcommand is None:
        report_session(data=data, as_json=as_json)
    else:
        hand_on_options(context)


@app.command("session")
def report_session(
    which: Which = "session",
    html: Html = None,
    full: Full = False,
    activity: Of = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Report on a session.

    What needs attention, people, waits, numbers, faults, and what staff did.
    """
    from tangy_tui.monitoring.games import find_games, read_games
    from tangy_tui.monitoring.house import last_session
    from tangy_tui.monitoring.session import read_session
    from tangy_tui.pages import page
    from tangy_tui.text.log import session_lines

    if html is not None:
        page.check_place(html, "--html")
    with open_log(data) as (store, names):
        games = read_games(store)
        found = last_session(games) if which == "session" and games else find_games(games, which)
        session = read_session(store, found, known_activities_of(found, activity), names)
    if html is not None:
        from tangy_tui.pages.session import session_page

        page.write(html, session_page(session, full=full), "--html")
    if as_json:
        from tangy_tui.text.sessions import session_document

        print_json(session_document(session))
    elif html is not None:
        print_line(plain(report_in(html)))
    else:
        for line in session_lines(session, full=full):
            print_line(plain(line))


@app.command("person")
def report_person(
    name: Annotated[str, typer.Argument(metavar="WHO", help="A name, or an id.")],
    html: Html = None,
    also: Also = None,
    world: WhichWorld = "",
    activity: Of = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Report on a person over time.

    Game by game: how long they waited, and what works with them.
    """
    from tangy_tui.monitoring.house import of_world, people_over_time
    from tangy_tui.pages.house import person_page
    from tangy_tui.text import house as text

    logs = _read(data, also, activity)
    wanted, others = _world(logs, world)
    person = _find(people_over_time(of_world(logs, wanted)), name)
    games = [(one.log, one.replay) for one in person.games]
    if html is not None:
        _write(html, person_page(person, logs, wanted, others))
    if as_json:
        print_json({"world": wanted, **person.to_json()})
    elif html is None:
        print_line(plain(f"{person.name}: {text.scope(wanted, len(person.games))}"))
        _print_rows(text.GAME_COLUMNS, text.game_rows(person.games), text.GAMES)
        _print_rows(text.STRATEGY_COLUMNS, text.strategy_rows(person), text.WORKS)
        for line in text.notes(logs, games, others):
            print_line(line)


@app.command("house")
def report_house(
    html: Html = None,
    also: Also = None,
    world: WhichWorld = "",
    activity: Of = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Report on the house, month by month.

    Games, people, waits and faults, of one or more robots.
    """
    from tangy_tui.monitoring.house import by_month, of_world, people_over_time
    from tangy_tui.pages.house import house_page
    from tangy_tui.text import house as text

    logs = _read(data, also, activity)
    wanted, others = _world(logs, world)
    games = of_world(logs, wanted)
    people = people_over_time(games)
    if html is not None:
        _write(html, house_page(logs, wanted, people, others))
    if as_json:
        months = [month.to_json() for month in by_month(games)]
        people_told = [person.to_json() for person in people]
        print_json({"world": wanted, "months": months, "people": people_told})
    elif html is None:
        print_line(plain(f"{text.house_title(logs)}: {text.scope(wanted, len(games))}"))
        _print_rows(text.MONTH_COLUMNS, text.month_rows(by_month(games)), text.MONTHS)
        _print_rows(text.WHO_COLUMNS, text.who_rows(people), text.WHO)
        _print_rows(text.FAULT_COLUMNS, text.fault_rows(games), text.FAULTS)
        if len(logs) > 1:
            _print_rows(text.ROBOT_COLUMNS, text.robot_rows(logs, wanted), text.ROBOTS)
        for line in text.notes(logs, games, others):
            print_line(line)


@app.command("tables")
def report_tables(
    folder: Annotated[Path, typer.Argument(help="The folder to write the tables to.")],
    lines: Annotated[bool, typer.Option("--jsonl", help="JSON lines instead of CSV.")] = False,
    also: Also = None,
    activity: Of = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Write all games as tables for researchers.

    People have ids instead of names; each row has its world.

    docs/data-dictionary.md says what each column means.
    """
    from tangy_tui.monitoring.data_tables import TABLES
    from tangy_tui.text.house import written_words

    logs = _read(data, also, activity)
    written: list[tuple[str, int]] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for table in TABLES:
            rows = list(table.of(logs))
            path = folder / f"{table.name}.{'jsonl' if lines else 'csv'}"
            with path.open("w", encoding="utf-8", newline="") as file:
                (_write_lines if lines else _write_csv)(file, table.columns, rows)
            written.append((path.name, len(rows)))
    except OSError as error:
        raise TangyError(plain(f"{folder}: cannot be written ({error.strerror}).")) from None
    if as_json:
        print_json(dict(written))
    else:
        print_line(plain(written_words(written, folder)))


def _write_csv(file: Any, columns: Sequence[str], rows: Sequence[Any]) -> None:
    import csv

    writer = csv.DictWriter(file, columns)
    writer.writeheader()
    writer.writerows(rows)


def _write_lines(file: Any, columns: Sequence[str], rows: Sequence[Any]) -> None:
    for row in rows:
        file.write(json.dumps(row, ensure_ascii=False) + "\n")


def _read(data: Path | None, also: Sequence[Path] | None, activity: str) -> list[RobotLog]:
    """Read the logs of one robot or several.

    Raises:
        TangyError: a given folder has no log, or no game was played.
    """
    from tangy_profiles.log_file import FILE
    from tangy_tui.monitoring.games import read_games
    from tangy_tui.monitoring.house import read_log
    from tangy_tui.text.follow_up import follow_up
    from tangy_tui.text.games import NONE_YET
    from tangy_tui.text.house import NOT_THERE

    logs = []
    for folder in (data, *(also or ())):
        if folder is not None and not (folder / FILE).exists():
            raise TangyError(plain(f"{NOT_THERE}: {folder}"))
        with open_log(folder) as (store, names):
            games = read_games(store)
            logs.append(read_log(store, names, known_activities_of(games, activity)))
    if not any(log.replays for log in logs):
        raise TangyError(follow_up(NONE_YET, data="" if data is None else str(data)))
    return logs


def _world(logs: Sequence[RobotLog], wanted: str) -> tuple[GameWorld, list[GameWorld]]:
    """Return the world to report, and the other worlds with games."""
    from tangy_profiles.game_world import GAME_WORLDS, read_game_world

    there = {replay.game.world for log in logs for replay in log.replays}
    realest = next(world for world in reversed(GAME_WORLDS) if world in there)
    chosen = read_game_world(wanted) if wanted else realest
    return chosen, [world for world in GAME_WORLDS if world in there - {chosen}]


def _find(people: Sequence[PersonOverTime], name: str) -> PersonOverTime:
    from tangy_profiles.person import folded
    from tangy_tui.text.house import nobody_called

    for person in people:
        ids = {one.attention.id for one in person.games}
        if folded(name) == folded(person.name) or name in ids:
            return person
    raise TangyError(plain(nobody_called(name, [person.name for person in people])))


def _write(html: Path, text: str) -> None:
    from tangy_tui.pages import page

    page.check_place(html, "--html")
    page.write(html, text, "--html")
    print_line(plain(report_in(html)))


def _print_rows(columns: Sequence[str], rows: Iterator[tuple[str, ...]], title: str = "") -> None:
    from tangy_tui.ui.reports import print_rows

    print_rows(columns, list(rows), title)
