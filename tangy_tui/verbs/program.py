"""`tangy` itself: its options, its subcommands, and the application if none is given."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Annotated, Any

import typer

from tangy_profiles.defaults import USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import nearest
from tangy_tui import __version__
from tangy_tui.app.user_settings import LINK_SPEEDS, LINK_VARIABLE
from tangy_tui.text.command_line import PLAIN_NEEDS_A_VERB, no_screens
from tangy_tui.ui.terminal import terminal_kind
from tangy_tui.verbs.catalogue import LazyVerbs
from tangy_tui.verbs.common import Ascii, Data
from tangy_tui.verbs.opening import full_screen, open_program

app = typer.Typer(
    cls=LazyVerbs,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Teach a social robot a group activity, and let it run that activity for you.",
)


@app.callback(invoke_without_command=True)
def program(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
    robot: Annotated[
        str | None, typer.Option("--robot", help="The robot to use: its name, or its TOML.")
    ] = None,
    data: Data = None,
    ascii_only: Ascii = False,
    link: Annotated[
        str, typer.Option("--link", help="Speed of the link to your terminal: auto, slow, fast.")
    ] = "",
    plain_lines: Annotated[bool, typer.Option("--plain", hidden=True)] = False,
) -> None:
    """Open the program, where no verb is given; options before a verb are the verb's."""
    if version:
        print(f"tangy {__version__}")
        raise typer.Exit
    if link:
        if link not in LINK_SPEEDS:
            raise typer.BadParameter(nearest(link, LINK_SPEEDS), param_hint="--link")
        os.environ[LINK_VARIABLE] = link
    given: dict[str, Any] = {} if data is None else {"data": str(data)}
    if ascii_only:
        given["ascii_only"] = True
    if robot is not None:
        given["robot"] = robot
    called = context.invoked_subcommand
    if plain_lines:
        if called is None:
            raise TangyError(PLAIN_NEEDS_A_VERB)
        given["plain_lines"] = True
    if called is not None:
        verb = context.command.get_command(context, called)  # type: ignore[attr-defined]
        context.default_map = {called: _defaults(verb, given)}
    elif full_screen():
        raise typer.Exit(open_program(data, robot=robot or USUAL_ROBOT, ascii_only=ascii_only))
    else:
        print(no_screens(terminal_kind().reason))
        print(context.get_help())


def _defaults(command: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the defaults of a command and its subcommands that were given before it."""
    found = {option.name: given[option.name] for option in command.params if option.name in given}
    for name, below in getattr(command, "commands", {}).items():
        found[name] = _defaults(below, given)
    return found
