"""`tangy people forget`: forget who somebody is, and their face."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from tangy_profiles.person import MOST_PEOPLE
from tangy_profiles.reading import plain
from tangy_tui.verbs.common import Data, Json, Seed, print_json
from tangy_tui.verbs.faces import find_anybody
from tangy_tui.verbs.opening import open_house
from tangy_tui.verbs.people import Who

if TYPE_CHECKING:
    from tangy_profiles.person import Person
    from tangy_profiles.store import Store


def people_forget(person: Who, seed: Seed = None, data: Data = None, as_json: Json = False) -> None:
    """Forget a person's name, how it is said, voice and face. It cannot be taken back.

    What worked with them is still counted, under an id that says nobody's name.
    """
    with open_house(data, "bingo", MOST_PEOPLE) as house:
        known = find_anybody(house, person)
        written = _written(house.store, known)
        house.forget(known)
        if as_json:
            forgotten = ["name", "pronunciation", "voice", "face"]
            print_json({"id": known.id, "forgotten": forgotten, "name_left_in_events": written})
            return
        print(plain(f"{known.id}: name, how it is said, voice and face are forgotten."))
        if written:
            steps = "1 entry" if written == 1 else f"{written} entries"
            print(f"What was typed or said with the name stays in {steps} of the log.")


def _written(store: Store, person: Person) -> int:
    """Count the entries of the log in which somebody wrote or said a person's own name."""
    if person.id not in store.names():
        return 0
    name = person.name.casefold()
    return sum(name in json.dumps(e.body, ensure_ascii=False).casefold() for e in store.events())
