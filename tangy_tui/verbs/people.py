"""`tangy people`: who takes part, and what works with them."""

from __future__ import annotations

from typing import Annotated

import typer

from tangy_profiles.reading import plain
from tangy_tui.verbs.common import Data, Json, Seed, Users, open_house, print_json

app = typer.Typer(rich_markup_mode=None, help="Who takes part, and what works with them.")


@app.command("list")
def people_list(
    seed: Seed = None, data: Data = None, users: Users = 4, as_json: Json = False
) -> None:
    """List the people, with how often each strategy has worked."""
    from tangy_tui.documents import person_document
    from tangy_tui.ui import reports

    with open_house(data, "bingo", users, write=False) as house:
        if as_json:
            print_json([person_document(house, person) for person in house.people])
        else:
            reports.print_people(house)


@app.command("show")
def people_show(
    person: Annotated[str, typer.Argument(help="An id or a name.")],
    seed: Seed = None,
    data: Data = None,
    users: Users = 4,
    as_json: Json = False,
) -> None:
    """Show one person: every strategy with counts, mean and P(best)."""
    from tangy_tui.documents import person_document
    from tangy_tui.ui import reports

    with open_house(data, "bingo", users, write=False) as house:
        found = house.find_person(person)
        if as_json:
            print_json(person_document(house, found))
        else:
            reports.print_person(house, found)


@app.command("rename")
def people_rename(
    person: Annotated[str, typer.Argument(help="An id or a name.")],
    name: Annotated[str, typer.Argument(help="The new name.")],
    seed: Seed = None,
    data: Data = None,
    users: Users = 4,
    as_json: Json = False,
) -> None:
    """Give a person another name; what Tangy has learnt of them stays."""
    with open_house(data, "bingo", users) as house:
        found = house.find_person(person)
        house.rename(found, name)
        if as_json:
            print_json({"id": found.id, "name": name})
        else:
            print(f"{found.id} is now called {plain(name)}.")
