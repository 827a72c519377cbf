"""Corrections by staff, as events: late feedback, void responses, strategies off, another method.

Nothing in the log is changed: each correction is an event and can be undone. Which responses count
is derived from all events (see `Store.responses`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TypeVar

from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.people_records import (
    ChangeTakenBack,
    FeedbackGiven,
    MethodChosen,
    ResponseAwaited,
    ResponseGiven,
    ResponseVoided,
    StrategySwitched,
)
from tangy_profiles.persuading import PersuasionConfig
from tangy_profiles.reading import plain
from tangy_profiles.store import Event, Store

CHANGES = (FeedbackGiven, ResponseVoided, StrategySwitched, MethodChosen)
"""The events that can be undone."""
C = TypeVar("C", StrategySwitched, MethodChosen)


@dataclass(frozen=True, slots=True)
class FeedbackEntry:
    """One line of a person's history: a response, or a request without one yet.

    `number` counts from 1 and is stable. `request` is the uuid of the request: late feedback refers
    to an earlier line, every other line to itself. `at` is the time of the request, and `why` the
    reason for which it is void. `settled`: another line has the answer to this request. `followed`:
    the person did it, be it after the activity's patience.
    """

    number: int
    seq: int
    uuid: str
    request: str
    at: datetime
    game: str | None
    strategy: str
    complied: bool | None
    late: bool
    void: bool
    why: str
    settled: bool = False
    followed: bool = False
    world: GameWorld | None = None
    """The world of a line that belongs to no game."""

    @property
    def counts(self) -> bool:
        """Whether the belief uses this response."""
        return self.complied is not None and not self.void

    @property
    def open(self) -> bool:
        """Whether late feedback could still answer the request."""
        return not (self.counts or self.settled)


class Feedback:
    """Staff's corrections in the log. A mistake raises TangyError with one sentence."""

    def __init__(self, store: Store, world: GameWorld = SIMULATED) -> None:
        """Use a log; a read-only log can still be read.

        Args:
            store: the log.
            world: the world of corrections outside any game.
        """
        self.store = store
        self._world = world

    @property
    def names_worlds(self) -> bool:
        """Whether feedback outside any game was given in another world."""
        return any(
            event.record.world not in (None, SIMULATED)
            for event in self.store.events(FeedbackGiven)
        )

    def history(self, person: str) -> list[FeedbackEntry]:
        """Return all of a person's requests with a strategy, in the order of the log."""
        awaited = (e for e in self.store.events(ResponseAwaited) if e.person == person)
        found = sorted([*self.store.answers(person), *awaited], key=lambda event: event.seq)
        voids, back = self._gone()
        times = {event.uuid: event.at for event in found}
        entries = [
            _entry(number, event, times, voids, back) for number, event in enumerate(found, 1)
        ]
        answered = {entry.request: entry.seq for entry in entries if entry.counts}
        return [
            replace(entry, settled=True)
            if answered.get(entry.request, entry.seq) != entry.seq
            else entry
            for entry in entries
        ]

    def give(
        self, person: str, strategy: str, complied: bool, of: int | None = None
    ) -> FeedbackEntry:
        """Log a late response.

        Args:
            person: the id of the person.
            strategy: the strategy of the request.
            complied: whether the person complied.
            of: the seq of the request without a response, or with a void one; None if staff asked
                by themselves, so that the log has no request.

        Raises:
            TangyError: the request has a response, or used another strategy.
        """
        given = FeedbackGiven(world=self._world)
        if of is not None:
            request = self._at(person, of)
            if request.strategy != strategy:
                raise TangyError(
                    plain(f"That request was put with {request.strategy}, not with {strategy}.")
                )
            if not request.open:
                raise TangyError(
                    "That request has its answer already, and none counts twice: "
                    "void the answer first if it is wrong."
                )
            given = FeedbackGiven(of=request.request, game=request.game, world=request.world)
        seq = self.store.append(given, person=person, strategy=strategy, complied=complied)
        return self._at(person, seq)

    def void(self, person: str, seq: int, why: str = "") -> FeedbackEntry:
        """Void a response, so that it no longer counts.

        Raises:
            TangyError: it does not count now.
        """
        entry = self._at(person, seq)
        if entry.complied is None:
            raise TangyError("That request has no response yet that could be void.")
        if entry.void:
            raise TangyError("That response is void already.")
        void = ResponseVoided(of=entry.uuid, why=why)
        self.store.append(void, person=person, strategy=entry.strategy)
        return self._at(person, seq)

    def last_change(self, person: str | None = None) -> Event[EventRecord] | None:
        """Return the last correction (of one person) in force, which `undo` would undo."""
        back = self._back()
        found = None
        for event in self.store.events(*CHANGES):
            if event.uuid not in back and person in (None, event.person):
                found = event
        return found

    def undo(self, person: str | None = None) -> Event[EventRecord]:
        """Undo the last correction in force, of one person or of anybody, and return it.

        Raises:
            TangyError: there is none.
        """
        change = self.last_change(person)
        if change is None:
            raise TangyError("There is nothing to take back.")
        back = ChangeTakenBack(of=change.uuid, what=change.kind)
        self.store.append(back, person=change.person, strategy=change.strategy)
        return change

    def off(self, person: str) -> frozenset[str]:
        """Return the strategies that are switched off for a person."""
        off: set[str] = set()
        for event in self._holding(StrategySwitched, person):
            if event.strategy is not None:
                (off.discard if event.record.on else off.add)(event.strategy)
        return frozenset(off)

    def switch(self, person: str, strategy: str, on: bool, among: Iterable[str]) -> None:
        """Switch a strategy off for a person, or on again.

        Args:
            person: the id of the person.
            strategy: the strategy.
            on: whether it may be used.
            among: the strategies of the activity.

        Raises:
            TangyError: nothing would change, or no strategy would be left.
        """
        off = self.off(person)
        if (strategy not in off) == on:
            state = "on" if on else "off"
            raise TangyError(plain(f"{strategy} is switched {state} already."))
        if not on and not set(among) - off - {strategy}:
            raise TangyError(plain(f"{strategy} is the last one left: one must stay on."))
        self.store.append(StrategySwitched(on=on), person=person, strategy=strategy)

    def method(self, person: str) -> PersuasionConfig | None:
        """Return the method chosen for a person; None if the activity's method is used."""
        chosen = None
        for event in self._holding(MethodChosen, person):
            chosen = event.record.chosen
        return chosen

    def choose_method(self, person: str, chosen: PersuasionConfig | None) -> None:
        """Choose a method for a person; None for the activity's method.

        Raises:
            TangyError: it is chosen already.
        """
        if chosen == self.method(person):
            raise TangyError("That is the method already.")
        self.store.append(MethodChosen(chosen=chosen), person=person)

    def _at(self, person: str, seq: int) -> FeedbackEntry:
        for entry in self.history(person):
            if entry.seq == seq:
                return entry
        raise TangyError(plain(f"Event {seq} is not a request to {person}, nor a response."))

    def _holding(self, kind: type[C], person: str) -> Iterator[Event[C]]:
        """Yield a person's corrections of one kind that were not undone."""
        events = [event for event in self.store.events(kind) if event.person == person]
        back = self._back() if events else frozenset()
        return (event for event in events if event.uuid not in back)

    def _back(self) -> frozenset[str]:
        return frozenset(event.record.of for event in self.store.events(ChangeTakenBack))

    def _gone(self) -> tuple[dict[str, str], frozenset[str]]:
        """Return void responses with their reasons, and undone responses, by uuid."""
        back = self._back()
        voids = {
            event.record.of: event.record.why
            for event in self.store.events(ResponseVoided)
            if event.uuid not in back
        }
        return voids, back


