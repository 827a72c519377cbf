"""People who join the group while Tangy runs: each gets an id, a name and a seat."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.person import MOST_PEOPLE, Person, folded, unaccented
from tangy_profiles.room import SEAT
from tangy_tui.app.game_commands import Joins
from tangy_tui.app.interruption import end_interrupted, find_interrupted, take_up
from tangy_tui.app.register import add_person
from tangy_tui.app.rooms import check_places
from tangy_tui.app.staff_notes import StaffNote

if TYPE_CHECKING:
    from tangy_hw.robot_client.live_world import LiveWorld
    from tangy_profiles.game_world import GameWorld
    from tangy_profiles.past_game import PastGame
    from tangy_tui.app.workspace import Workspace

NEW = "new"
"""Stands for the id of a person who has none yet."""


def let_join(workspace: Workspace, name: str, *, guest: bool = False) -> str:
    """Add a person who takes part from now on, as a guest only today; return the id.

    The others keep their seats.

    Raises:
        TangyError: there is no free seat, or the name cannot be given.
    """
    order = [person.id for person in workspace.people]
    if workspace.room is workspace.chosen_room:
        check_places(workspace.room, len(order) + 1)
    there = order
    try:
        with workspace.store.transaction():
            id = add_person(workspace.store, guest=guest, taken=order)
            workspace.register()  # everybody, since no two people may have the same name
            workspace.rename(workspace.find_person(id), name)
        there = [*order, id]
    finally:
        workspace.gather(there)
    return id


def known_refusal(workspace: Workspace, joins: Joins) -> StaffNote | None:
    """Return why a person cannot join in any seat, None if they can: they may take part already."""
    people, name = workspace.people, joins.name.strip()
    if not name:
        return StaffNote("no name")
    if workspace.activity.teams:
        return StaffNote("teams play")
    for person in people:
        if folded(name) in (folded(person.name), folded(person.id)):
            return StaffNote("known already", person.id)
    first = [unaccented(name)]
    if named := tuple(p.id for p in people if unaccented(p.name).split()[:1] == first):
        return StaffNote("which person", words=name, people=named)
    return None


class Admission:
    """Lets new people join a running live game."""

    def __init__(self, workspace: Workspace, world: LiveWorld) -> None:
        """Add people to the participants of a workspace, whose game a world plays."""
        self._workspace = workspace
        self._world = world

    def refusal(self, joins: Joins) -> StaffNote | None:
        """Return why a person cannot join, None if they can.

        Raises:
            TangyError: the name has another meaning.
        """
        from tangy_tui.language.name_conflicts import check_new_name

        workspace, people, room = self._workspace, self._workspace.people, self._workspace.room
        if (refused := known_refusal(workspace, joins)) is not None:
            return refused
        if len(people) >= MOST_PEOPLE:
            return StaffNote("most people", str(MOST_PEOPLE))
        if len(people) >= room.places:
            return StaffNote("no seat", str(room.places), room.title)
        table, places = room.next_places(len(people))
        if (joins.seat and joins.seat - 1 not in places) or joins.table not in (0, table + 1):
            seats = f"{room.seat_word or SEAT} {places.start + 1}"
            seats += f" to {places.stop}" if len(places) > 1 else ""
            return StaffNote("no seat there", str(table + 1) if room.tables else "", seats)
        check_new_name(workspace.activity, people, Person(NEW, joins.name.strip()))
        return None

    def admit(self, joins: Joins) -> StaffNote:
        """Add a person who can join to the participants, and tell their seat.

        Raises:
            TangyError: the name cannot be given, or the log is full.
        """
        workspace = self._workspace
        there = [person.id for person in workspace.people]
        id = let_join(workspace, joins.name.strip(), guest=joins.guest)
        place = joins.seat - 1 if joins.seat else workspace.room.next_place(len(there))
        workspace.gather((*there[:place], id, *there[place:]))
        seat = f"{workspace.room.seat_word or SEAT} {place + 1}"
        return StaffNote("joins", id, seat)

    def seat_of(self, person: str) -> int:
        """Return the seat of a participant, from 1."""
        return list(self._workspace.names).index(person) + 1

    @property
    def seats(self) -> dict[int, tuple[str, ...]]:
        """The seats (from 1) that a new person can take, each with the ids of the neighbours."""
        people = [person.id for person in self._workspace.people]
        _, places = self._workspace.room.next_places(len(people))
        beside = people[places.start : places.stop - 1]
        return {
            place + 1: tuple(beside[max(0, at - 1) : at + 1]) for at, place in enumerate(places)
        }

    def end_game(self, reason: str) -> None:
        """Log the end of the game that is interrupted for a new person, with its reason."""
        past = find_interrupted(self._workspace, self._world.played_in)
        if past is not None:
            end_interrupted(self._workspace, past, reason)


def resume_joined(workspace: Workspace, world: GameWorld) -> PastGame | None:
    """Return the game that a person has just joined, to resume it with them at their seat.

    None if it had no step: then a new game begins with them.
    """
    past = find_interrupted(workspace, world)
    sit = {person: place for place, person in enumerate(workspace.names)}
    return None if past is None else take_up(workspace, past, sit).past


def carry_over(before: LiveWorld, world: LiveWorld) -> None:
    """Tell a world what was known before a person joined.

    A robot knows the cards; the bench deals new ones, but knows which faults are still to come.
    """
    from tangy_tui.app.simulated_devices_world import BenchedWorld

    if isinstance(before, BenchedWorld) and isinstance(world, BenchedWorld):
        world.carry_over(before)
    elif cards := before.known_cards:
        world.cards.dealt.deal(cards)
