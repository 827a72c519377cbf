"""Rounds of a drill: injected faults in simulated games that leave no trace.

Each round is a separate game with a log in a temporary folder, so it does not change the facility's
games or beliefs about people.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.faults import URGENCY, FaultBook, FaultRule
from tangy_profiles.health import Health
from tangy_profiles.robot import Robot
from tangy_profiles.scene import Scene
from tangy_profiles.state import ActivityState
from tangy_profiles.store import Store
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import KINDS
from tangy_tui.interaction.facilitation import Facilitation
from tangy_tui.interaction.game_events import Acted
from tangy_tui.interaction.persuasion import Persuasion
from tangy_tui.learning.effects import Effects
from tangy_tui.learning.online_learning import OnlineLearning
from tangy_tui.learning.policy import Policy
from tangy_tui.monitoring.detection import Detector
from tangy_tui.monitoring.diagnosis import narrows
from tangy_tui.monitoring.evidence import evidence_words
from tangy_tui.monitoring.fault import Diagnosed, Fault
from tangy_tui.monitoring.supervision import Supervision

CHOICES = 4
"""The number of fault names to choose from."""

QUIET_SHARE = 5
"""One round in this many has no fault, so that staff learn when to let Tangy continue."""

MOST_TRIES = 40
"""The most games to play until a fault occurs alone; usually a few are enough."""

MOST_STEPS = 90
SETS_IN = (4, 26)
"""The range of steps in which a fault occurs."""

REFUSED, LATE, ASKS, READING = "refused", "late", "asks", "reading"
QUIET_KINDS = (REFUSED, LATE, ASKS, READING)
"""Quiet rounds: a refusal, a late response, a request during a visit, or a normal reading."""


@dataclass(frozen=True, slots=True)
class RoundKind:
    """The scenario of a round: its name, the right diagnosis ("": none), the injected faults.

    `gap`: no fault is injected, but one of the situations was not demonstrated.
    """

    name: str
    code: str = ""
    injections: tuple[str, ...] = ()
    gap: bool = False


QUIET = RoundKind("quiet")
_TWO_AT_ONCE = (RoundKind("mute", "mute", ("voice-dead", "screen-dead")),)
_NOT_YET_A_FAULT = ("never-complies",)
"""Injections that make a person refuse; a fault only if they persist."""
_GAPS = (RoundKind("unknown-situation", "unknown-situation", gap=True),)


def round_kinds(book: FaultBook) -> tuple[RoundKind, ...]:
    """Return every scenario that can be rehearsed with these rules."""
    single = tuple(RoundKind(kind.name, kind.code, (kind.name,)) for kind in KINDS.values())
    codes = {rule.code for rule in book.rules}
    return tuple(kind for kind in (*single, *_TWO_AT_ONCE, *_GAPS) if kind.code in codes)


def draw_rounds(book: FaultBook, rounds: int, rng: Random) -> list[RoundKind]:
    """Draw the scenarios of a drill.

    With four rounds or more, every class of fault occurs; no scenario is repeated before all have
    occurred.
    """
    share, rest = divmod(rounds, QUIET_SHARE)
    quiet = share + (rng.random() < rest / QUIET_SHARE)
    classes = {book.rule(kind.code).recovery[0] for kind in round_kinds(book)}
    if rounds >= len(classes):
        quiet = min(quiet, rounds - len(classes))
    drawn: list[RoundKind] = []
    while len(drawn) < rounds - quiet:
        bag = list(round_kinds(book))
        rng.shuffle(bag)
        firsts = [
            next(kind for kind in bag if book.rule(kind.code).recovery[0] == recovery)
            for recovery in URGENCY
            if recovery in classes
        ]
        bag = [*firsts, *(kind for kind in bag if kind not in firsts)]
        some = bag[: rounds - quiet - len(drawn)]
        rng.shuffle(some)
        drawn += some
    for _ in range(quiet):
        drawn.insert(rng.randrange(len(drawn) + 1), QUIET)
    return drawn


@dataclass(frozen=True, slots=True)
class Release:
    """The question whether to clear the halt: the evidence at that moment, and the right answer."""

    seen: str
    right: bool


@dataclass(frozen=True, slots=True)
class Round:
    """One round for display, with the right answers.

    `noticed` is the evidence in words, `devices` maps each device's label to its state, and
    `choices` are the codes of the offered faults. `fault` and `rule` are None if nothing is wrong;
    `quiet` then says what looks like a fault.
    """

    number: int
    kind: RoundKind
    state: ActivityState
    scene: Scene
    acted: Acted | None
    person: str | None
    noticed: str
    devices: tuple[tuple[str, str], ...]
    choices: tuple[str, ...]
    fault: Fault | None = None
    rule: FaultRule | None = None
    release: Release | None = None
    quiet: str = ""

    @property
    def code(self) -> str:
        """The right diagnosis; "" if nothing is wrong."""
        return "" if self.rule is None else self.rule.code

    @property
    def recovery(self) -> str:
        """Return the right action: the first recovery of the fault's ladder."""
        return "continue" if self.rule is None else self.rule.recovery[0]


