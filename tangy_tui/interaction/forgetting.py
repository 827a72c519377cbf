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
    """The result of forgetting a person.

    `events` is the number of changed events, `files` the changed files. `events_left` is the number
    of events that still have the name, as a teacher's; `files_left` are files that hold or may hold
    it and that Tangy does not change.
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

    The files come first and the name itself last, so that an interrupted erasure can be repeated.

    Args:
        store: the log, open for writing, and its folder.
        activity: its phrases are kept.
        people: all players; the names of the others are kept.
        person: the person to forget.
        also: other names that were used for them.

    Raises:
        TangyError: some data cannot be deleted.
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
    """Return an eraser that finds a person's names, and no other words."""
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
