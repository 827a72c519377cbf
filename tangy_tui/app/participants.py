"""Who takes part, in which room, on which seats, and what Tangy knows of each person."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity
from tangy_profiles.defaults import REGISTERED
from tangy_profiles.errors import TangyError
from tangy_profiles.person import MOST_PEOPLE, Person, folded, load_people, unaccented
from tangy_profiles.reading import did_you_mean, plain
from tangy_profiles.room import Room, room_for
from tangy_profiles.state import FRONT
from tangy_profiles.store import Store
from tangy_tui.app.register import known_people, participants
from tangy_tui.app.rooms import check_places, source_in

if TYPE_CHECKING:
    from tangy_profiles.voice import VoicePreference
    from tangy_tui.interaction.forgetting import Forgotten

_TITLED = re.compile(r"(?:mrs|mr|ms|miss|dr)\.? +(.+)", re.I)
"""A title before a name."""


class Participants:
    """The people of a workspace, placed in a room."""

    activity: Activity
    store: Store
    room: Room
    people: tuple[Person, ...]
    chosen_room: Room | None
    """The room that staff chose. It is used as long as everybody fits in."""
    _sample: tuple[Person, ...]

    def read_people(self) -> None:
        """Reload the people: names, pronunciations, voices, seats; a team has a number instead."""
        known = known_people(self.store, self._sample)
        if self.activity.teams:
            self.people = tuple(replace(t, seats=(f"team {n}",)) for n, t in enumerate(known, 1))
        else:
            self.people = self.room.placed(known)

    def register(self, users: int = REGISTERED) -> None:
        """Let the first `users` registered people take part, or all of them."""
        teams = tuple(Person(team, team) for team in self.activity.teams)
        self._sample = teams or participants(self.store, users)
        self._place()

    def _place(self) -> None:
        """Use the chosen room if everybody fits in, and its seats."""
        count, chosen = len(self._sample), self.chosen_room
        self.room = chosen if chosen and count <= chosen.places else room_for(count)
        self.read_people()

    @property
    def room_source(self) -> str:
        """The source to load the room from, "" if the number of people determines the room."""
        if self.room is not self.chosen_room:
            return ""
        return source_in(self.store.folder, self.room)

    def choose_room(self, room: Room | None) -> None:
        """Set the room to play in; None: the number of people determines it.

        Raises:
            TangyError: not everybody fits in.
        """
        if room is not None:
            check_places(room, len(self._sample))
        self.chosen_room = room
        self._place()

    def seat(self, order: Sequence[str]) -> None:
        """Seat people in the order of these ids."""
        self._sample = tuple(sorted(self._sample, key=lambda person: order.index(person.id)))
        self.read_people()

    def gather(self, ids: Sequence[str]) -> None:
        """Make exactly these people the participants, in this order."""
        there = {person.id: person for person in (*load_people(MOST_PEOPLE), *self._sample)}
        self._sample = tuple(there.get(id, Person(id, id)) for id in ids)
        self._place()

    def name(self, person: str) -> str:
        """Return a person's name."""
        return next((p.name for p in self.people if p.id == person), person)

    def find_person(self, wanted: str) -> Person:
        """Return the person with an id, a name, or a first name that one person has.

        After a title, a last name that one person has counts, too: "Mrs Berg".

        Raises:
            TangyError: nobody, or more than one, is called that.
        """
        by_id = [p for p in self.people if p.id == wanted]
        found = by_id or [p for p in self.people if folded(p.name) == folded(wanted)]
        found = found or [p for p in self.people if unaccented(p.name) == unaccented(wanted)]
        found = found or [
            p for p in self.people if unaccented(p.name).split()[:1] == [unaccented(wanted)]
        ]
        if not found and (titled := _TITLED.fullmatch(wanted)):
            last = unaccented(titled[1])
            found = [p for p in self.people if unaccented(p.name) == last]
            found = found or [p for p in self.people if unaccented(p.name).split()[-1:] == [last]]
        if len(found) == 1:
            return found[0]
        if found:
            raise TangyError(plain(f"More than one person is called {wanted!r}: use the id."))
        typed, names = wanted.title(), {p.name for p in self.people}
        meant = did_you_mean(typed, names | {name.split()[0] for name in names})
        near = f": {meant}" if meant else "."  # never guess a person
        raise TangyError(plain(f"There is nobody called {wanted!r}{near}"))

    def rename(self, person: Person, name: str) -> None:
        """Give a person a new name that nobody else has.

        Cached speech with the old name is deleted.

        Raises:
            TangyError: the name is another person's name or id, or a place, or has another meaning
                in speech.
        """
        wanted = folded(name)
        taken = {FRONT: "is a place"}
        for other in self.people:
            if other.id != person.id:
                taken |= dict.fromkeys(
                    (folded(other.id), folded(other.name)), f"is what {other.id} is called"
                )
        if wanted in taken:
            raise TangyError(plain(f"{name!r} {taken[wanted]}: choose another name."))
        from tangy_tui.language.name_conflicts import check_new_name

        check_new_name(self.activity, self.people, replace(person, name=name.strip()))
        old = self.name(person.id)
        self.store.rename(person.id, name)
        self.read_people()
        if self.name(person.id) != old:
            from tangy_hw.audio.synthesis import clear_cache

            clear_cache()

    def pronounce(self, person: Person, phones: str | None) -> None:
        """Store the pronunciation of a name (ARPAbet, a comma between words); None deletes it.

        Raises:
            TangyError: a phone is unknown, the number of words differs from the name's, or it
                sounds like another person's name or like a phrase.
        """
        self.store.pronounce(person.id, phones and self.check_said(person, phones))
        self.read_people()

    def check_said(self, person: Person, phones: str) -> str:
        """Return the checked phones of a person's name, as they are stored.

        Raises:
            TangyError: as for `pronounce`.
        """
        from tangy_tui.language.name_conflicts import check_said
        from tangy_tui.language.pronunciation import check_name

        checked = check_name(phones, person.name)
        check_said(self.activity, self.people, person, checked)
        return checked

    def prefer_voice(self, person: Person, preference: VoicePreference) -> None:
        """Store how a person prefers to be spoken to."""
        self.store.prefer_voice(person.id, preference)
        self.read_people()

    def forget(self, person: Person, also: Sequence[str] = ()) -> Forgotten:
        """Forget a person: name, pronunciation, voice, face, and consent.

        The name is also deleted from typed and recognised words in the log and in the files of the
        data folder. The person's actions stay in the log, under an id that names nobody.

        Args:
            person: the person to forget.
            also: other names of the person to delete too.

        Raises:
            TangyError: some of it cannot be deleted.
        """
        from tangy_tui.interaction.forgetting import forget_person

        forgotten = forget_person(self.store, self.activity, self.people, person, also)
        self.read_people()
        from tangy_hw.audio.synthesis import clear_cache

        clear_cache()
        return forgotten

    @property
    def names(self) -> dict[str, str]:
        """The participants' names, by id."""
        return {person.id: person.name for person in self.people}