def _entry(
    number: int,
    event: Event[EventRecord],
    times: dict[str, str],
    voids: dict[str, str],
    back: frozenset[str],
) -> FeedbackEntry:
    request, game, world = event.uuid, None, None
    followed = event.complied is True
    match event.record:
        case FeedbackGiven() as given:
            request, game = given.of or event.uuid, given.game
            world = given.world if game is None else None
        case ResponseGiven() as one:
            game, followed = one.game, followed or one.followed is True
        case ResponseAwaited() as one:
            game = one.game
    return FeedbackEntry(
        number=number,
        seq=event.seq,
        uuid=event.uuid,
        request=request,
        at=datetime.fromisoformat(times.get(request, event.at)),
        game=game,
        strategy=event.strategy or "",
        complied=event.complied,
        late=isinstance(event.record, FeedbackGiven),
        void=event.uuid in voids or event.uuid in back,
        why=voids.get(event.uuid, "taken back" if event.uuid in back else ""),
        followed=followed,
        world=world,
    )


def void_last(store: Store, game: str, person: str, by: str) -> bool:
    """Void a person's last response in a game; return whether there was one.

    Args:
        store: the log.
        game: the id of the game.
        person: the id of the person.
        by: who says so.
    """
    feedback = Feedback(store)
    entries = [e for e in feedback.history(person) if e.game == game and e.counts]
    if not entries:
        return False
    feedback.void(person, entries[-1].seq, f"said by {by} in the game")
    return True
