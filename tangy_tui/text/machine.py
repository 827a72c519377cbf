"""Words for the parts of this machine: which ones work, and how to mend the others."""

from __future__ import annotations

NO_CAMERA = "none is found; plug one in, or name a stream or a video."
NO_SPEECH = "pocketsphinx is not installed; commands are typed."
DECODES_SPEECH = "Tangy can decode spoken commands."
PIPED = "output goes to a pipe or file: Tangy speaks in lines."


def no_activity(package: str, name: str) -> str:
    """Say that a package does not hold the activity that it names."""
    return f"{package} has no {name}.toml."


def usable(package: str) -> str:
    """Say that what a package adds can be used."""
    return f"of {package} can be used."


def camera_forbidden(device: str, title: str) -> str:
    """Say what to do about a camera that this user may not use."""
    return f"this user may not use {device} ({title}); join the group video."


def speaks_with(program: str) -> str:
    """Say with which program Tangy speaks."""
    return f"Tangy can speak, with {program}."


def plays_with(player: str) -> str:
    """Say which program plays what Tangy says."""
    return f"{player} plays what Tangy says."


def shown_as_text(why: str) -> str:
    """Say why there is no sound, and what replaces it."""
    return f"{why}; what Tangy says is shown as text."


def dumb_terminal(term: str) -> str:
    """Say that a terminal, by its name, shows no screens."""
    return f"TERM={term or 'unset'}: Tangy speaks in lines."


def more_problems(count: int) -> str:
    """Say that the log has more problems than the one that was told."""
    return f" And {count} more: `tangy store check` names them."


def no_place(folder: object, why: str) -> str:
    """Say why nothing can be kept in a folder."""
    return f"{folder}: {why}; choose another folder with --data."
