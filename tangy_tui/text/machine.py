"""Words for the parts of this machine: which ones work, and how to fix the others."""

from __future__ import annotations

NO_CAMERA = "none is found; plug one in, or name a stream or a video."
NO_SPEECH = "pocketsphinx is not installed; commands are typed."
DECODES_SPEECH = "Tangy can decode spoken commands."
PIPED = "output goes to a pipe or file: Tangy speaks in lines."


def no_activity(package: str, name: str) -> str:
    """Tell that a package does not contain the activity that it names."""
    return f"{package} has no {name}.toml."


def other_name(file: str, name: str) -> str:
    """Tell that an activity's file has another name than the activity in it."""
    return f"{file} says name = {name!r}: give both the same name, that no other activity has."


def usable(package: str) -> str:
    """Tell that an extension package can be used."""
    return f"of {package} can be used."


def camera_forbidden(device: str, title: str) -> str:
    """Tell what to do about a camera without permission."""
    return f"this user may not use {device} ({title}); join the group video."


def speaks_with(program: str) -> str:
    """Name the program that synthesises Tangy's speech."""
    return f"Tangy can speak, with {program}."


def plays_with(player: str) -> str:
    """Name the program that plays Tangy's speech."""
    return f"{player} plays what Tangy says."


def shown_as_text(why: str) -> str:
    """Tell why there is no sound, and what replaces it."""
    return f"{why}; what Tangy says is shown as text."


def dumb_terminal(term: str) -> str:
    """Tell that a terminal, by its name, cannot show screens."""
    return f"TERM={term or 'unset'}: Tangy speaks in lines."


def more_problems(count: int) -> str:
    """Tell how many more problems the log has."""
    return f" And {count} more: `tangy store check` names them."


def no_place(folder: object, why: str) -> str:
    """Tell why nothing can be stored in a folder."""
    return f"{folder}: {why}; choose another folder with --data."
