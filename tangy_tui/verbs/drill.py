"""`tangy drill`: rehearse what to do when something goes wrong, and see the score."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.person import read_name
from tangy_tui.text.command_line import PREPARING_DRILL
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Ascii,
    Data,
    Json,
    Lines,
    Seed,
    Users,
    print_json,
    print_line,
)
from tangy_tui.verbs.opening import full_screen, open_workspace, say_notices

if TYPE_CHECKING:
    from tangy_profiles.drill_sheet import Sheet
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.monitoring.drill import Drill


def drill(
    rounds: Annotated[int, typer.Option(min=1, max=50, help="How many rounds.")] = 6,
    seed: Seed = None,
    who: Annotated[str | None, typer.Option(help="Who practises; default your login name.")] = None,
    scores: Annotated[bool, typer.Option("--scores", help="List earlier score sheets.")] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with a drill that was interrupted.")
    ] = False,
    discard: Annotated[
        bool, typer.Option("--discard", help="Begin a new drill, whatever was interrupted.")
    ] = False,
    plain_lines: Lines = False,
    activity: ActivityName = "",
    users: Users = REGISTERED,
    data: Data = None,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """Rehearse faults, and get a score.

    Say what is wrong in each round, and what you would do.

    With --json the answers come as lines on standard input. --scores lists the sheets of everybody,
    or of --who.
    """
    if who is not None:
        read_name(who, "--who: a name")
    with open_workspace(data, activity, users, write=not scores) as workspace:
        workspace.activity.need_cards()
        name = workspace.teacher if who is None else read_name(who, "--who: a name")
        if scores:
            _print_scores(workspace, "" if who is None else name, as_json=as_json)
            return
        past = _interrupted(workspace, name, resume=resume, discard=discard)
        if not (plain_lines or as_json) and full_screen():
            from tangy_tui.ui.run import run_drill

            past = past if resume else None  # otherwise the screen asks
            raise typer.Exit(
                run_drill(
                    workspace, rounds=rounds, seed=seed, who=name, ascii_only=ascii_only, past=past
                )
            )
        past = _by_lines(workspace, past, anew=as_json and not resume)
        from tangy_tui.app.drill_opening import open_drill

        if not as_json:
            print_line(PREPARING_DRILL)
        _hold(open_drill(workspace, name, seed=seed, rounds=rounds, past=past), as_json=as_json)


def _print_scores(workspace: Workspace, only: str, *, as_json: bool) -> None:
    """Print the score sheets of everybody, or of one person `only`."""
    from tangy_profiles.codec import encode
    from tangy_tui.monitoring.drill_log import read_sheets
    from tangy_tui.text.drills import sheets_lines
    from tangy_tui.text.times import local_time

    if as_json:
        sheets = read_sheets(workspace.store, only)
        print_json([{"at": sheet.at, **encode(sheet)} for sheet in sheets])
    else:
        for line in sheets_lines(read_sheets(workspace.store), local_time, only):
            print_line(line)


def _hold(made: Drill, *, as_json: bool) -> None:
    """Hold a drill by lines; with JSON, print its score sheet."""
    from tangy_profiles.codec import encode
    from tangy_tui.console.drills import drill_by_lines
    from tangy_tui.console.inputs import line_reader
    from tangy_tui.text.drills import left_words

    if not as_json:
        drill_by_lines(made, print_line, line_reader(None))
        return
    try:
        drill_by_lines(made, lambda _: None, line_reader(None), strict=True)
    except KeyboardInterrupt:
        say_notices([left_words(made)])
        raise
    if not made.over:
        say_notices([left_words(made)])
    print_json(encode(made.sheet))


def _interrupted(workspace: Workspace, who: str, *, resume: bool, discard: bool) -> Sheet | None:
    """Return the sheet of an interrupted drill, unless it is discarded.

    Raises:
        TangyError: there is none to resume, or both options were given.
    """
    from tangy_tui.monitoring.drill_log import interrupted_sheet, keep_interrupted
    from tangy_tui.text.drills import NO_INTERRUPTED_DRILL
    from tangy_tui.text.interruptions import BOTH

    if resume and discard:
        raise TangyError(BOTH)
    past = interrupted_sheet(workspace.store, who, workspace.activity.name)
    if past is None and resume:
        raise TangyError(NO_INTERRUPTED_DRILL)
    if past is not None and discard:
        keep_interrupted(workspace.store, past)
        return None
    return past


def _by_lines(workspace: Workspace, past: Sheet | None, *, anew: bool) -> Sheet | None:
    """Print what happens to an interrupted drill, which resumes unless `anew`."""
    from tangy_tui.monitoring.drill_log import keep_interrupted
    from tangy_tui.text.drills import begins_anew, goes_on

    if past is None:
        return None
    say_notices([begins_anew(past) if anew else goes_on(past)])
    if not anew:
        return past
    keep_interrupted(workspace.store, past)
    return None
