"""The interpreter of declared activities: the facts of a game, and how they change.

Facts change only by `observe` (simulated people, cameras, buttons, speech and staff) and `execute`
(the robot's behaviours).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tangy_profiles.declared.judging import judged
from tangy_profiles.declared.model import Declaration, Effect, Fact, FactCondition, Stage
from tangy_profiles.declared.vocabulary import (
    ASKING,
    HERE,
    ITEMS,
    NO,
    PLACE,
    TURN,
    YES,
    Selector,
)
from tangy_profiles.state import FRONT

Key = tuple[str, str]
"""A fact and its player ("": the group)."""


@dataclass(frozen=True, slots=True)
class Execution:
    """The result of a behaviour: whether it was possible, and the invitations."""

    completed: bool
    invited: tuple[tuple[str, str, str], ...] = ()
    """Person, fact and value; "" is everybody."""


class DeclaredGame:
    """The state of one game of a declared activity."""

    def __init__(
        self,
        declaration: Declaration,
        players: Sequence[str],
        order: Sequence[int] = (),
        circle: Sequence[str] = (),
    ) -> None:
        """Begin a game.

        Args:
            declaration: the activity.
            players: those who take turns: people, or teams.
            order: the order of the items, as row numbers (default: as in the file).
            circle: the players as they sit (default: in the order of their turns).
        """
        self.declaration = declaration
        self.players = tuple(players)
        self.circle = tuple(circle) or self.players
        self.order = tuple(order) or tuple(range(declaration.items.rounds))
        self.values: dict[Key, str] = {}
        self.counts: dict[Key, float] = {}
        self.round = 0
        """The number of items presented so far."""
        self.here = self.players
        """The players who have not left, in order; at least one."""
        self.turn = 0
        self.queue: list[str] = []
        """Those who ask, first come first."""
        self.place = FRONT
        self.addressed: str | None = None
        self.actor: str | None = None
        self.acts = dict.fromkeys(self.players, 0)
        self.now = 0.0
        """The time in this game, in s."""
        self.step = 0
        self.closed: str | None = None
        self.screen: tuple[str, str | None, str] | None = None
        """Whose text or picture is on the chest screen: the behaviour, its person, the turn then.

        It stays until another one has its own, the next item comes, or the game is over.
        """
        self.over = False
        self.executed: dict[str, int] = {}

    def copy(self) -> DeclaredGame:
        """Return an independent copy of the game."""
        other = object.__new__(DeclaredGame)
        other.__dict__.update(self.__dict__)
        other.values, other.counts = dict(self.values), dict(self.counts)
        other.queue, other.acts = list(self.queue), dict(self.acts)
        other.executed = dict(self.executed)
        return other

    # --------------------------------------------------------------------------- current facts

    @property
    def row(self) -> int:
        """The row of the current item, -1 before the first."""
        return self.order[self.round - 1] if 0 < self.round <= len(self.order) else -1

    @property
    def rounds_left(self) -> int:
        """How many items have not been presented."""
        return len(self.order) - self.round

    def number(self, fact: Fact, player: str | None) -> float:
        """Return a count, or for how many s a timer has been running."""
        if fact.per_player and player is None:
            return 0.0
        kept = self.counts.get(_key(fact, player))
        if fact.kind != "timer":
            return kept or 0.0
        return 0.0 if kept is None else self.now - kept

    def value(self, name: str, player: str | None) -> str:
        """Return the value of a fact for conditions and the policy, of a player or the group.

        A per-player fact without a player has its first value.
        """
        fact = self.declaration.facts[name]
        if fact.built_in:
            return self._built_in(name, player)
        if fact.kind == "test":
            found = fact.values[0]
            for value, conditions in fact.tests:
                if all(self.holds(one, player) for one in conditions):
                    found = value
            return found
        if fact.kind in ("count", "timer"):
            return fact.band(self.number(fact, player)) if fact.bands else ""
        if fact.per_player and player is None:
            return fact.values[0]
        return self.values.get(_key(fact, player), fact.values[0])

    def _built_in(self, name: str, player: str | None) -> str:
        if name == ITEMS:
            return "over" if self.round >= len(self.order) else "left"
        if name == PLACE:
            if self.place == FRONT:
                return "front"
            return "beside" if self.place == player else "elsewhere"
        if name == ASKING:
            holds = player in self.queue
        elif name == TURN:
            holds = player is not None and self.players[self.turn] == player
        else:
            holds = player is not None and self.addressed == player
        return YES if holds else NO

    def holds(self, condition: FactCondition, player: str | None) -> bool:
        """Return whether a condition holds, for a player if it has no quantifier."""
        match condition.quantifier:
            case "":
                return self._holds_for(condition, player)
            case "any":
                return any(self._holds_for(condition, one) for one in self.here)
            case "every":
                return all(self._holds_for(condition, one) for one in self.here)
            case "nobody":
                return not any(self._holds_for(condition, one) for one in self.here)
            case "most" | "only one":
                many = sum(self._holds_for(condition, one) for one in self.here)
                return (
                    many == 1 if condition.quantifier == "only one" else 2 * many > len(self.here)
                )

    def _holds_for(self, condition: FactCondition, player: str | None) -> bool:
        if condition.comparison == "is":
            return self.value(condition.fact, player) == condition.value
        if condition.comparison == "is not":
            return self.value(condition.fact, player) != condition.value
        number = self.number(self.declaration.facts[condition.fact], player)
        enough = number >= condition.number
        return enough if condition.comparison == ">=" else not enough

    def whom(self, selector: Selector) -> str | None:
        """Return the person that a selector names now; None for nobody or the group."""
        match selector:
            case "group":
                return None
            case "first asking":
                return self.queue[0] if self.queue else None
            case "whose turn":
                return self.players[self.turn]
            case "next in circle":
                last = -1 if self.addressed is None else self.circle.index(self.addressed)
                after = (*self.circle[last + 1 :], *self.circle[: last + 1])
                return next(one for one in after if one in self.here)
            case "quietest":
                return min(self.here, key=lambda one: self.acts[one])
            case "last to act":
                return self.actor if self.actor in self.here else None
            case "addressed":
                return self.addressed if self.addressed in self.here else None
            case "beside":
                return self.place if self.place in self.here else None
            case _:
                return self._whose(self.declaration.whose[selector])

    def _whose(self, condition: FactCondition) -> str | None:
        """Return the player for whom a condition has held longest, or None."""
        fact = condition.fact
        since = [player for name, player in self.values if name == fact]  # in order of change
        able = [one for one in self.here if self._holds_for(condition, one)]
        return min(able, key=lambda one: since.index(one) if one in since else -1, default=None)

    def stage(self) -> tuple[Stage, str | None]:
        """Return the current stage, and its person."""
        for stage in self.declaration.stages:
            about = self.whom(stage.about)
            if all(self.holds(one, about) for one in stage.when):
                break
        return stage, about

    def seen(self, at: float | None = None) -> tuple[str, tuple[str, ...]]:
        """Return the input of the policy: the stage, and the values of its facts.

        `at` is the time for timers, in s of this game (default: now).
        """
        now, self.now = self.now, self.now if at is None else at
        try:
            stage, about = self.stage()
            return stage.name, tuple(self.value(name, about) for name in stage.sees)
        finally:
            self.now = now

    def allows(self, name: str, whom: str | None) -> bool:
        """Return whether a behaviour is possible now, for a player or the group.

        The next item needs one that is left.
        """
        behaviour = self.declaration.behaviours[name]
        if behaviour.needs_item and self.order and not self.rounds_left:
            return False
        if not behaviour.needs:
            return True
        person = whom if whom is not None else self.stage()[1]
        return all(self.holds(one, person) for one in behaviour.needs)

    # ------------------------------------------------------------------- changes of the facts

    def observe(self, name: str, who: str | None, raw: str, certainty: float = 1.0) -> bool:
        """Apply an observation.

        Args:
            name: the fact; `HERE` if a player leaves or comes back.
            who: the player, None for the group.
            raw: a value, or a person's answer.
            certainty: the probability that it is right.

        Returns:
            Whether anything changed.
        """
        if name == HERE:
            return self._moved(who, raw)
        fact = self.declaration.facts[name]
        if name == ASKING:
            return self._ask(who, raw)
        if fact.kind == "test" or fact.built_in or (fact.per_player and who not in self.here):
            return False
        if fact.kind == "count":
            key = _key(fact, who)
            self.counts[key] = self.counts.get(key, 0.0) + 1
        else:
            value = judged(fact, self.declaration.items, self.row, raw, certainty)
            if value is None or value == self.value(name, who):
                return False
            self._assign_value(_key(fact, who), value)
        if who in self.acts:
            self.actor = who
            self.acts[who] += 1
        return True

    def _ask(self, who: str | None, raw: str) -> bool:
        if who not in self.here or (who in self.queue) == (raw == YES):
            return False
        if raw == YES:
            self.queue.append(who)
        else:
            self.queue.remove(who)
        return True

    def _moved(self, who: str | None, raw: str) -> bool:
        """Let a player leave or come back; the last one stays, and a turn passes to the next."""
        if who not in self.players or (who in self.here) == (raw == YES):
            return False
        stay = {*self.here, who} if raw == YES else {*self.here} - {who}
        if not stay:
            return False
        self.here = tuple(one for one in self.players if one in stay)
        if who in self.queue:
            self.queue.remove(who)
        if self.players[self.turn] not in self.here:
            self.turn = self._next_here(self.turn)
        return True

    def _next_here(self, place: int) -> int:
        """Return the index of the next present player after an index."""
        count = len(self.players)
        after = ((place + n) % count for n in range(1, count + 1))
        return next(one for one in after if self.players[one] in self.here)

    def execute(self, name: str, whom: str | None) -> Execution:
        """Execute a behaviour, for a player or (None) the group."""
        self.closed = None
        self.step += 1
        if self.over or not self.allows(name, whom):
            return Execution(False)
        behaviour = self.declaration.behaviours[name]
        person = whom if whom is not None else self.stage()[1]
        self.executed[name] = self.executed.get(name, 0) + 1
        if whom is not None:
            self.addressed = whom
        invited: list[tuple[str, str, str]] = []
        for effect in behaviour.effects:
            if all(self.holds(one, person) for one in effect.conditions):
                self._change(effect, whom, invited)
        if behaviour.image or behaviour.picture:
            self.screen = name, whom, self.players[self.turn]
        return Execution(True, tuple(invited))

    def differs(self, other: DeclaredGame) -> bool:
        """Return whether facts other than timers, the item, turn, place or requests differ."""
        return self._apart_from_timers() != other._apart_from_timers()

    def _apart_from_timers(self) -> tuple[object, ...]:
        facts = self.declaration.facts
        counts = {key: n for key, n in self.counts.items() if facts[key[0]].kind != "timer"}
        return self.values, counts, self.round, self.turn, self.place, self.queue

    def failed(self) -> None:
        """Count a behaviour that could not be carried out: nothing else changes."""
        self.closed = None
        self.step += 1

    def _change(
        self, effect: Effect, whom: str | None, invited: list[tuple[str, str, str]]
    ) -> None:
        match effect.does:
            case "set" | "add" | "clear" | "start":
                fact = self.declaration.facts[effect.fact]
                everybody = self.here if effect.does == "add" else self.players
                for key in _keys(fact, whom, everybody):
                    self._assign(effect, key)
            case "next item":
                self.round = min(self.round + 1, len(self.order))
                self.screen = None
            case "next turn":
                self.turn = self._next_here(self.turn)
            case "go to front":
                self.place = FRONT
            case "go to whom":
                self.place = whom or self.place
            case "close request":
                for one in [whom] if whom is not None else list(self.queue):
                    if one in self.queue:
                        self.queue.remove(one)
                        self.closed = one
            case "invite":
                invited.append((whom or "", effect.fact, effect.value))
            case "finish":
                self.over = True
                self.screen = None

    def _assign_value(self, key: Key, value: str) -> None:
        """Set a value, and move it to the end of the order of changes."""
        self.values.pop(key, None)
        self.values[key] = value

    def _assign(self, effect: Effect, key: Key) -> None:
        if effect.does == "set":
            self._assign_value(key, effect.value)
        elif effect.does == "add":
            self.counts[key] = self.counts.get(key, 0.0) + effect.number
        elif effect.does == "start":
            self.counts[key] = self.now
        else:
            self.values.pop(key, None)
            self.counts.pop(key, None)


def _keys(fact: Fact, whom: str | None, everybody: Sequence[str]) -> list[Key]:
    """Return the keys that an effect changes: of the group, a player, or everybody."""
    if not fact.per_player:
        return [(fact.name, "")]
    return [(fact.name, one) for one in ([whom] if whom is not None else everybody)]


def _key(fact: Fact, player: str | None) -> Key:
    return fact.name, (player or "") if fact.per_player else ""
