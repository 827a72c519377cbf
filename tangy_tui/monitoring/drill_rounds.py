"""Rounds of a drill: faults that really happen, in simulated games that leave nothing behind.

Each round is a game of its own, with a log of its own in a folder that is thrown away, so that
none of it changes the facility's games or its beliefs about people.
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
"""Names that are offered for what was seen."""

QUIET_SHARE = 5
"""One round in so many has no fault: people should know when to let Tangy go on."""

MOST_TRIES = 40
"""Games that are tried until a fault can be seen alone; a few are enough where it can be at all."""

MOST_STEPS = 90
SETS_IN = (4, 26)
"""Between which steps of its game a fault sets in."""

REFUSED, LATE, ASKS, READING = "refused", "late", "asks", "reading"
QUIET_KINDS = (REFUSED, LATE, ASKS, READING)
"""What may catch the eye although nothing is wrong: somebody does not do what was asked, or does
it late, or asks while somebody else is being helped; or a device measures what it should."""


@dataclass(frozen=True, slots=True)
class RoundKind:
    """The case of a round: a name, the correct diagnosis ("": none), the injected fault.

    `gap`: nothing is brought about, but Tangy was not shown one of the situations.
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
    """Return every kind of fault that can be rehearsed with a book."""
    single = tuple(RoundKind(kind.name, kind.code, (kind.name,)) for kind in KINDS.values())
    codes = {rule.code for rule in book.rules}
    return tuple(kind for kind in (*single, *_TWO_AT_ONCE, *_GAPS) if kind.code in codes)


def draw_rounds(book: FaultBook, rounds: int, rng: Random) -> list[RoundKind]:
    """Draw what comes up in a drill.

    From four rounds on every class of fault comes up; no kind comes twice before all have come.
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
    """The question whether to clear Tangy: the view at that moment, and the right answer."""

    seen: str
    right: bool


@dataclass(frozen=True, slots=True)
class Round:
    """One round as a screen shows it, with the right answers.

    `noticed` is the evidence in words, `devices` all devices by label with their states, `choices`
    the codes that are offered as names. `fault` and `rule` are None if nothing is wrong; `quiet`
    then says what caught the eye.
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
        """The diagnosis that is right; "" if nothing is wrong."""
        return "" if self.rule is None else self.rule.code

    @property
    def recovery(self) -> str:
        """Return the right action: the first rung of the fault's ladder."""
        return "continue" if self.rule is None else self.rule.recovery[0]


class Tabletop:
    """Plays rounds on the table-top: with a policy, its effects, the fault rules, and people."""

    def __init__(
        self,
        policy: Policy,
        effects: Effects,
        book: FaultBook,
        robot: Robot,
        activity: Activity,
        names: Mapping[str, str],
    ) -> None:
        """Prepare to play; `names` are those who take part, by id."""
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
        """Return what a fault is called, of nobody in particular."""
        return self.plainly(self.book.rule(code), self.book.rule(code).name)

    def plainly(self, rule: FaultRule, text: str) -> str:
        """Fill in a rule's text so that it names nobody."""
        return rule.fill(text, name="the person", object=self.activity.object)

    def play(self, number: int, kind: RoundKind, rng: Random) -> Round:
        """Play games until the drawn fault, and no other, can be observed.

        What cannot occur in this activity is replaced by something of the same class.

        Raises:
            TangyError: nothing at all can be rehearsed.
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
                FaultyWorld(self.activity, ids, seed=seed),
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
        """Return the policy as it is where one of the situations was never shown."""
        table = dict(self._policy.table)
        situation = rng.choice(list(self.activity.situations))
        table[situation] = replace(table[situation], seen=0, right=())
        return replace(self._policy, table=table)

    def try_once(self, number: int, kind: RoundKind, seed: int) -> Round | None:
        """Play one game; None if something else happened in it, or nothing."""
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
                        return None  # something else, or too late to do anything about it
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
        """Make a round of a fault that has occurred in a game."""
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
        """Let the expert mend the fault or not, and see whether the robot can be cleared then."""
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
        """Return an observation that resembles a fault but is none; "" if there was none."""
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
        """Draw names that are wrong; at least one is of the same device or class."""
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
    """Say whether a fault can be taken for another one; for none: one that no device reports."""
    if rule is None:
        return not other.device
    return (rule.device != "" and rule.device == other.device) or (
        rule.recovery[0] == other.recovery[0]
    )


def _count(refused: Counter[str], acted: Acted) -> None:
    response = acted.outcome.response
    if response is not None:
        refused[response.person] = 0 if response.followed else refused[response.person] + 1
