"""Pictures and sounds of an activity: files beside its file, named there or in a column."""

from __future__ import annotations

import os.path
from collections.abc import Iterator, Mapping
from pathlib import Path

from tangy_profiles.declared.model import DeclaredBehaviour, Items, MediaFile
from tangy_profiles.declared.section import Section
from tangy_profiles.declared.vocabulary import SLOT
from tangy_profiles.errors import ProfileError
from tangy_profiles.given_file import open_given, read_given
from tangy_profiles.plain_text import plain
from tangy_profiles.reading import nearest
from tangy_profiles.wav_length import wav_seconds

LARGEST_PICTURE = 4_000_000  # bytes
LARGEST_SOUND = 40_000_000  # bytes
LONGEST_SOUND = 180.0  # s
BEGINNING = 12
"""The bytes that identify the kind of a picture file."""
KINDS = {b"\x89PNG\r\n\x1a\n": "image/png", b"\xff\xd8\xff": "image/jpeg", b"GIF8": "image/gif"}


def picture_kind(content: bytes) -> str:
    """Return the media type of a picture from its first bytes ("": not a picture)."""
    if content[:4] == b"RIFF" and content[8:12] == b"WEBP":
        return "image/webp"
    return next((kind for begin, kind in KINDS.items() if content.startswith(begin)), "")


def read_picture(path: str) -> tuple[bytes, str]:
    """Read a picture, and its media type.

    Raises:
        ProfileError: it is missing, too large, or no picture.
    """
    content = read_given(Path(path), LARGEST_PICTURE, ProfileError)
    kind = picture_kind(content)
    if not kind:
        raise ProfileError(f"{plain(path)}: is no PNG, JPEG, GIF or WebP picture.")
    return content, kind


def read_media(
    top: Section, behaviours: Mapping[str, DeclaredBehaviour], items: Items, folder: Path
) -> dict[str, MediaFile]:
    """Check every picture and sound that a file names, and record those that are unusable.

    Args:
        top: the activity's file.
        behaviours: its behaviours, which name them.
        items: its items, whose columns may name them.
        folder: the folder of all these files.

    Returns:
        The usable files, by name.
    """
    found: dict[str, MediaFile] = {}
    wrong: set[str] = set()
    for behaviour in behaviours.values():
        section = top.table("behaviours").table(behaviour.name)
        for key, text in (("picture", behaviour.picture), ("sound", behaviour.sound)):
            for row, name in _named(section, key, text, items):
                if name in found or name in wrong:
                    continue
                try:
                    found[name] = _media_file(folder, name, key)
                except ProfileError as error:
                    wrong.add(name)
                    columns = ", ".join(SLOT.findall(text))
                    place = f"row {row + 2}, column {columns}: " if columns else ""
                    section.wrong(key, f"{place}{error}", text)
    return found


def file_name(text: str, items: Items, row: int) -> str:
    """Return the file name that a text gives for a row ("": none)."""
    cells = [items.value(row, slot) for slot in SLOT.findall(text)]
    return SLOT.sub(lambda match: items.value(row, match.group(1)), text) if all(cells) else ""


def _named(section: Section, key: str, text: str, items: Items) -> Iterator[tuple[int, str]]:
    """Yield each row (-1: independent of rows) with its file name."""
    slots = SLOT.findall(text)
    wrong = [slot for slot in slots if slot not in items.columns]
    for slot in wrong:
        near = nearest(slot, items.columns)
        section.wrong(key, f"{{{slot}}} is not a column of the items; {near}", text)
    if wrong or not text:
        return
    for row in range(len(items.rows)) if slots else (-1,):
        if name := file_name(text, items, row):
            yield row, name


def _media_file(folder: Path, name: str, key: str) -> MediaFile:
    """Check one file.

    Raises:
        ProfileError: it is missing, too large, or not of its kind.
    """
    if Path(name).name != name:
        raise ProfileError(f"{plain(name)} must be the name of a file beside this one")
    path, seconds = folder / name, 0.0
    if not os.path.exists(path):  # noqa: PTH110 - false for a name that is too long
        raise ProfileError(f"there is no file {plain(name)!r} beside this one")
    if key == "picture":
        with open_given(path, LARGEST_PICTURE, ProfileError, called=plain(name)) as file:
            if not picture_kind(file.read(BEGINNING)):
                raise ProfileError(f"{plain(name)} is no PNG, JPEG, GIF or WebP picture")
    else:
        with open_given(path, LARGEST_SOUND, ProfileError, called=plain(name)) as file:
            file.read(BEGINNING)
        seconds = wav_seconds(path)
        if not seconds:
            raise ProfileError(f"{plain(name)} is no WAV sound that can be played")
        if seconds > LONGEST_SOUND:
            raise ProfileError(f"{plain(name)} must last {LONGEST_SOUND:.0f} s at most")
    return MediaFile(str(path.resolve()), seconds)
