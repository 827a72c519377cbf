"""`tangy watch`: a second console that shows another program's games, and can stop the robot."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tangy_tui.verbs.common import Ascii, Data, print_line
from tangy_tui.verbs.opening import full_screen, say_notices, watch_program

if TYPE_CHECKING:
    from tangy_tui.app.watching import Guest

Stop = Annotated[bool, typer.Option("--stop", help="Stop the robot now, and leave.")]
By = Annotated[str, typer.Option("--by", help="Your name; the log shows it with a STOP.")]
Lines = Annotated[
    bool, typer.Option("--plain", help="Use lines instead of a screen, on any terminal.")
]
JsonLines = Annotated[
    bool, typer.Option("--json", help="Print a JSON document on each line, as things happen.")
]


def watch(
    stop: Stop = False,
    plain_lines: Lines = False,
    by: By = "",
    data: Data = None,
    as_json: JsonLines = False,
    ascii_only: Ascii = False,
) -> None:
    """Watch the game of another Tangy, and stop it if needed.

    It shows what happens as it happens, and changes nothing. ctrl+x (--stop) stops the robot at
    once; the log says who stopped it.
    """
    from tangy_profiles.store import Store
    from tangy_tui.app.teacher_profile import login_name
    from tangy_tui.app.watching import Guest
    from tangy_tui.app.workspace import data_folder
    from tangy_tui.text.watching import ONLOOKER

    who, folder = by or login_name(ONLOOKER), data_folder(data)
    if stop:
        _stop(Guest(folder), who)
    elif not (plain_lines or as_json) and full_screen():
        raise typer.Exit(watch_program(data, who=who, ascii_only=ascii_only))
    else:
        from tangy_tui.console.watching import WatchingLines

        with Store.open(folder, write=False) as store:
            say_notices(store.notices)
            WatchingLines(folder, store, print_line, as_json=as_json).run()


def _stop(guest: Guest, who: str) -> None:
    """Stop the robot, and wait for the answer.

    Raises:
        TangyError: there is no game to stop.
    """
    from tangy_profiles.errors import TangyError
    from tangy_tui.app.watching import NobodyThere
    from tangy_tui.text.watching import NOTHING_TO_STOP, STOPPED_HERE

    try:
        guest.stop(who)
        answered = guest.answered()
    except NobodyThere:
        answered = False
    finally:
        guest.close()
    if not answered:
        raise TangyError(NOTHING_TO_STOP)
    print(STOPPED_HERE)
