"""`tangy store`: whether the log of a data folder is sound."""

from __future__ import annotations

import typer

from tangy_profiles.reading import plain
from tangy_tui.text.numbers import counted
from tangy_tui.verbs.common import Data, Json, print_json, print_line

app = typer.Typer(rich_markup_mode=None, help="The log that everything is kept in: check it.")


@app.command("check")
def store_check(data: Data = None, as_json: Json = False) -> None:
    """Read the whole log and name what is wrong with it; the exit status is 1 if anything is."""
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.monitoring.log_check import log_problems

    folder = data_folder(data)
    with Store.open(folder, write=False) as store:
        problems = [*store.notices, *log_problems(store)]
        events = sum(store.kinds().values())
    if as_json:
        print_json(
            {"folder": str(folder), "ok": not problems, "events": events, "problems": problems}
        )
    else:
        for problem in problems:
            print_line(plain(problem))
        print_line(plain(f"{folder}: {counted(events, 'event')}, {_found(len(problems))}."))
    if problems:
        raise typer.Exit(1)


def _found(problems: int) -> str:
    if not problems:
        return "nothing is wrong"
    return counted(problems, "thing is wrong", "things are wrong")
