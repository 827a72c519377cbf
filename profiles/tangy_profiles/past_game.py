"""An interrupted game, as read from the log, so that it can be continued.

The log has every behaviour with the state after it. From the seed, these behaviours and those of
the earlier games in the same run, a world can restore the state.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from math import inf
from typing import Protocol

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action, calling
from tangy_profiles.declared.memory import GameMemory, with_player
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import SETTLING, GameBeginning, GameChange, GameEnding, GameStep
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.game_world import SIMULATED, GameWorld
from tangy_profiles.known_cards import KnownCards
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.state import FRONT, ActivityState, Outcome, UserState
from tangy_profiles.store import Event, Store
from tangy_profiles.tracker import Tracker
from tangy_profiles.unfinished import late_requests, unchecked_claims, unmade_moves


class OpenRequests:
    """The open requests of a game, brought forward step by step.

    While the robot first calls some numbers, the state shows no requests, but they stay open.
    """

    def __init__(self) -> None:
        """Begin a game in which nobody has asked."""
        self.people = frozenset[str]()
        self._calls = 0  # to come before the next visit

    def change(self, change: GameChange) -> None:
        """Apply a change of the game."""
        if change.what in ("calls first", "all called"):
            self._calls = change.number
        elif change.what in SETTLING:
            self.people -= {change.person}
        elif change.what == "visit":
            self.people |= {change.person}

    def step(self, before: ActivityState, after: ActivityState, *, called: bool) -> None:
        """Apply a step that led from a state to the next, and whether it called a number."""
        if after.place not in (FRONT, before.place):
            self._calls = 0
        if called:
            self._calls = max(0, self._calls - 1)
        if not self._calls:
            self.people = frozenset(user.id for user in after.users if user.request == "AR")


class NotResumable(TangyError):
    """An interrupted game cannot be continued; the message says why."""

    def __init__(self, why: str) -> None:
        super().__init__(f"{CANNOT_GO_ON}: {why}.")


CANNOT_GO_ON = "The game cannot go on where it was interrupted"
OTHER_PEOPLE = "other people take part now"
FACTS_UNKNOWN = "its log has no facts: it was played by an earlier version"
OTHERWISE = "its steps do not come out as they did"


class ReplayedWorld(Protocol):
    """A deterministic simulated world."""

    activity: Activity
    people: tuple[str, ...]

    def begin(self) -> ActivityState:
        """Begin a game."""
        ...

    def observe(self) -> ActivityState:
        """Return the current state."""
        ...

    def execute(self, action: Action) -> Outcome:
        """Carry out an action."""
        ...

    def choose(self, plan: GamePlan) -> None:
        """Set the plan of the next game."""
        ...

    def change(self, change: GameChange) -> None:
        """Apply a change of the game."""
        ...


@dataclass(frozen=True, slots=True)
class PastGame:
    """A game read from the log."""

    beginning: GameBeginning
    at: datetime
    """When its last event was logged (UTC)."""
    steps: tuple[GameStep, ...] = ()
    earlier: tuple[tuple[GameStep, ...], ...] = ()
    """The earlier games in the same run, oldest first."""
    taken_back: tuple[int, ...] = ()
    """The numbers that staff took back, in order."""
    run: tuple[GameBeginning, ...] = ()
    """The beginnings of the earlier games."""
    changes: tuple[GameChange, ...] = ()
    """Changes in this game and the earlier ones, besides their steps."""

    newcomers: tuple[str, ...] = ()
    """Who takes part from where it goes on; `beginning` and `steps` know them already."""

    acted: float = 0.0
    """The time played at staff's last logged action, in s."""
    asked_for: tuple[str, ...] = ()
    """For whom staff asked for help so late that no step shows it, in order."""
    cards: KnownCards = field(default_factory=KnownCards)
    """Whose card was known in this game."""
    unmade: tuple[GameChange, ...] = ()
    """Who left or came by the word of staff, so late that the game had not changed yet."""
    claims: tuple[tuple[int, str], ...] = ()
    """The claims that were made and not checked yet: each card, and the person ("": unknown)."""
    came: tuple[tuple[str, int], ...] = ()
    """The new people who came, in order, each with the place (from 0) that staff gave them."""

    @property
    def world(self) -> GameWorld:
        """The world in which it was played."""
        return self.beginning.world or SIMULATED

    def joined_by(self, person: str, unread: str, place: int | None = None) -> PastGame:
        """Return the game with one more person, about whom nothing is known.

        Args:
            person: the id.
            unread: the state of a person about whom nothing is known.
            place: the person's place from 0; None: after the others.
        """
        there = self.beginning.people
        if person in there:
            return self
        at = len(there) if place is None else place
        new = UserState(person, unread, "ANR")

        def among(state: ActivityState | None) -> ActivityState | None:
            if state is None or any(user.id == person for user in state.users):
                return state
            return state._replace(users=(*state.users[:at], new, *state.users[at:]))

        def knowing(memory: GameMemory | None) -> GameMemory | None:
            if memory is None or any(who == person for who, _ in memory.acts):
                return memory
            return with_player(memory, person, at)

        steps = tuple(
            replace(step, after=among(step.after), memory=knowing(step.memory))
            for step in self.steps
        )
        beginning = replace(self.beginning, people=(*there[:at], person, *there[at:]))
        return replace(self, beginning=beginning, steps=steps)

    @property
    def clock(self) -> tuple[float, ...]:
        """The time played at the end of each step, in s; in old logs the sum of their durations."""
        times, played = list[float](), 0.0
        for step in self.steps:
            played = played + (step.seconds or 0.0) if step.clock is None else step.clock
            times.append(played)
        return tuple(times)

    @property
    def seconds(self) -> float:
        """The time played until the last step or action of staff, in s."""
        return max(self.acted, self.clock[-1] if self.steps else 0.0)

    def asked(self, activity: Activity) -> dict[str, float]:
        """Return since when each person has waited for the robot, in s of the time played.

        They stand in the order of the queue, as far as the log has it.
        """
        requests, since, over = OpenRequests(), dict[str, float](), 0.0
        calls = calling(activity.behaviours)
        for number, (step, over) in enumerate(zip(self.steps, self.clock, strict=True)):
            before = self.clock[number - 1] if number else -inf
            self._change(requests.change, self.beginning.game, number)
            called = step.behaviour in calls and step.completed
            requests.step(step.state, step.after or step.state, called=called)
            seen = {user.id for user in step.state.users if user.request == "AR"}
            begun = over - (step.seconds or 0.0)
            people = requests.people if step.asking is None else step.asking
            told = dict(zip(step.asking or (), step.since or (), strict=False))
            first = {p: begun if p in seen else over for p in people}
            first |= {p: max(before, at) for p, at in told.items() if p in first}
            since = {p: since.get(p, first[p]) for p in people}
        return since

    def waits(self, activity: Activity) -> dict[str, float]:
        """Return how long each person had waited for the robot in the time played, in s."""
        return {person: self.seconds - at for person, at in self.asked(activity).items()}

    def replay(self, world: ReplayedWorld) -> ActivityState:
        """Replay the logged games of the run; return the last state.

        Raises:
            NotResumable: the states differ: other people take part, faults were injected, or the
                simulator has changed since.
        """
        if self.beginning.people != world.people:
            raise NotResumable(OTHER_PEOPLE)
        games = zip((*self.run, self.beginning), (*self.earlier, self.steps), strict=True)
        for beginning, steps in games:
            world.choose(beginning.plan)
            world.begin()
            self._change(world.change, beginning.game, 0)
            for number, step in enumerate(steps, start=1):
                behaviour = world.activity.behaviours.get(step.behaviour)
                if behaviour is None:
                    raise NotResumable(OTHERWISE)
                world.execute(world.activity.action(behaviour, step.target, step.strategy))
                if world.observe() != step.after:
                    raise NotResumable(OTHERWISE)
                self._change(world.change, beginning.game, number)
        return world.observe()

    @property
    def since_step(self) -> list[GameChange]:
        """The changes after the last step, in order."""
        last = self.beginning.game, len(self.steps)
        return [one for one in self.changes if (one.game, one.steps) == last]

    def _change(self, change: Callable[[GameChange], object], game: str, steps: int) -> None:
        """Apply the logged changes of a game after this many steps."""
        for one in self.changes:
            if (one.game, one.steps) == (game, steps):
                change(one)

    def follow(self, tracker: Tracker, change: Callable[[GameChange], object]) -> None:
        """Bring the tracker of a new game to the state of this game.

        Raises:
            NotResumable: the log does not lead there.
        """
        if self.beginning.people != tracker.people:
            raise NotResumable(OTHER_PEOPLE)
        self._change(change, self.beginning.game, 0)
        for number, step in enumerate(self.steps, start=1):
            if not tracker.follow(step):
                raise NotResumable(OTHERWISE)
            if step is self.steps[-1] and step.asking is not None:
                tracker.queue = [*step.asking]  # the states show neither its order nor all of it
            self._change(change, self.beginning.game, number)

    def visited(self, activity: Activity) -> dict[str, int]:
        """Return the number of calls before each person's last visit; see `PlannedGame`."""
        draws = calling(activity.behaviours)
        visited, calls = dict[str, int](), 0
        mine = [one for one in self.changes if one.game == self.beginning.game]
        last = next((n for n, one in enumerate(mine) if one.what == "all called"), len(mine))
        anew = {one.steps for one in mine[last:] if one.what in ("all called", "played on")}
        for number, step in enumerate(self.steps):
            if number in anew:
                visited.clear()
            if step.behaviour in draws:
                calls += len(step.numbers)
            elif step.completed and step.target in self.beginning.people:
                visited[step.target] = calls
        if len(self.steps) in anew:
            visited.clear()
        return visited

    def since_call(self, activity: Activity) -> float:
        """Return the duration of the steps after the last call, in s."""
        draws = calling(activity.behaviours)
        seconds = 0.0
        for step in reversed(self.steps):
            if step.behaviour in draws:
                break
            seconds += step.seconds or 0.0
        return seconds

    def called(self, activity: Activity) -> list[int]:
        """Return the called numbers that count, in order."""
        draws = calling(activity.behaviours)
        called = [n for step in self.steps if step.behaviour in draws for n in step.numbers]
        for number in self.taken_back:  # a number that was called again stays
            if number in called:
                called.remove(number)
        return called

    def called_by(self, activity: Activity, steps: int) -> list[int]:
        """Return the numbers that counted as called after so many steps, in order."""
        draws = calling(activity.behaviours)
        called = [n for s in self.steps[:steps] if s.behaviour in draws for n in s.numbers]
        for one in self.changes:
            mine = one.game == self.beginning.game and one.steps <= steps
            if mine and one.what == "taken back" and one.number in called:
                called.remove(one.number)
        return called

    def order(self, shuffled: Sequence[int], called: Sequence[int]) -> list[int]:
        """Return the calling order of all numbers, given the shuffled order.

        Called numbers come first, numbers that were taken back last.
        """
        last = [number for number in dict.fromkeys(self.taken_back) if number not in called]
        rest = [number for number in shuffled if number not in {*called, *last}]
        return [*called, *rest, *last]


