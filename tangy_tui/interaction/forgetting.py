"""Forgetting a person: erasing their name and details from the whole data folder."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from tangy_profiles.activity import Activity
from tangy_profiles.erasure import NameEraser
from tangy_profiles.person import Person
from tangy_profiles.saved_files import erase_from_files
from tangy_profiles.store import Store
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.words import FILLERS, spoken, words_of


class Forgotten(NamedTuple):
    """The result: changed events and files, and remaining data.

    `events_left` are events in which the name still stands, as that of a teacher; `files_left` are
    files that Tangy does not change and that hold it, or may.
    """

    events: int
    files: tuple[Path, ...]
    events_left: int
    files_left: tuple[Path, ...]


def forget_person(
    store: Store,
    activity: Activity,
    people: Sequence[Person],
    person: Person,
    also: Sequence[str] = (),
) -> Forgotten:
    """Erase a person's name, pronunciation, voice and face, also from free texts.

    The files come first and the name itself last, so that it can be done again if it is cut off.

    Args:
        store: the log, open for writing, and its folder.
        activity: whose phrases stay as they are.
        people: everybody who plays, whose names stay as they are.
        person: who is to be forgotten.
        also: other names that they were called by.

    Raises:
        TangyError: some of it cannot be deleted.
    """
    from tangy_hw.perception.faces.face_store import forget_face

    eraser = name_eraser(store, activity, people, person, also)
    files = erase_from_files(store.folder, eraser)
    forget_face(store, person.id)
    _, events = store.forget(person.id, eraser)
    return Forgotten(events, files.changed, store.count_left(eraser), files.left)


def name_eraser(
    store: Store,
    activity: Activity,
    people: Sequence[Person],
    person: Person,
    also: Sequence[str] = (),
) -> NameEraser:
    """Return what finds the names that a person was given, and nothing else."""
    given = store.names()
    own = [name for name in (given.get(person.id, ""), *also) if name]
    said = [form for name in own for form in (spoken(words_of(name)), " ".join(words_of(name)))]
    others = {other.id: other.name for other in people} | given
    stay = [name for id, name in others.items() if id != person.id]
    table = Phrasebook(activity, people).table
    stay += [phrase.said for phrase in table.all() if phrase.user is None]
    stay += [" ".join(phrase.words) for phrase in table.all() if phrase.user is None]
    stay += [text for b in activity.behaviours.values() for text in (b.name, b.question)]
    named = {word for name in own for word in words_of(name)}
    of_people = {word for phrase in table.all() if phrase.user for word in phrase.words}
    of_others = {word for text in stay for word in words_of(text)}
    commands = (of_people - named) | of_others | FILLERS
    return NameEraser(own, person.id, said=said, but=stay, commands=commands)
