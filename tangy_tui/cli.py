"""The command line: the one place where worlds, store and screens are put together.

Every verb prints one JSON document with `--json`. The exit status is 0 when done, 2 for bad input
(with one sentence on stderr), and 1 for anything else.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import cache
from typing import Annotated, Any

import typer

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui import __version__
from tangy_tui.verbs import (
    activity,
    camera,
    cards,
    demonstrations,
    drill,
    experiment,
    faces,
    faces_enrol,
    learn,
    listen,
    live,
    log,
    machine,
    map,
    mic,
    mic_check,
    people,
    people_forget,
    people_speech,
    play,
    read_card,
    requests,
    say,
    sensors,
    teach,
)
from tangy_tui.verbs.common import Ascii, Data, full_screen, open_house

app = typer.Typer(
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    help="Teach a social robot a group activity, and let it run that activity for you.",
)


@app.callback(invoke_without_command=True)
def program(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Say the version.")] = False,
    robot: Annotated[
        str | None, typer.Option("--robot", help="Whose games are run: a robot, or its TOML.")
    ] = None,
    data: Data = None,
    ascii_only: Ascii = False,
) -> None:
    """Open the program, where no verb is given; options before a verb are the verb's."""
    if version:
        print(f"tangy {__version__}")
        raise typer.Exit
    given: dict[str, Any] = {} if data is None else {"data": str(data)}
    if ascii_only:
        given["ascii_only"] = True
    if robot is not None:
        given["robot"] = robot
    context.default_map = _defaults(context.command, given)
    if context.invoked_subcommand is None:
        if not full_screen():
            from tangy_tui.ui.terminal import terminal_kind

            print(f"No screens here ({terminal_kind().reason}): try `tangy teach --plain`.\n")
            print(context.get_help())
            return
        from tangy_profiles.fault_file import load_faults
        from tangy_tui.ui.run import run_program

        with open_house(data, "bingo", 4, robot=robot or "tangy") as house:
            load_faults(house.robot)  # what is wrong with its file is said before a screen opens
            raise typer.Exit(run_program(house, ascii_only=ascii_only))


def _defaults(command: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the defaults of a command, and of those below it, that were given before it."""
    found = {option.name: given[option.name] for option in command.params if option.name in given}
    for name, below in getattr(command, "commands", {}).items():
        found[name] = _defaults(below, given)
    return found


VERBS: tuple[Callable[..., None], ...] = (
    teach.teach,
    learn.learn,
    learn.policy,
    play.play,
    play.demo,
    live.live,
    drill.drill,
    listen.listen,
    say.say,
    camera.camera,
    camera.capture,
    requests.requests,
    sensors.sensors,
    read_card.read_card,
    machine.doctor,
)
for verb in VERBS:
    app.command()(verb)
app.command("map")(map.draw_map)
people.app.command("pronounce")(people_speech.people_pronounce)
people.app.command("voice")(people_speech.people_voice)
people.app.command("forget")(people_forget.people_forget)
app.add_typer(demonstrations.app, name="demonstrations")
app.add_typer(people.app, name="people")
mic.app.command("check")(mic_check.check)
app.add_typer(mic.app, name="mic")
app.add_typer(experiment.app, name="experiment")
app.add_typer(activity.app, name="activity")
app.add_typer(cards.app, name="cards")
faces.app.command("enrol")(faces_enrol.faces_enrol)
app.add_typer(faces.app, name="faces")
app.add_typer(log.app, name="log")


@cache
def commands() -> Callable[..., Any]:
    """Return all verbs with their options; to make them takes longer than most verbs run."""
    return typer.main.get_command(app)


def main() -> None:
    """Run the command line and exit with its status."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without UTF-8 still gets its line
    try:
        status = commands()(standalone_mode=False)
    except TangyError as error:
        print(f"tangy: {error}", file=sys.stderr)
        status = 2
    except BrokenPipeError:
        sys.stderr.close()  # whoever read our output has had enough
        status = 1
    except KeyboardInterrupt:
        status = 130
    except (typer.Abort, typer.Exit) as stop:
        status = getattr(stop, "exit_code", 130)
    except Exception as error:
        # Typer carries its own copy of Click, whose usage errors have no public base class.
        if not hasattr(error, "format_message"):
            raise
        print(f"tangy: {plain(error.format_message())}", file=sys.stderr)
        status = 2
    sys.exit(status if isinstance(status, int) else 0)