class DrillSimulator:
    """Plays rounds in the simulator with a policy, its effects, the fault rules, and people."""

    def __init__(
        self,
        policy: Policy,
        effects: Effects,
        book: FaultBook,
        robot: Robot,
        activity: Activity,
        names: Mapping[str, str],
    ) -> None:
        """Prepare to play; `names` are the participants, by id."""
        self.book = book
        self.robot = robot
        self.activity = activity
        self.names = dict(names)
        self._policy = policy
        self._effects = effects
        self._detector = Detector(activity, robot, effects)

    def name(self, person: str) -> str:
        """Return a person's name."""
        return self.names.get(person, person)

    def rule_name(self, code: str) -> str:
        """Return the name of a fault, without a person's name."""
        return self.plainly(self.book.rule(code), self.book.rule(code).name)

    def plainly(self, rule: FaultRule, text: str) -> str:
        """Fill in a rule's text without a person's name."""
        return rule.fill(text, name="the person", object=self.activity.object)

    def play(self, number: int, kind: RoundKind, rng: Random) -> Round:
        """Play games until the drawn fault, and no other, occurs.

        A fault that cannot occur in this activity is replaced by another, preferably of the same
        class.

        Raises:
            TangyError: no fault can occur at all.
        """
        for one in self._instead(kind, rng):
            for _ in range(MOST_TRIES):
                found = self.try_once(number, one, rng.randrange(1_000_000_000))
                if found is not None:
                    return found
        raise TangyError(f"No fault of {self.activity.title} could be brought about.")

    def _instead(self, kind: RoundKind, rng: Random) -> Iterator[RoundKind]:
        yield kind
        others = [other for other in round_kinds(self.book) if other != kind]
        rng.shuffle(others)
        mine = self._recovery(kind)
        yield from sorted(others, key=lambda other: self._recovery(other) != mine)

    def _recovery(self, kind: RoundKind) -> str:
        return self.book.rule(kind.code).recovery[0] if kind.code else "continue"

    @contextmanager
    def _game(self, kind: RoundKind, seed: int, rng: Random) -> Iterator[Supervision]:
        """Open a game with a temporary log."""
        ids = list(self.names)
        strategies = tuple(self.activity.strategies)
        policy = self._with_a_gap(rng) if kind.gap else self._policy
        with TemporaryDirectory(prefix="tangy-drill-") as folder, Store.open(
            Path(folder)
        ) as store, store.transaction():  # fmt: skip
            facilitation = Facilitation(
                FaultyWorld(self.activity, ids, seed=seed, robot=self.robot),
                policy,
                Persuasion(ids, strategies, Random(f"{seed}/persuasion")),
                store,
                names=self.names,
                seed=seed,
                answers=OnlineLearning(store, self.activity),
            )
            yield Supervision(
                facilitation, self.book, self.robot, store, lambda _: self._effects, self.name
            )

    def _with_a_gap(self, rng: Random) -> Policy:
        """Return the policy as if one of the situations had never been demonstrated."""
        table = dict(self._policy.table)
        situation = rng.choice(list(self.activity.situations))
        table[situation] = replace(table[situation], seen=0, right=())
        return replace(self._policy, table=table)

    def try_once(self, number: int, kind: RoundKind, seed: int) -> Round | None:
        """Play one game; return None if the fault did not occur, or another one did."""
        rng = Random(f"{seed}/round")
        sets_in, wanted = rng.randrange(*SETS_IN), rng.choice(QUIET_KINDS)
        brought = _NOT_YET_A_FAULT if (kind, wanted) == (QUIET, REFUSED) else kind.injections
        refused = Counter[str]()
        acted: Acted | None = None
        with self._game(kind, seed, rng) as game:
            game.begin()
            for step in range(MOST_STEPS):
                if step == sets_in and isinstance(game.world, FaultyWorld):
                    for injection in brought:
                        game.world.inject(injection)
                for event in (events := game.step()):
                    if isinstance(event, Acted):
                        acted = event
                        _count(refused, event)
                found = [event.fault for event in events if isinstance(event, Diagnosed)]
                if found:
                    if [fault.code for fault in found] != [kind.code] or game.over:
                        return None  # another fault, or too late to respond
                    return self.fault_round(number, kind, game, found[0], acted, rng)
                if game.over:
                    return None
                if kind == QUIET and step >= sets_in and acted is not None:
                    noticed = self._catches_the_eye(wanted, acted, refused, game, rng)
                    if noticed:
                        return self._quiet_round(number, game, wanted, noticed, acted, rng)
        return None

    def fault_round(
        self,
        number: int,
        kind: RoundKind,
        game: Supervision,
        fault: Fault,
        acted: Acted | None,
        rng: Random,
    ) -> Round:
        """Make a round of a fault that occurred in a game."""
        rule, world = self.book.rule(fault.code), game.world
        shown = Round(
            number,
            kind,
            world.observe(),
            world.scene(),
            acted,
            fault.person,
            fault.why,
            self._states(world.health()),
            self._names_to_choose(rule, rng),
            fault,
            rule,
        )
        if game.halted is None:
            return shown
        return replace(shown, release=self._release(game, fault, mended=rng.random() < 0.5))

    def _release(self, game: Supervision, fault: Fault, *, mended: bool) -> Release:
        """Let the expert repair the fault or not, and check whether the halt can be cleared."""
        who = "drill"
        if mended:
            game.call_expert(who)
        else:
            game.acknowledge(who)
        now = self._detector.watch(game.world.health())
        rule = self.book.rule(fault.code)
        beside = {c.key for those in rule.when for c in those if narrows(c, those, self.book)}
        conditions = [c for those in rule.when for c in those if c.holds(now)]
        evidence = {key: now[key] for key in fault.evidence if key in now and key not in beside}
        seen = evidence_words(evidence, (), self.robot, conditions)
        game.clear(who)
        return Release(seen, game.halted is not fault)

    def _quiet_round(
        self,
        number: int,
        game: Supervision,
        quiet: str,
        noticed: str,
        acted: Acted,
        rng: Random,
    ) -> Round:
        world = game.world
        return Round(
            number,
            QUIET,
            world.observe(),
            world.scene(),
            acted,
            None,
            noticed,
            self._states(world.health()),
            self._names_to_choose(None, rng),
            quiet=quiet,
        )

    def _catches_the_eye(
        self, quiet: str, acted: Acted, refused: Mapping[str, int], game: Supervision, rng: Random
    ) -> str:
        """Return an observation that only looks like a fault; "" if there was none."""
        response = acted.outcome.response
        if quiet == READING:
            told = [one for one in game.world.health() if one.facts]
            one = rng.choice(told)
            facts = {f"{one.device}.{fact}": value for fact, value in one.facts.items()}
            return evidence_words(facts, (), self.robot)
        if quiet == ASKS:
            asked = {user.id for user in acted.state.users if user.request == "AR"}
            waiting = [user.id for user in acted.after.users if user.request == "AR"]
            new = [person for person in waiting if person not in asked]
            busy = acted.state.attended is not None and acted.state.attended not in new
            return f"{self.name(new[0])} has begun to ask for help" if new and busy else ""
        if response is None or response.complied or response.followed is not (quiet == LATE):
            return ""
        name = self.name(response.person)
        if quiet == LATE:
            return f"{name} did what was asked, but took {response.seconds:.0f} s"
        count = refused[response.person]
        times = "once" if count == 1 else f"{count} times in a row"
        return f"{name} has not done what was asked, {times}"

    def _states(self, health: Health) -> tuple[tuple[str, str], ...]:
        devices = self.robot.devices
        return tuple(
            (devices[one.device].label, self._detector.state(one))
            for one in health
            if one.device in devices
        )

    def _names_to_choose(self, rule: FaultRule | None, rng: Random) -> tuple[str, ...]:
        """Draw the names to choose from; at least one wrong one is of the same device or class."""
        others = [other for other in self.book.rules if rule is None or other.code != rule.code]
        rng.shuffle(others)
        first = next((other for other in others if _alike(rule, other)), others[0])
        wrong = [first, *(other for other in others if other is not first)]
        codes = [other.code for other in wrong[: CHOICES - (rule is not None)]]
        if rule is not None:
            codes.append(rule.code)
        rng.shuffle(codes)
        return tuple(codes)


def _alike(rule: FaultRule | None, other: FaultRule) -> bool:
    """Return whether a fault resembles another; without a fault: whether no device reports it."""
    if rule is None:
        return not other.device
    return (rule.device != "" and rule.device == other.device) or (
        rule.recovery[0] == other.recovery[0]
    )


def _count(refused: Counter[str], acted: Acted) -> None:
    response = acted.outcome.response
    if response is not None:
        refused[response.person] = 0 if response.followed else refused[response.person] + 1
