"""The register: who takes part, as the log tells: the first people, additions, archivings."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from datetime import datetime

from tangy_profiles.defaults import REGISTERED, TO_BEGIN_WITH
from tangy_profiles.errors import TangyError
from tangy_profiles.people_records import PersonAdded, PersonArchived
from tangy_profiles.person import GUEST, MOST_PEOPLE, Person, load_people
from tangy_profiles.store import Store


def registered(store: Store) -> tuple[Person, ...]:
    """Return who takes part, without archived people and guests."""
    archived = archived_people(store)
    added = [e.person for e in store.events(PersonAdded) if e.person and not e.record.guest]
    known = {person.id: person for person in load_people(MOST_PEOPLE)}
    ids = dict.fromkeys([*list(known)[:TO_BEGIN_WITH], *added])
    return tuple(known.get(id, Person(id, id)) for id in ids if id not in archived)


def archived_people(store: Store) -> list[str]:
    """Return the ids of archived people, who no longer take part."""
    archived: dict[str, bool] = {}
    for event in store.events(PersonArchived):
        archived[str(event.person)] = event.record.on
    return [person for person, on in archived.items() if on]


def guest_ids(store: Store) -> list[str]:
    """Return the ids of all guests of any day."""
    return [guest.id for guest, _ in _guests(store)]


def guests_today(store: Store) -> tuple[Person, ...]:
    """Return today's guests who have not left, in order of arrival."""
    archived = archived_people(store)
    return tuple(guest for guest, today in _guests(store) if today and guest.id not in archived)


def past_guests(store: Store) -> tuple[Person, ...]:
    """Return guests of earlier sessions whose names are still stored."""
    named = store.names()
    return tuple(guest for guest, today in _guests(store) if not today and guest.id in named)


def _guests(store: Store) -> Iterator[tuple[Person, bool]]:
    """Yield each guest, and whether they came today in local time."""
    today, names = store.now().astimezone().date(), store.names()
    for event in store.events(PersonAdded):
        if event.person and event.record.guest:
            came = datetime.fromisoformat(event.at).astimezone().date()
            yield Person(event.person, names.get(event.person, event.person)), came == today


def participants(store: Store, count: int) -> tuple[Person, ...]:
    """Return the first `count` participants; if there are fewer, add numbered users.

    Raises:
        ProfileError: the number of people is out of range.
    """
    people = registered(store)
    if count == REGISTERED:
        return (*people, *guests_today(store))[:MOST_PEOPLE]
    archived = archived_people(store)
    numbered = load_people(count)  # refuses a number out of range
    more = [p for p in load_people(MOST_PEOPLE) if p.id not in archived and p not in people]
    return (*people, *more)[: len(numbered)]


def known_people(store: Store, people: Sequence[Person]) -> list[Person]:
    """Return people with their stored details: names, pronunciations, voices."""
    names, said, voices = store.names(), store.pronunciations(), store.voices()
    return [
        replace(
            person,
            name=names.get(person.id, person.name),
            pronunciation=said.get(person.id, person.pronunciation),
            voice=voices.get(person.id, person.voice),
        )
        for person in people
    ]


def add_person(store: Store, *, guest: bool = False, taken: Collection[str] = ()) -> str:
    """Register a person, and return the id, which is none of those `taken`.

    Raises:
        TangyError: the most people take part already.
    """
    if len(participants(store, REGISTERED)) >= MOST_PEOPLE:
        raise TangyError(f"{MOST_PEOPLE} people take part already: archive somebody first.")
    taken = {*taken, *(str(event.person) for event in store.events(PersonAdded))}
    if guest:
        id = next(f"{GUEST}{n}" for n in range(1, len(taken) + 2) if f"{GUEST}{n}" not in taken)
    else:
        taken |= {person.id for person in load_people(TO_BEGIN_WITH)}
        free = [person.id for person in load_people(MOST_PEOPLE) if person.id not in taken]
        id = free[0] if free else f"user{len(taken) + 1}"
    store.append(PersonAdded(guest=guest), person=id)
    return id


def archive_person(store: Store, person: str, *, on: bool = True) -> None:
    """Archive a person, who then no longer takes part, or restore them.

    Raises:
        TangyError: nobody would be left.
    """
    if on and _alone(registered(store), person):
        raise TangyError("At least one person must take part: add another person first.")
    store.append(PersonArchived(on=on), person=person)


def _alone(people: Sequence[Person], person: str) -> bool:
    return [one.id for one in people] == [person]
