"""`tangy people forget`: delete a person's name, face and voice."""

from __future__ import annotations

import sys
from shutil import get_terminal_size
from textwrap import fill
from typing import TYPE_CHECKING, Annotated

import typer

from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE
from tangy_profiles.reading import plain
from tangy_tui.text.forgetting import forgotten_lines, not_forgotten, what_goes
from tangy_tui.verbs.common import Data, Json, Seed, print_json
from tangy_tui.verbs.faces import find_anybody
from tangy_tui.verbs.opening import open_workspace
from tangy_tui.verbs.people import Who

if TYPE_CHECKING:
    from tangy_profiles.person import Person
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.interaction.forgetting import Forgotten

Yes = Annotated[bool, typer.Option("--yes", help="Do not ask first, for scripts.")]
Also = Annotated[
    list[str] | None,
    typer.Option("--also", metavar="NAME", help="Another name of theirs, such as an earlier one."),
]


def people_forget(
    person: Who,
    also: Also = None,
    yes: Yes = False,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Forget a person: name, voice and face.

    You cannot undo this.

    The name also goes from what was typed or said, in the log and in Tangy's own reports and logs
    in the data folder; other files there that hold it are named and stay as they are. What worked
    with them is still counted, under an id that says nobody's name. Copies in other folders are
    yours to delete.
    """
    with open_workspace(data, DEFAULT_ACTIVITY, MOST_PEOPLE) as workspace:
        known = find_anybody(workspace, person)
        if not yes and not _agreed(workspace, known):
            print(plain(not_forgotten(known)))
            raise typer.Exit(1)
        forgotten = workspace.forget(known, also or ())
        if as_json:
            print_json(_document(known, forgotten))
            return
        for line in forgotten_lines(known, forgotten):
            print(plain(line))


def _agreed(workspace: Workspace, person: Person) -> bool:
    """Ask whether to forget a person.

    Raises:
        TangyError: there is no terminal to ask on.
    """
    if not (sys.stdin.isatty() and sys.stderr.isatty()):
        raise TangyError(
            plain(
                f"To forget {person.name} cannot be taken back: say yes to it on a terminal, or "
                "add --yes."
            )
        )
    goes = plain(what_goes(person, workspace.store.folder))
    width = min(100, get_terminal_size().columns - 1)
    print(fill(goes, width, break_on_hyphens=False), file=sys.stderr)
    return typer.confirm(plain(f"Forget {person.name}?"), default=False, err=True)


def _document(person: Person, forgotten: Forgotten) -> dict[str, object]:
    return {
        "id": person.id,
        "forgotten": ["name", "pronunciation", "voice", "face"],
        "name_left_in_events": forgotten.events_left,
        "events_changed": forgotten.events,
        "files_changed": [str(path) for path in forgotten.files],
        "files_left": [str(path) for path in forgotten.files_left],
    }
