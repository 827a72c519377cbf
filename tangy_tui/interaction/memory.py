"""A person's model, read from the log: method, prior, posteriors, disabled strategies."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime

from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.game_world import GAME_WORLDS, SIMULATED, GameWorld
from tangy_profiles.persuading import PAPER, PersuasionConfig
from tangy_profiles.store import Store
from tangy_tui.interaction.drift import FEWEST, DriftWatch, most_seen
from tangy_tui.interaction.feedback import Feedback, FeedbackEntry
from tangy_tui.interaction.game_worlds import GameWorlds
from tangy_tui.interaction.methods import Method, Thompson, method_of, others

DAY = 86_400.0  # s

Responses = Mapping[tuple[str, str], tuple[int, int]]
"""(person, strategy) -> how often they complied, and did not."""


@dataclass(frozen=True, slots=True)
class PersonModel:
    """The model of one person, which the choice of their next strategy uses.

    `chosen` is the configuration of the method, and `own` says that it was chosen for this person
    alone.
    """

    method: Method
    prior: Beliefs
    beliefs: Beliefs
    off: frozenset[str] = frozenset()
    chosen: PersuasionConfig = PAPER
    own: bool = False
    watch: DriftWatch = field(default_factory=DriftWatch)
    """Detects changes in what works with them."""


class PersonModels:
    """Reads people's models from the log, for an activity's strategies and configured method."""

    def __init__(
        self,
        store: Store,
        strategies: Sequence[str],
        chosen: PersuasionConfig = PAPER,
        *,
        world: GameWorld | None = None,
    ) -> None:
        """Read from a log.

        Args:
            store: the log.
            strategies: the strategies of the activity.
            chosen: the method for everybody without one of their own.
            world: the world whose games count (default: the world of the last game).
        """
        self._worlds = GameWorlds(store)
        self.world = world or self._worlds.last
        self.feedback = Feedback(store, self.world)
        self._store = store
        self._strategies = tuple(strategies)
        self._chosen = chosen

    def now(self) -> datetime:
        """Return the time by the log's clock."""
        return self._store.now()

    def responses(self) -> Responses:
        """Count the responses of this world's games (see `Store.responses`)."""
        worlds = self._worlds.all
        if self.world == SIMULATED:  # events without game and world belong to it
            others = {game for game, world in worlds.items() if world != SIMULATED}
            if not others and not self.feedback.names_worlds:
                return self._store.responses()  # uses only the index
            return self._store.responses(but=others | (set(GAME_WORLDS) - {SIMULATED}))
        mine = {game for game, world in worlds.items() if world == self.world}
        return self._store.responses(mine | {self.world})

    def history(self, person: str) -> list[FeedbackEntry]:
        """Return a person's requests in this world's games, in the order of the log."""
        return [
            entry
            for entry in self.feedback.history(person)
            if self._worlds.of(entry.game, entry.world) == self.world
        ]

    def is_of_this_world(self, game: str) -> bool:
        """Return whether a game was played in this world."""
        return self._worlds.of(game) == self.world

    def recall(self, person: str, responses: Responses | None = None) -> PersonModel:
        """Return the current model of a person.

        Args:
            person: the id of the person.
            responses: the result of `responses`, if the caller has it.
        """
        responses = self.responses() if responses is None else responses
        own = self.feedback.method(person)
        chosen = own or self._chosen
        method = method_of(chosen, others(responses, person) if chosen.prior == "people" else ())
        prior = method.prior(self._strategies)
        watch = DriftWatch()
        if most_seen(responses, person) >= FEWEST:  # with fewer no change is detectable
            watch = DriftWatch(in_order(self.history(person), self._strategies))
        if method.forgets:
            beliefs = replayed(method, prior, self.history(person), self.now())
        else:
            beliefs = watch.forgotten(counted(prior, person, responses), prior)
        off = self.feedback.off(person)
        return PersonModel(method, prior, beliefs, off, chosen, own is not None, watch)


def in_order(
    history: Sequence[FeedbackEntry], strategies: Collection[str]
) -> Iterator[tuple[str, bool]]:
    """Yield the responses that count, in the order of the requests."""
    for entry in sorted(history, key=lambda entry: (entry.at, entry.seq)):
        if entry.counts and entry.complied is not None and entry.strategy in strategies:
            yield entry.strategy, entry.complied


def unknown(strategies: Sequence[str], method: Method | None = None) -> PersonModel:
    """Return the model of a person without a log."""
    method = method or Thompson()
    prior = method.prior(strategies)
    return PersonModel(method, prior, prior)


def counted(prior: Beliefs, person: str, responses: Responses) -> Beliefs:
    """Add a person's counts to the prior; Eq. 2 does not depend on the order."""
    beliefs = dict(prior)
    for strategy, start in prior.items():
        yes, no = responses.get((person, strategy), (0, 0))
        counts = None if start.counts is None else (yes, no)
        beliefs[strategy] = Beta(start.alpha + yes, start.beta + no, counts)
    return beliefs


def replayed(
    method: Method, prior: Beliefs, history: Sequence[FeedbackEntry], now: datetime
) -> Beliefs:
    """Update the beliefs of a forgetting method by each response, in the order of the requests."""
    beliefs, at = prior, None
    for entry in sorted(history, key=lambda entry: (entry.at, entry.seq)):
        if entry.counts and entry.complied is not None and entry.strategy in prior:
            beliefs = method.faded(beliefs, prior, days(at, entry.at))
            beliefs = method.updated(beliefs, prior, entry.strategy, entry.complied)
            at = entry.at
    return method.faded(beliefs, prior, days(at, now))


def days(since: datetime | None, until: datetime) -> float:
    """Return the days between two times; 0 if there is no first time or the clock went back."""
    return 0.0 if since is None else max(0.0, (until - since).total_seconds() / DAY)
