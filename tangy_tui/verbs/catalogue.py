"""The commands and their modules, each of which is imported when its command is called."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import typer
from typer.core import TyperGroup

from tangy_profiles.errors import TangyError
from tangy_tui.text.command_line import no_command


@dataclass(frozen=True)
class Verb:
    """Where a command is defined: a function of a module, or a module's `app` with subcommands."""

    module: str
    function: str = ""
    below: tuple[tuple[str, str, str], ...] = ()
    """Subcommands with modules of their own: name, module, function."""

    def load(self, name: str) -> Any:
        """Import the verb and return it as a command of this name."""
        module = import_module(f"tangy_tui.verbs.{self.module}")
        parent = typer.Typer(add_completion=False, rich_markup_mode=None)
        parent.callback()(lambda: None)  # so that even a single command is a subcommand
        if self.function:
            parent.command(name)(getattr(module, self.function))
        else:
            parent.add_typer(module.app, name=name)
        command: Any = typer.main.get_command(parent)
        found = command.commands[name]
        for below, other, function in self.below:
            found.commands[below] = Verb(other, function).load(below)
        return found


VERBS = {
    "teach": Verb("teach", "teach"),
    "learn": Verb("learn", "learn"),
    "policy": Verb("learn", "policy"),
    "play": Verb("play", "play"),
    "demo": Verb("play", "demo"),
    "live": Verb("live", "live"),
    "watch": Verb("watch", "watch"),
    "serve": Verb("serve", "serve"),
    "drill": Verb("drill", "drill"),
    "listen": Verb("listen", "listen"),
    "say": Verb("say", "say"),
    "camera": Verb("camera", "camera"),
    "capture": Verb("camera", "capture"),
    "requests": Verb("requests", "requests"),
    "sensors": Verb("sensors", "sensors"),
    "read-card": Verb("read_card", "read_card"),
    "doctor": Verb("machine", "doctor"),
    "map": Verb("map", "draw_map"),
    "demonstrations": Verb("demonstrations"),
    "people": Verb(
        "people",
        below=(
            ("pronounce", "people_speech", "people_pronounce"),
            ("voice", "people_speech", "people_voice"),
            ("add", "people_register", "people_add"),
            ("archive", "people_register", "people_archive"),
            ("bring-back", "people_register", "people_bring_back"),
            ("forget", "people_forget", "people_forget"),
        ),
    ),
    "mic": Verb("mic", below=(("check", "mic_check", "check"),)),
    "experiment": Verb("experiment"),
    "activity": Verb(
        "activity",
        below=(
            ("new", "activity_new", "activity_new"),
            ("import", "activity_writing", "activity_import"),
            ("convert", "activity_writing", "activity_convert"),
        ),
    ),
    "cards": Verb("cards"),
    "faces": Verb("faces", below=(("enrol", "faces_enrol", "faces_enrol"),)),
    "log": Verb("log"),
    "report": Verb("report"),
    "store": Verb("store"),
}
"""In the order of the help page."""


class LazyVerbs(TyperGroup):
    """The commands of the program: each is imported when it is called, all of them for help."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Return the names of all commands, in the order of the help page."""
        return list(VERBS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import a command and return it; None if there is none of this name."""
        if cmd_name not in VERBS:
            return None
        if cmd_name not in self.commands:
            self.commands[cmd_name] = VERBS[cmd_name].load(cmd_name)
        return self.commands[cmd_name]

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command of the first word; the parser would know none that was not called yet.

        Raises:
            TangyError: there is none of this name.
        """
        if args and args[0] not in VERBS and not args[0].startswith("-"):
            raise TangyError(no_command(args[0], VERBS))
        return super().resolve_command(ctx, args)