def interrupted_game(store: Store, activity: str) -> PastGame | None:
    """Return the newest game of an activity, if it has a step but no ending in the log.

    Later games of other activities do not matter. An older interrupted game no longer counts once a
    newer game of the activity was begun.
    """
    games: list[Event[GameBeginning]] = [
        event for event in store.events(GameBeginning) if event.record.activity == activity
    ]
    if not games:
        return None
    newest = games[-1]
    game = newest.record.game
    if any(end.record.game == game for end in store.events(GameEnding, after=newest.seq)):
        return None
    run = _run(games)
    steps: dict[str, list[GameStep]] = {event.record.game: [] for event in run}
    at = newest.at
    last = list[Event[GameStep]]()  # those of the newest game
    for event in store.events(GameStep, after=run[0].seq):
        if event.record.game in steps:
            steps[event.record.game].append(event.record)
            at = event.at
            if event.record.game == game:
                last.append(event)
    if not steps[game]:
        return None
    *earlier, own = (tuple(steps[event.record.game]) for event in run)
    acts = [
        note for note in store.events(StaffAction, after=newest.seq) if note.record.game == game
    ]
    notes = [note.record for note in acts]
    taken = tuple(note.taken_back for note in notes if note.taken_back)
    acted = max((note.seconds or 0.0 for note in notes), default=0.0)
    changes = tuple(
        event.record
        for event in store.events(GameChange, after=run[0].seq)
        if event.record.game in steps
    )
    began = tuple(event.record for event in run[:-1])
    return PastGame(
        newest.record,
        datetime.fromisoformat(at),
        own,
        tuple(earlier),
        taken,
        began,
        changes,
        acted=acted,
        asked_for=late_requests(acts, last),
        cards=KnownCards.of(notes),
        claims=unchecked_claims(notes),
        unmade=unmade_moves(newest.record, notes, changes, len(own)),
        came=tuple(
            (note.person, note.seat - 1) for note in notes if note.did == "came" and note.seat
        ),
    )


def _run(games: list[Event[GameBeginning]]) -> list[Event[GameBeginning]]:
    """Return the newest game with the games before it in the same run."""
    run = [games[-1]]
    for event in reversed(games[:-1]):
        if not run[0].record.follows(event.record):
            break
        run.insert(0, event)
    return run
