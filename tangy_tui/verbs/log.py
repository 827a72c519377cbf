"""`tangy log`: list the games, show them step by step, and set where they were played."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import counts_as
from tangy_tui.verbs.common import Data, Json, hand_on_options, print_json, print_line
from tangy_tui.verbs.opening import say_aside, say_notices

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.store import Store
    from tangy_tui.monitoring.games import Game
    from tangy_tui.monitoring.replay import GameReplay, Moment

app = typer.Typer(
    rich_markup_mode=None,
    help="List the games, or show one step by step. Without a command: list them.",
)

Which = Annotated[
    str,
    typer.Argument(metavar="GAME", help="A number of `tangy log list`, an id, or 'last'."),
]
Session = Annotated[
    str,
    typer.Argument(
        metavar="GAME", help="A number, an id, 'last'; or together: 'all', a day (2026-11-21)."
    ),
]
Of = Annotated[str, typer.Option("--activity", help="The activity's TOML file, if it is your own.")]


@app.callback(invoke_without_command=True)
def log(context: typer.Context, data: Data = None, as_json: Json = False) -> None:
    """List the games, where no verb is given."""
    if context.invoked_subcommand is None:
        log_list(data, as_json)
    else:
        hand_on_options(context)


@app.command("list")
def log_list(data: Data = None, as_json: Json = False) -> None:
    """List the games, the newest last."""
    from tangy_tui.monitoring.games import read_games

    with open_log(data) as (store, _):
        games = read_games(store)
    if as_json:
        from tangy_tui.text.endings import game_document

        print_json([game_document(game) for game in games])
        return
    from tangy_tui.text.old_games import unknown_words
    from tangy_tui.ui.log_report import print_games

    print_games(games, "" if data is None else str(data))
    if unknown := sum(game.world == "unknown" for game in games):
        print_line(unknown_words(unknown))


@app.command("show")
def log_show(game: Which, activity: Of = "", data: Data = None, as_json: Json = False) -> None:
    """Show a game: what Tangy saw, did and said.

    It goes step by step, with responses and faults.
    """
    from tangy_tui.monitoring.games import find_game, read_games
    from tangy_tui.monitoring.replay import read_replays
    from tangy_tui.text.log import replay_lines

    with open_log(data) as (store, names):
        found = find_game(read_games(store), game)
        known = known_activities_of([found], activity)
        (replay,) = read_replays(store, [found], known, names)
    if as_json:
        print_json(_document(replay))
        return
    _say_unknown([found], known)
    for line in replay_lines(replay, known.get(found.activity), lambda id: names.get(id, id)):
        print_line(plain(line))


@app.command("report", hidden=True)
def log_report(
    game: Session = "last",
    html: Annotated[
        Path | None, typer.Option("--html", help="Write the report as one page to this file.")
    ] = None,
    activity: Of = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Report on a session, as `tangy report session --full` does."""
    from tangy_tui.verbs.report import report_session

    report_session(game, html, True, activity, data, as_json)


@app.command("world")
def log_world(
    game: Annotated[
        str,
        typer.Argument(
            metavar="GAME", help="A number, an id, 'last', or 'unknown' (all in no world)."
        ),
    ],
    world: Annotated[
        str,
        typer.Argument(
            metavar="WORLD", help="Where it was played: simulated, bench, live, or unknown."
        ),
    ],
    by: Annotated[str, typer.Option("--by", help="Your name, for the log.")] = "",
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Set where a game was played.

    Use it if the list of games is wrong, or does not say.

    Version 0.6.0 and before did not log it, and the times of a game do not always show it.
    People's responses count only for games of the same world.
    """
    from tangy_profiles.game_world import UNKNOWN, read_game_world
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.interaction.game_worlds import GameWorlds
    from tangy_tui.monitoring.games import find_game, read_games

    wanted = read_game_world(world)
    with Store.open(data_folder(data)) as store:
        say_notices(store.notices)
        games = read_games(store)
        if game == UNKNOWN:
            changed = {one.id for one in games if one.world == UNKNOWN}
            GameWorlds(store).settle(sorted(changed), wanted, plain(by))
        else:
            one = find_game(games, game)
            changed = {one.id}
            GameWorlds(store).set(one.id, wanted, plain(by))
        now = [found for found in read_games(store) if found.id in changed]
    if as_json:
        told = [found.to_json() for found in now]
        print_json(told if game == UNKNOWN else told[0])
    for found in [] if as_json else now:
        print_line(plain(counts_as(found.number, found.world)))


@contextmanager
def open_log(data: Path | None) -> Iterator[tuple[Store, dict[str, str]]]:
    """Open the log for reading, with the names of the people."""
    from tangy_profiles.person import MOST_PEOPLE, load_people
    from tangy_profiles.store import Store
    from tangy_tui.app.register import guest_ids
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.text.register import with_guests

    with Store.open(data_folder(data), write=False) as store:
        say_notices(store.notices)
        names = {person.id: person.name for person in load_people(MOST_PEOPLE)}
        try:
            yield store, with_guests(names | store.names(), guest_ids(store))
        finally:
            say_aside(store)


def known_activities_of(games: Sequence[Game], file: str) -> dict[str, Activity]:
    """Load the activities of games that are available.

    Args:
        games: the games, which may know the files of their activities.
        file: an activity's file that takes precedence ("": none).

    Raises:
        TangyError: that file has a mistake, or none of the games is of its activity.
    """
    from tangy_profiles.activity import load_activity
    from tangy_tui.app.session_reports import played_activities

    wanted, known = {game.activity for game in games}, played_activities(games)
    if file:
        own = load_activity(file)
        if own.name not in wanted:
            played = ", ".join(sorted(wanted))
            raise TangyError(plain(f"--activity {file}: is {own.name!r}; played was {played}."))
        known[own.name] = own
    return known


def _say_unknown(games: Sequence[Game], known: dict[str, Activity]) -> None:
    from tangy_tui.text.sessions import unknown_words

    say_notices([unknown_words(name) for name in sorted({g.activity for g in games} - set(known))])


def _document(replay: GameReplay) -> dict[str, Any]:
    from tangy_tui.text.endings import game_document

    return {
        **game_document(replay.game),
        "seconds": replay.seconds if replay.timed else None,
        "moments": [_moment(moment, replay.timed) for moment in replay.moments],
        "fault_list": [fault.document() for fault in replay.faults],
    }


def _moment(moment: Moment, timed: bool) -> dict[str, Any]:
    when = {"seconds": moment.seconds if timed else None, "step": moment.step, "at": moment.at}
    return {**moment.to_json(), **when}
