"""`tangy store`: check the log of a data folder."""

from __future__ import annotations

import typer

from tangy_profiles.reading import plain
from tangy_tui.text.store import accepted, log_checked
from tangy_tui.verbs.common import Data, Json, print_json, print_line

app = typer.Typer(rich_markup_mode=None, help="Check the log in which Tangy keeps everything.")


@app.command("check")
def store_check(data: Data = None, as_json: Json = False) -> None:
    """Read the whole log, and list its problems.

    The exit status is 1 if there are any.
    """
    from tangy_profiles.errors import StoreError
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.monitoring.log_check import log_problems
    from tangy_tui.text.store import problem_words

    folder = data_folder(data)
    problems, events = [], 0
    try:
        with Store.open(folder, write=False) as store:
            problems = list(dict.fromkeys([*store.notices, *problem_words(log_problems(store))]))
            events = sum(store.kinds().values())
    except StoreError as error:
        problems.append(str(error))
    if as_json:
        print_json(
            {"folder": str(folder), "ok": not problems, "events": events, "problems": problems}
        )
    else:
        for problem in problems:
            print_line(plain(problem))
        print_line(plain(log_checked(str(folder), events, len(problems))))
    if problems:
        raise typer.Exit(1)


@app.command("accept")
def store_accept(data: Data = None, as_json: Json = False) -> None:
    """Accept that events of the log are lost.

    Tangy then stops reminding you.
    """
    from tangy_profiles.losses import loss_words
    from tangy_profiles.store import Store
    from tangy_tui.app.workspace import data_folder

    folder = data_folder(data)
    with Store.open(folder) as store:
        losses = [loss_words(loss) for loss in store.accept_losses()]
    if as_json:
        print_json({"folder": str(folder), "accepted": losses})
        return
    for line in (*losses, accepted(len(losses))):
        print_line(plain(line))
