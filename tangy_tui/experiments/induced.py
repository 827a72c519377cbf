"""Faults induced in games: how many of each class, which kinds, in which game and when.

The plan is drawn from a seed. A planned fault occurs at its step, or with the first later behaviour
in which it can be observed. If that takes too long, another fault of its class may replace it; if
it does not happen in its game, the fault moves to the next one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from random import Random

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Action
from tangy_profiles.faults import FaultBook, Remedy
from tangy_profiles.robot import Robot
from tangy_profiles.state import ActivityState, Outcome
from tangy_sim.worlds.compliance import Preferences
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import AT_ONCE, KINDS, MOVING_ON, WAITING, FaultKind

LATEST = 30
"""The last step at which a fault may be planned; few games are shorter."""

LONG = 20
"""Steps after which a planned fault may be replaced by another kind of its class."""

NOT_BOTH = (("voice-dead", "screen-dead"), ("requests-silent", "request-withdrawn"))
"""Kinds of which a game has only one: together they are a third fault, or one hides the other."""


@dataclass(frozen=True)
class Planned:
    """A fault planned for some step of a game or later; `others` are kinds of its class."""

    kind: FaultKind
    step: int
    others: tuple[str, ...] = ()


@dataclass
class Induced:
    """A fault that occurred, from its step to the step at which it was removed (None: never)."""

    kind: FaultKind
    step: int
    seconds: float
    lifted: int | None = None
    hidden: bool = False
    """Whether the game ended before the fault could be observed."""

    @property
    def could_show(self) -> bool:
        """Whether the fault could be observed."""
        once = self.kind.shows in (WAITING, MOVING_ON)  # a momentary event
        return not self.hidden and (not once or self.lifted is not None)


def recovery_of(kind: FaultKind, book: FaultBook) -> str:
    """Return the right recovery for a kind: the first one of the rule for its code."""
    return book.rule(kind.code).recovery[0]


def kinds_by_recovery(book: FaultBook) -> dict[str, list[str]]:
    """Return the names of the kinds for each class of recovery."""
    found: dict[str, list[str]] = {}
    for name, kind in KINDS.items():
        found.setdefault(recovery_of(kind, book), []).append(name)
    return found


def in_proportion(mix: Mapping[str, int], of: int, games: int) -> dict[str, int]:
    """Scale the number of faults of each class in `of` games to another number of games.

    The total is rounded and distributed by the largest remainders (Hamilton's method).
    """
    exact = {name: count * games / of for name, count in mix.items()}
    scaled = {name: int(value) for name, value in exact.items()}
    left = int(sum(exact.values()) + 0.5) - sum(scaled.values())
    for name in sorted(exact, key=lambda name: scaled[name] - exact[name])[: max(0, left)]:
        scaled[name] += 1
    return scaled


def draw_plan(
    counts: Mapping[str, int], games: int, seed: int, book: FaultBook
) -> list[list[Planned]]:
    """Distribute faults over games: each class evenly, at most one of a kind per game.

    Args:
        counts: the number of faults of each class of recovery.
        games: the number of games.
        seed: seed of the random generators.
        book: the fault rules.
    """
    rng = Random(f"{seed}/plan")
    kinds = kinds_by_recovery(book)
    plan: list[list[Planned]] = [[] for _ in range(games)]
    for recovery, count in counts.items():
        order = list(range(games))
        rng.shuffle(order)
        for place, game in enumerate(order):
            for _ in range(count // games + (place < count % games)):
                had = [planned.kind.name for planned in plan[game]]
                free = [KINDS[name] for name in kinds[recovery] if fits(name, had)]
                if game == games - 1:  # there is no later game to move to
                    free = [kind for kind in free if kind.shows == AT_ONCE] or free
                if free:
                    kind = rng.choice(free)
                    others = [name for name in kinds[recovery] if name != kind.name]
                    rng.shuffle(others)
                    plan[game].append(Planned(kind, rng.randint(1, LATEST), tuple(others)))
    for game_plan in plan:
        game_plan.sort(key=lambda planned: planned.step)
    return plan


def fits(name: str, had: Sequence[str]) -> bool:
    """Return whether a kind may occur in a game that had these others."""
    return name not in had and not any(
        name in pair and not set(pair).isdisjoint(had) for pair in NOT_BOTH
    )


class Inducer:
    """Induces planned faults, one at a time: none while another one is new.

    A fault is new until something was done about it. None is induced with a behaviour that ends the
    game, and none while `held`, for example while a teacher is asked.
    """

    def __init__(self, plan: Sequence[Sequence[Planned]]) -> None:
        self.held = False
        self.due: list[Planned] = []
        """The faults still planned, including those left over from earlier games."""
        self.induced: list[Induced] = []
        """The faults that occurred in this game."""
        self._left = list(plan)
        self._treated: set[str] = set()

    def begin(self) -> None:
        """Begin the next game of the plan."""
        self.induced = []
        self._treated = set()
        if self._left:
            self.due = [*self.due, *self._left.pop(0)]

    def choose(
        self,
        step: int,
        action: Action,
        there: Iterable[FaultKind],
        shows: Callable[[FaultKind], bool],
    ) -> str:
        """Return the kind of fault to induce with an action; "" if none.

        Args:
            step: the step number of the action.
            action: the next action.
            there: the kinds of the present faults.
            shows: returns whether a kind could be observed if it occurred now.
        """
        new = any(kind.code not in self._treated for kind in there)
        if self.held or new or action.behaviour.ends:
            return ""
        had = [fault.kind.name for fault in self.induced]
        for planned in self.due:
            if planned.step > step:
                continue
            waited = step - planned.step >= LONG
            for name in (planned.kind.name, *(planned.others if waited else ())):
                if fits(name, had) and shows(KINDS[name]):
                    self.due.remove(planned)
                    return name
        return ""

    def came(self, name: str, step: int, seconds: float) -> None:
        """Record that a fault of a kind occurred, at a time in s of the game."""
        self.induced.append(Induced(KINDS[name], step, seconds))

    def lifted(self, name: str, step: int) -> None:
        """Record that a fault of a kind was removed."""
        for fault in self.induced:
            if fault.kind.name == name and fault.lifted is None:
                fault.lifted = step

    def treated(self, code: str) -> None:
        """Record that something was done about a fault."""
        self._treated.add(code)


class InducingWorld(FaultyWorld):
    """A simulated world with planned faults."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        plan: Sequence[Sequence[Planned]] = (),
        preferences: Preferences | None = None,
        robot: Robot | None = None,
    ) -> None:
        self.inducer = Inducer(plan)
        self._made = False
        super().__init__(activity, people, seed=seed, preferences=preferences, robot=robot)
        self._made = True

    @property
    def induced(self) -> list[Induced]:
        """The faults that occurred in this game."""
        return self.inducer.induced

    def begin(self) -> ActivityState:
        """Begin the next game of the plan."""
        if self._made:  # the constructor also calls it
            self.inducer.begin()
        return super().begin()

    def execute(self, action: Action) -> Outcome:
        """Inject a planned fault that can show now, and carry out the action."""
        if not self.over:
            self._induce(action)
        return super().execute(action)

    def _induce(self, action: Action) -> None:
        name = self.inducer.choose(
            self.tracker.step + 1,
            action,
            [fault.kind for fault in self.present.values()],
            lambda kind: self.can_show(kind, action),
        )
        if name:
            self.bring_about(name)

    def bring_about(self, name: str) -> None:
        """Inject a fault of a kind into the next behaviour."""
        self.inducer.came(name, self.tracker.step + 1, self.seconds)
        self.inject(name)

    def lift(self, kind: str) -> None:
        """Remove a fault, and record when."""
        if kind in self.present:
            self.inducer.lifted(kind, self.tracker.step)
        super().lift(kind)

    def recover(self, remedy: Remedy) -> float:
        """Record that a fault is treated, and carry out the remedy; return the s it took."""
        self.inducer.treated(remedy.fault)
        return super().recover(remedy)
