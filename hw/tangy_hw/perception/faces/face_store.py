"""Stores face features in a data folder, never images, and only with consent.

Each person has a file for each kind of features, DATA/faces/KIND-PERSON.face: a JSON line with its
metadata, and the rows as 16-bit floats. The log records who has consented.
"""

from __future__ import annotations

import json
import os
import zlib
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import quote, unquote

from tangy_hw.perception.faces.face_detector import FaceError
from tangy_profiles.people_records import FaceConsent, FaceForgotten
from tangy_profiles.reading import plain
from tangy_profiles.store import Store

FOLDER = "faces"  # in the data folder
ENDING = ".face"
FORMAT = 1
LARGEST_ROWS, LARGEST_COLUMNS = 1000, 100_000


class NoConsent(FaceError):
    """A person has not consented to storing features of their face."""


def consented(store: Store) -> frozenset[str]:
    """Return the people who have consented to face recognition, and not withdrawn since."""
    agreed: set[str] = set()
    for event in store.events(FaceConsent, FaceForgotten):
        if event.person is None:
            continue
        if isinstance(event.record, FaceConsent) and event.record.yes:
            agreed.add(event.person)
        else:
            agreed.discard(event.person)
    return frozenset(agreed)


def consent(store: Store, person: str, yes: bool, how: str) -> None:
    """Record whether a person consented, and how; after a refusal, delete their features."""
    store.append(FaceConsent(yes=yes, how=plain(how)), person=person)
    if not yes:
        _delete(store, person)


def keep_face(store: Store, person: str, kind: str, rows: Any) -> None:
    """Store the features of a person's face, replacing earlier ones.

    Raises:
        NoConsent: the person has not consented.
        FaceError: the file cannot be written.
    """
    import numpy as np

    if person not in consented(store):
        raise NoConsent(plain(f"{person} has not agreed that Tangy knows their face."))
    values = np.ascontiguousarray(rows, "<f2")
    data = values.tobytes()
    head = {
        "format": FORMAT,
        "person": person,
        "kind": kind,
        "rows": values.shape[0],
        "columns": values.shape[1],
        "sum": zlib.crc32(data),
    }
    folder = store.folder / FOLDER
    path = folder / _name(kind, person)
    begun = path.with_name(f".{path.name}")
    try:
        _check_folder(folder)
        folder.mkdir(mode=0o700, exist_ok=True)
        with suppress(FileNotFoundError):
            begun.unlink()
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
        with os.fdopen(os.open(begun, flags, 0o600), "wb") as file:
            file.write(json.dumps(head).encode() + b"\n" + data)
            file.flush()
            os.fsync(file.fileno())
        begun.replace(path)
    except OSError as error:
        with suppress(OSError):
            begun.unlink()
        raise FaceError(plain(f"{path}: cannot be written ({error.strerror}).")) from None


def read_face(store: Store, person: str, kind: str) -> Any:
    """Read the features of a person's face, a row for each image; None if none are stored.

    Raises:
        FaceError: the file is damaged, or cannot be read.
    """
    if person not in consented(store):
        return None
    return _read(store.folder / FOLDER / _name(kind, person), person, kind)


def read_faces(store: Store, kind: str) -> dict[str, Any]:
    """Read the features of one kind of everybody who has consented.

    Raises:
        FaceError: a file is damaged, or cannot be read.
    """
    found = {}
    for person in sorted(consented(store)):
        rows = _read(store.folder / FOLDER / _name(kind, person), person, kind)
        if rows is not None:
            found[person] = rows
    return found


def kept_faces(store: Store) -> list[tuple[str, str]]:
    """Return the people with stored features, and their kinds."""
    return sorted(_ours(store.folder / FOLDER))


def forget_face(store: Store, person: str) -> bool:
    """Delete all stored features of a person's face, and withdraw their consent.

    Returns:
        Whether there were any.

    Raises:
        FaceError: a file cannot be deleted.
    """
    if person in consented(store):
        store.append(FaceForgotten(), person=person)
    return _delete(store, person)


def _delete(store: Store, person: str) -> bool:
    folder = store.folder / FOLDER
    deleted = False
    try:
        _check_folder(folder)
        if not folder.is_dir():
            return False
        for path in list(folder.iterdir()):
            named = _parse(path.name.removeprefix("."))
            if named is not None and named[0] == person:
                path.unlink()
                deleted = True
        with suppress(OSError):
            folder.rmdir()  # it stays if it contains other files
    except OSError as error:
        raise FaceError(plain(f"{folder}: a face cannot be deleted ({error.strerror}).")) from None
    return deleted


def _check_folder(folder: Path) -> None:
    if folder.is_symlink():  # data elsewhere would not be deleted
        raise FaceError(plain(f"{folder}: is a symbolic link; make it a folder."))


def _ours(folder: Path) -> set[tuple[str, str]]:
    with suppress(OSError):
        named = {_parse(path.name) for path in folder.iterdir()}
        return {one for one in named if one is not None}
    return set()


def _name(kind: str, person: str) -> str:
    return f"{kind}-{quote(person, safe='')}{ENDING}"


def _parse(name: str) -> tuple[str, str] | None:
    """Parse a file name as person and kind; None for other files."""
    kind, dash, rest = name.partition("-")
    if not kind.isalnum() or not dash or not rest.endswith(ENDING):
        return None
    return unquote(rest.removesuffix(ENDING)), kind


def _read(path: Path, person: str, kind: str) -> Any:
    import numpy as np

    try:
        _check_folder(path.parent)
        content = path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FaceError(plain(f"{path}: cannot be read ({error.strerror}).")) from None
    line, _, data = content.partition(b"\n")
    try:
        head = json.loads(line)
        rows, columns = head["rows"], head["columns"]
        sound = (
            head["format"] == FORMAT
            and (head["person"], head["kind"]) == (person, kind)
            and isinstance(rows, int)
            and isinstance(columns, int)
            and 0 < rows <= LARGEST_ROWS
            and 0 < columns <= LARGEST_COLUMNS
            and len(data) == 2 * rows * columns
            and head["sum"] == zlib.crc32(data)
        )
        values = np.frombuffer(data, "<f2").reshape(rows, columns) if sound else None
    except (ValueError, KeyError, TypeError, RecursionError):
        values = None
    if values is None or not np.isfinite(values).all():
        raise FaceError(
            plain(f"{path}: is broken; forget this face with `tangy faces forget`, and enrol it.")
        )
    return values.astype(np.float32)
