"""One person's record: posteriors, their certainty, and the history by game."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

from tangy_profiles.beliefs import Beliefs, leading, probability_best, settled
from tangy_profiles.game_records import GameBeginning
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.memory import PersonModel, PersonModels


@dataclass(frozen=True, slots=True)
class PersonGame:
    """One person's requests in one game; without an id: outside any game."""

    id: str | None
    begun: datetime
    entries: tuple[FeedbackEntry, ...]


@dataclass(frozen=True, slots=True)
class PersonSummary:
    """Everything that is displayed about one person.

    `best` is, for each strategy, the probability that it is the best of those switched on (0 if it
    is off). `settled` is the strategy that is almost certainly the best; None if only one is on.
    `seen` is when the person last took part, and `now` when this was read.
    """

    person: Person
    known: PersonModel
    best: Mapping[str, float]
    settled: str | None
    history: tuple[FeedbackEntry, ...]
    games: tuple[PersonGame, ...]
    seen: datetime | None
    now: datetime
    world: GameWorld = SIMULATED
    """The world whose games count."""

    @property
    def beliefs(self) -> Beliefs:
        """The person's current posteriors."""
        return self.known.beliefs

    @property
    def on(self) -> tuple[str, ...]:
        """Return the strategies that are switched on for the person."""
        return tuple(on_of(self.beliefs, self.known.off))

    @property
    def leading(self) -> str | None:
        """Return the strategy that is most probably the best, or None if none stands out."""
        return leading(self.best) if len(self.on) > 1 else None


def read_records(
    store: Store, memory: PersonModels, people: Iterable[Person]
) -> list[PersonSummary]:
    """Read the records of some people."""
    responses = memory.responses()
    begun: dict[str, datetime] = {}
    present: dict[str, datetime] = {}
    for event in store.events(GameBeginning):
        game = event.record
        if not memory.is_of_this_world(game.game):
            continue
        at = datetime.fromisoformat(event.at)
        begun[game.game] = at
        present.update(dict.fromkeys(game.people, at))
    return [
        _record(person, memory, memory.recall(person.id, responses), begun, present)
        for person in people
    ]


def _record(
    person: Person,
    memory: PersonModels,
    known: PersonModel,
    begun: Mapping[str, datetime],
    present: Mapping[str, datetime],
) -> PersonSummary:
    history = tuple(memory.history(person.id))
    best = best_of_those_on(known.beliefs, known.off)
    times = [entry.at for entry in history]
    if person.id in present:
        times.append(present[person.id])
    return PersonSummary(
        person=person,
        known=known,
        best=best,
        settled=settled_of(on_of(known.beliefs, known.off), best),
        history=history,
        games=_games(history, begun),
        seen=max(times, default=None),
        now=memory.now(),
        world=memory.world,
    )


def best_of_those_on(beliefs: Beliefs, off: frozenset[str] = frozenset()) -> dict[str, float]:
    """Return P(best) of each strategy among those switched on; 0 for the others."""
    best = probability_best(on_of(beliefs, off))
    return {strategy: best.get(strategy, 0.0) for strategy in beliefs}


def on_of(beliefs: Beliefs, off: frozenset[str]) -> Beliefs:
    """Return the beliefs of the strategies that are on; of all, if none is."""
    return {strategy: b for strategy, b in beliefs.items() if strategy not in off} or beliefs


def settled_of(on: Beliefs, best: Mapping[str, float]) -> str | None:
    """Return the strategy that has worked and whose probability of being best is high, or None."""
    found = settled(best)
    return found if found is not None and len(on) > 1 and on[found].complied else None


def _games(
    history: Sequence[FeedbackEntry], begun: Mapping[str, datetime]
) -> tuple[PersonGame, ...]:
    """Group a history by game, in the order in which the games began."""
    found: dict[str | None, list[FeedbackEntry]] = {}
    for entry in history:
        found.setdefault(entry.game, []).append(entry)
    games = (
        PersonGame(id, begun.get(id or "", entries[0].at), tuple(entries))
        for id, entries in found.items()
    )
    return tuple(sorted(games, key=lambda game: game.begun))
