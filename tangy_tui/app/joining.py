"""People who join the group while Tangy runs: each gets an id, a name and a seat."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.app.register import add_person
from tangy_tui.app.rooms import check_places

if TYPE_CHECKING:
    from tangy_tui.app.workspace import Workspace


def let_join(workspace: Workspace, name: str, *, guest: bool = False) -> str:
    """Add a person who takes part from now on, as a guest only today; return the id.

    The others keep their seats.

    Raises:
        TangyError: there is no free seat, or the name cannot be given.
    """
    order = [person.id for person in workspace.people]
    if workspace.room is workspace.chosen_room:
        check_places(workspace.room, len(order) + 1)
    try:
        with workspace.store.transaction():
            id = add_person(workspace.store, guest=guest)
            workspace.register()
            workspace.rename(workspace.find_person(id), name)
    finally:
        workspace.register()  # without the person, if the name was refused
        new = [person.id for person in workspace.people if person.id not in order]
        workspace.seat([*order, *new])
    return id
