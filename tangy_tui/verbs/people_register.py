"""`tangy people add`, `archive` and `bring-back`: who takes part."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE, folded, load_people
from tangy_profiles.reading import plain
from tangy_tui.text.register import (
    added_words,
    archived_words,
    back_words,
    guest_added_words,
    not_archived,
    one_name,
)
from tangy_tui.verbs.common import REGISTERED, Data, Json, print_json
from tangy_tui.verbs.opening import open_workspace

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace

Name = Annotated[list[str], typer.Argument(metavar="NAME", help="The name of the person.")]
Guest = Annotated[
    bool, typer.Option("--guest", help="Only for today: Tangy forgets the name tomorrow.")
]
Who = Annotated[str, typer.Argument(metavar="PERSON", help="An id or a name.")]


def people_add(name: Name, guest: Guest = False, data: Data = None, as_json: Json = False) -> None:
    """Add a person from the next game on.

    Up to 24 people can take part.
    """
    from tangy_tui.app.joining import let_join

    if len(name) > 1:
        raise TangyError(plain(one_name(name)))
    with open_workspace(data, DEFAULT_ACTIVITY, REGISTERED) as workspace:
        id = let_join(workspace, name[0], guest=guest)
        words = guest_added_words if guest else added_words
        _told(workspace, id, words(workspace.name(id), id), as_json)


def people_archive(person: Who, data: Data = None, as_json: Json = False) -> None:
    """Archive a person; `bring-back` undoes it.

    Tangy keeps what it knows about them.
    """
    from tangy_tui.app.register import archive_person

    with open_workspace(data, DEFAULT_ACTIVITY, REGISTERED) as workspace:
        found = workspace.find_person(person)
        archive_person(workspace.store, found.id)
        _told(workspace, found.id, archived_words(found.name), as_json)


def people_bring_back(person: Who, data: Data = None, as_json: Json = False) -> None:
    """Bring back an archived person."""
    from tangy_tui.app.register import archive_person, archived_people

    with open_workspace(data, DEFAULT_ACTIVITY, REGISTERED) as workspace:
        names = {p.id: p.name for p in load_people(MOST_PEOPLE)} | workspace.store.names()
        archived = archived_people(workspace.store)
        wanted = folded(person)
        found = [id for id in archived if wanted in (folded(id), folded(names.get(id, id)))]
        if not found:
            known = ", ".join(names.get(id, id) for id in archived)
            raise TangyError(plain(not_archived(person, known)))
        archive_person(workspace.store, found[0], on=False)
        workspace.register()
        _told(workspace, found[0], back_words(workspace.name(found[0])), as_json)


def _told(workspace: Workspace, person: str, words: str, as_json: bool) -> None:
    if as_json:
        print_json({"id": person, "name": workspace.store.names().get(person, person)})
    else:
        print(plain(words))
