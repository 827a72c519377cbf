"""Options and output functions that the commands share."""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Callable
from dataclasses import fields
from inspect import Parameter, Signature
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Annotated, Any, TextIO, TypeVar, get_type_hints

import typer

from tangy_profiles.defaults import REGISTERED as REGISTERED
from tangy_profiles.errors import TangyError
from tangy_tui.text.command_line import no_option

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    Options = TypeVar("Options", bound=DataclassInstance)

Json = Annotated[bool, typer.Option("--json", help="Print one JSON document, nothing else.")]
Seed = Annotated[int | None, typer.Option(help="Repeat the same simulated games.")]
Data = Annotated[Path | None, typer.Option(help="The data folder, instead of your own.")]
ActivityName = Annotated[
    str, typer.Option("--activity", help="An activity, or its TOML; usually the chosen one.")
]
Users = Annotated[
    int,
    typer.Option(
        help="How many people take part, 1 to 24. Default: everybody registered.",
        show_default=False,
    ),
]
RoomName = Annotated[
    str,
    typer.Option(
        "--room", metavar="NAME|FILE", help="The room: a name, or its TOML; usually the chosen one."
    ),
]
Ascii = Annotated[bool, typer.Option("--ascii", help="Draw with plain ASCII characters only.")]
Games = Annotated[int, typer.Option(min=1, help="How many games.")]
Lines = Annotated[bool, typer.Option("--plain", help="Use lines instead of a screen.")]


def takes(kind: type[Options]) -> Callable[[Callable[[Options], None]], Callable[..., None]]:
    """Make a verb of a function: Typer reads a parameter from each field of its dataclass.

    Each field has a default.
    """
    types = get_type_hints(kind, include_extras=True)
    parameters = [
        Parameter(
            field.name,
            Parameter.KEYWORD_ONLY,
            default=field.default,
            annotation=types[field.name],
        )
        for field in fields(kind)
    ]

    def verb_of(run: Callable[[Options], None]) -> Callable[..., None]:
        def verb(**given: Any) -> None:
            run(kind(**given))

        verb.__name__, verb.__doc__, verb.__module__ = run.__name__, run.__doc__, run.__module__
        verb.__annotations__ = {one.name: one.annotation for one in parameters}
        verb.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
        return verb

    return verb_of


def hand_on_options(context: typer.Context) -> None:
    """Make the options that stand before a verb of a group the defaults of that verb.

    Raises:
        TangyError: the verb does not have one of these options.
    """
    group: Any = context.command
    verb = str(context.invoked_subcommand)
    known = {option.name for option in group.get_command(context, verb).params}
    given: dict[str, Any] = {}
    for option in group.params:
        source = context.get_parameter_source(option.name)
        if source is None or source.name != "COMMANDLINE":
            continue
        if option.name not in known:
            raise TangyError(no_option(f"{context.command_path} {verb}", option.opts[0]))
        given[option.name] = context.params[option.name]
    defaults = context.default_map or {}
    context.default_map = {verb: {**defaults.get(verb, {}), **given}}


def as_given(data: Path | None, users: int = REGISTERED) -> str:
    """Return the options with which a command to copy uses the same data folder."""
    folder = "" if data is None else f" --data {shlex.quote(str(data))}"
    return folder + ("" if users == REGISTERED else f" --users {users}")


def print_line(line: str, to: TextIO | None = None) -> None:
    """Print a line at once, to a stream (default: stdout); on a terminal, wrap it between words."""
    out = to or sys.stdout
    print(fitted(line, _columns(out)), file=out, flush=True)


def fitted(line: str, columns: int) -> str:
    """Wrap a line between words if it is longer than some columns; 0 never wraps."""
    if not columns or len(line) <= columns:
        return line
    inset = line[: len(line) - len(line.lstrip())]
    further = f"{inset}  " if inset else ""
    return "\n".join(
        wrap(line, columns, subsequent_indent=further, break_long_words=False,
             break_on_hyphens=False, tabsize=1)
    )  # fmt: skip


def _columns(out: TextIO) -> int:
    """Return the width of the terminal for output; 0 if it is none."""
    try:
        return os.get_terminal_size(out.fileno()).columns if out.isatty() else 0
    except (OSError, ValueError):  # it is closed, or has no file descriptor
        return 0


def print_json(document: Any) -> None:
    """Print a JSON document."""
    print(json.dumps(document, ensure_ascii=False, indent=2))
