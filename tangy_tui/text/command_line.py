"""Closing words of commands: where a result is, and which command comes next."""

from __future__ import annotations

from collections.abc import Iterable

from tangy_profiles.plain_text import plain
from tangy_profiles.reading import nearest
from tangy_tui.text.numbers import counted

TEACH_YOURSELF = "Teach it yourself with `tangy teach`. See all commands with `tangy --help`."
SWITCHING_ON = "Switching the robot on ..."
PREPARING_DRILL = "Tangy is preparing the drill ..."
WHAT_TO_LISTEN_TO = (
    "Give WAV files, a folder of them with --bench DIR, or sentences with --text FILE."
)
PRINTING = "Print them at full size (100%), and cut along the marks."


def no_screens(why: str) -> str:
    """Tell why screens cannot be drawn here, and what to use instead."""
    return f"No screens here ({why}). Try `tangy teach --plain`.\n"


def report_in(place: object) -> str:
    """Tell where a report was written."""
    return f"The report is in {place}."


PLAIN_NEEDS_A_VERB = (
    "--plain needs to know what you want to do: `tangy teach --plain` teaches, "
    "`tangy play --plain` plays a simulated game, `tangy live --plain` a live one."
)


def games_to_read(folder: object) -> str:
    """Tell where the log of games with a miss, a false alarm, or an early end is."""
    return (
        "A fault was missed, a diagnosis was wrong, or a game ended early. "
        f"To read these games: tangy log --data {folder}"
    )


def cut_off(file: object, seconds: float) -> str:
    """Tell that a recording ends some s early."""
    return f"{file}: ends {seconds:.1f} s early; what is there was heard."


def recordings_deleted(count: int) -> str:
    """Tell how many recordings were deleted."""
    deleted = f"{counted(count, 'recording')} deleted"
    return f"{deleted}. Tangy records nothing more until a person agrees again."


def counts_as(game: int, world: str) -> str:
    """Tell in which world a game counts as played."""
    if world == "unknown":
        return f"It is not known where game {game} was played."
    return f"Game {game} counts as a {world} game."


def log_hints(variable: str) -> tuple[str, ...]:
    """Tell how to read the logs of the processes, and which variable changes their level."""
    return (
        "Each line shows the id of its command in brackets. Search all files for it with grep.",
        f"Set {variable}=debug to log more, {variable}=error to log less.",
    )


def more_left_out(count: int) -> str:
    """Tell that the log left out more rows than were named."""
    entries = counted(count, "more entry is", "more entries are")
    return f"{entries} left out. `tangy store check` names them."


def experiment_stopped(pieces: int) -> str:
    """Tell how much of a stopped experiment is stored."""
    return (
        f"tangy: Stopped. {pieces} finished pieces of work are kept. "
        "Run the same command again to go on from there."
    )


def throats(variants: list[str]) -> str:
    """List the variants of a voice."""
    return f"\nAdd one of these to change a voice, as in en-gb+f3: {', '.join(variants)}."


def no_option(command: str, option: str) -> str:
    """Tell that a command does not have an option that was given before it."""
    return f"`{command}` has no option {option}: `{command} --help` lists its options."


def no_command(name: str, known: Iterable[str]) -> str:
    """Tell that there is no command of a name, and which one was probably meant."""
    return plain(f"There is no command {name!r}; {nearest(name, known)}")
