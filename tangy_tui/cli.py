"""The command line: every way into the program, and its exit status.

Every verb prints one JSON document with `--json`. The exit status is 0 when done, 2 for bad input
(with one sentence on stderr), and 1 for anything else.
"""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from tangy_profiles.errors import TangyError
from tangy_tui import __version__


def main() -> None:
    """Run the command line and exit with its status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without UTF-8 still gets its line
    try:
        status = run()
    except TangyError as error:
        print(f"tangy: {error}", file=sys.stderr)
        status = 2
    except BrokenPipeError:
        sys.stderr.close()  # the reader has closed our output
        status = 1
    except KeyboardInterrupt:
        status = 130
    gc.freeze()  # or Python searches all loaded objects once more, for .4 s
    sys.exit(status if isinstance(status, int) else 0)


def run() -> object:
    """Run the command line's words.

    The option parser takes longer to load than most of the program needs to open, so it is
    loaded only if it is needed.
    """
    if sys.argv[1:] == ["--version"]:
        print(f"tangy {__version__}")
        return 0
    if (given := program_options(sys.argv[1:])) is not None:
        gc.disable()  # loading leaves no garbage; the screen collects again once it is drawn
        try:
            from tangy_tui.verbs.opening import full_screen, open_program

            if full_screen():
                return open_program(**given)
        finally:
            gc.enable()
    return parsed()


def program_options(words: Sequence[str]) -> dict[str, Any] | None:
    """Return the arguments of `open_program`; None if there are more than its plain options."""
    given: dict[str, Any] = {}
    rest = iter(words)
    for word in rest:
        name, equals, value = word.partition("=")
        if word == "--ascii":
            given["ascii_only"] = True
        elif name == "--link":
            value = value if equals else next(rest, "")
            if value not in ("slow", "fast", "auto"):
                return None
            os.environ["TANGY_LINK"] = value
        elif name in ("--data", "--robot"):
            value = value if equals else next(rest, "")
            if not value or value.startswith("-"):
                return None
            given[name[2:]] = Path(value) if name == "--data" else value
        else:
            return None
    return given


def parsed() -> object:
    """Run the requested verb."""
    import typer

    from tangy_profiles.reading import plain
    from tangy_tui.verbs.program import app

    try:
        return typer.main.get_command(app)(standalone_mode=False)
    except (typer.Abort, typer.Exit) as stop:
        return getattr(stop, "exit_code", 130)
    except Exception as error:
        # Typer carries its own copy of Click, whose usage errors have no public base class.
        if not hasattr(error, "format_message"):
            raise
        print(f"tangy: {plain(error.format_message())}", file=sys.stderr)
        return 2
