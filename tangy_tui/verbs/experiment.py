"""`tangy experiment`: repeat the paper's scenarios, and compare the results with the paper."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.command_line import experiment_stopped, games_to_read, report_in
from tangy_tui.verbs.bench_options import Load
from tangy_tui.verbs.common import ActivityName, Data, Json, print_json

if TYPE_CHECKING:
    from tangy_tui.experiments.sweep import Where

app = typer.Typer(rich_markup_mode=None, help="Repeat the paper's experiments, beside its figures.")

Seed = Annotated[int, typer.Option(min=0, help="Another seed, other games.")]
Jobs = Annotated[int, typer.Option(help="How many processes to use; -1: one for each core.")]
Dask = Annotated[str | None, typer.Option(metavar="ADDRESS", help="Use this Dask cluster instead.")]
Fresh = Annotated[bool, typer.Option("--fresh", help="Run finished parts again, too.")]
Report = Annotated[
    Path | None, typer.Option(metavar="FILE.html", help="Write a page with figures and tables.")
]


@app.command("1")
def first(
    seeds: Annotated[int, typer.Option(min=1, max=10_000, help="Sequences of games.")] = 100,
    users: Annotated[
        int | None, typer.Option(min=1, max=8, help="People in guided games, instead of 1 to 8.")
    ] = None,
    no_typing: Annotated[
        bool, typer.Option("--no-typing", help="Skip typing a game in real time (takes minutes).")
    ] = False,
    report: Report = None,
    activity: ActivityName = DEFAULT_ACTIVITY,
    jobs: Jobs = -1,
    dask: Dask = None,
    fresh: Fresh = False,
    seed: Seed = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Learn: how many demonstrations the policy needs.

    Five teachers, their mistakes, and the minutes they take.
    """
    from tangy_tui.experiments.scenarios import Learning, learning

    asked = Learning(
        activity, seeds, range(1, 9) if users is None else [users], seed, not no_typing
    )
    _run(lambda where: learning(asked, where), data, jobs, dask, fresh, report, as_json)


@app.command("2")
def second(
    people: Annotated[int, typer.Option(min=1, help="Simulated people in all.")] = 2000,
    users: Annotated[int, typer.Option(min=1, max=8, help="People in a group.")] = 4,
    report: Report = None,
    activity: ActivityName = DEFAULT_ACTIVITY,
    jobs: Jobs = -1,
    dask: Dask = None,
    fresh: Fresh = False,
    seed: Seed = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Persuade: how often the best strategy is chosen.

    It compares all methods of choosing one, over the interactions.
    """
    from tangy_tui.experiments.scenarios import PersuasionScenario, persuasion

    asked = PersuasionScenario(activity, users, people, seed)
    _run(lambda where: persuasion(asked, where), data, jobs, dask, fresh, report, as_json)


@app.command("3")
def third(
    games: Annotated[int, typer.Option(min=1, max=10_000, help="Games in all.")] = 20,
    users: Annotated[int, typer.Option(min=1, max=8, help="People in a game.")] = 4,
    simulated: Annotated[
        bool,
        typer.Option("--simulated", help="Simulate all of it (seconds, not hours on the bench)."),
    ] = False,
    load: Load = 0,
    report: Report = None,
    activity: ActivityName = DEFAULT_ACTIVITY,
    jobs: Jobs = -1,
    dask: Dask = None,
    fresh: Fresh = False,
    seed: Seed = 0,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Recover: faults induced, diagnosed, recovered from.

    They are played on the bench: cards, faces, scans and signs are rendered, and go through the
    drivers and all that a real robot has. --simulated leaves that out.
    """
    from tangy_tui.app.machine_load import machine_load
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.experiments.scenarios import Recovering, recovery

    if load and simulated:
        raise TangyError("--load: only bench games are played on a busy machine.")
    asked = Recovering(activity, users, games, seed, load)

    def scenario(where: Where) -> dict[str, Any]:
        if simulated:
            return recovery(asked, where)
        from tangy_tui.experiments.device_faults import GAMES_A_PIECE, play_on_bench

        bench = partial(play_on_bench, logs=data_folder(data) / "experiments" / "logs")
        return recovery(asked, where, bench=bench, a_piece=GAMES_A_PIECE)

    with machine_load(load):
        _run(scenario, data, jobs, dask, fresh, report, as_json)


def _run(
    scenario: Callable[[Where], dict[str, Any]],
    data: Path | None,
    jobs: int,
    dask: str | None,
    fresh: bool,
    report: Path | None,
    as_json: bool,
) -> None:
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.experiments.report import report as page_of
    from tangy_tui.experiments.sweep import Where
    from tangy_tui.pages import page
    from tangy_tui.text.comparison import SOURCES, compare

    if jobs == 0 or jobs < -1:
        raise TangyError(f"--jobs {jobs}: say how many processes, or -1 for one on each core.")
    if report is not None:
        page.check_place(report)
    with _progress() as tell:
        document = scenario(Where(data_folder(data), jobs, dask, fresh, tell))
    if report is not None:
        page.write(report, page_of(document))
    if as_json:
        print_json({**document, "compared": [asdict(row) for row in compare(document)]})
        _end(document)
        return
    for row in compare(document):
        print(f"{row.what} ({row.source})\n  paper: {row.paper}\n  here:  {row.here}")
        print(f"  {row.words}")
    for name, words in SOURCES.items():
        print(f"({name}: {words}.)")
    for folder in document.get("logs", ()):
        print(plain(games_to_read(folder)))
    if report is not None:
        print(plain(report_in(report)))
    _end(document)


def _end(document: dict[str, Any]) -> None:
    """Exit with status 1 if games stopped early, for scripts."""
    if document.get("stopped"):
        raise typer.Exit(1)


@contextmanager
def _progress() -> Iterator[Callable[[str, int, int], None]]:
    """Show a progress bar for each sweep on a terminal; if interrupted, tell how to resume."""
    from rich.console import Console
    from rich.progress import Progress, TaskID

    bars: dict[str, TaskID] = {}
    done: dict[str, int] = {}
    console = Console(stderr=True)
    try:
        with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:

            def tell(name: str, count: int, total: int) -> None:
                done[name] = count
                if name not in bars:
                    bars[name] = progress.add_task(name, total=total)
                progress.update(bars[name], completed=count)

            yield tell
    except KeyboardInterrupt:
        pieces = sum(done.values())
        print(experiment_stopped(pieces), file=sys.stderr)
        raise
