"""Drills: staff rehearse the response to faults in the simulator, and get a score.

Screens, the line mode and scripts all drive a `Drill` by `next` and `answer`. The answers are
logged round by round, so that an interrupted drill can be resumed; nothing else of a drill is
logged.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from random import Random
from time import monotonic
from typing import Literal, TypeAlias, get_args

from tangy_profiles.drill_sheet import AnsweredRound, Sheet
from tangy_profiles.errors import TangyError
from tangy_profiles.game_records import DrillAnswered, DrillHeld
from tangy_profiles.store import Store
from tangy_tui.monitoring.drill_log import read_sheets
from tangy_tui.monitoring.drill_policy import DrillNote
from tangy_tui.monitoring.drill_rounds import DrillSimulator, Round, draw_rounds

ROUNDS, MOST_ROUNDS = 6, 50

DrillAsks: TypeAlias = Literal["what", "do", "clear"]
WHAT: DrillAsks = "what"
DO: DrillAsks = "do"
CLEAR: DrillAsks = "clear"
"""The questions of a round; the last one only after a critical fault."""

StaffDoes: TypeAlias = Literal["continue", "user", "teacher", "expert"]
"""The possible actions of staff, named after the recoveries."""

NOTHING = "0"
"""The key of the answer that nothing is wrong."""

ACTIONS: tuple[StaffDoes, ...] = get_args(StaffDoes)


@dataclass(frozen=True, slots=True)
class DrillOption:
    """A possible answer and its key.

    `value` is the code of a fault ("": nothing is wrong), a `StaffDoes`, or "yes" or "no"; `name`
    is the name of the fault.
    """

    key: str
    value: str
    name: str = ""


@dataclass(frozen=True, slots=True)
class Question:
    """A question of a round, with its answers."""

    kind: DrillAsks
    choices: tuple[DrillOption, ...]

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of its answers."""
        return tuple(choice.key for choice in self.choices)


class Drill:
    """One drill: `next` begins a round, `answer` answers its questions until none is left."""

    def __init__(
        self,
        simulator: DrillSimulator,
        store: Store,
        *,
        who: str,
        seed: int | None = None,
        rounds: int = ROUNDS,
        clock: Callable[[], float] = monotonic,
        note: DrillNote | None = None,
        past: Sheet | None = None,
    ) -> None:
        """Prepare a drill.

        Args:
            simulator: plays the rounds.
            store: the log that keeps the score sheet.
            who: the trainee.
            seed: the same seed draws the same rounds (default: one that no earlier drill used).
            rounds: the number of rounds.
            clock: returns seconds of a monotonic clock.
            note: why the drill does not use the learnt policy, or None.
            past: the sheet of an interrupted drill to resume; its seed and rounds are used.

        Raises:
            TangyError: the number of rounds is out of range.
        """
        if past is not None:
            seed, rounds = past.seed, past.rounds
        if not 1 <= rounds <= MOST_ROUNDS:
            raise TangyError(f"A drill has from 1 to {MOST_ROUNDS} rounds, not {rounds}.")
        earlier = read_sheets(store)
        if seed is None:
            seed = 1 + max((sheet.seed for sheet in earlier), default=0)
        mine = [sheet for sheet in earlier if sheet.by(who)]
        self.before = mine[-1] if mine else None
        """The sheet of the same person's previous drill."""
        self.simulator = simulator
        self.rounds = rounds
        self.note = note
        self.round: Round | None = None
        """The current round."""
        self.question: Question | None = None
        """The current question; None before the first round, and after a round's last answer."""
        self._store = store
        self._who = who
        self._seed = seed
        self._clock = clock
        self._plan = draw_rounds(simulator.book, rounds, Random(f"{seed}/drill"))
        self._given: dict[str, str] = {}
        self._since = 0.0
        self._answered = [] if past is None else list(past.answered)
        self._kept = False

    @property
    def number(self) -> int:
        """The number of the current round, from 1; 0 before the first."""
        return 0 if self.round is None else self.round.number

    @property
    def over(self) -> bool:
        """Whether every round has been answered."""
        return len(self._answered) == self.rounds

    @property
    def sheet(self) -> Sheet:
        """The score so far."""
        return Sheet(
            self._who, self.simulator.activity.name, self._seed, self.rounds, tuple(self._answered)
        )

    def next(self) -> Round | None:
        """Begin the next round; None if there is none, or one is still unanswered."""
        if self.over or self.question is not None:
            return None
        at = len(self._answered)
        rng = Random(f"{self._seed}/drill/{at}")
        self.round = self.simulator.play(at + 1, self._plan[at], rng)
        self._given = {}
        self._ask(WHAT)
        self._since = self._clock()
        return self.round

    def shown(self) -> None:
        """Start the clock of a round now that it is displayed."""
        if not self._given:
            self._since = self._clock()

    def answer(self, key: str) -> AnsweredRound | None:
        """Answer the question by the key of one of its choices.

        Returns:
            The round with its answers after its last question, else None. After the last round the
            sheet is logged.

        Raises:
            TangyError: there is no question, or no such key.
        """
        question, shown = self.question, self.round
        if question is None or shown is None:
            raise TangyError("Nothing is asked now.")
        chosen = next((choice for choice in question.choices if choice.key == key), None)
        if chosen is None:
            raise TangyError(f"Answer by one of: {', '.join(question.keys)}.")
        self._given[question.kind] = chosen.value
        self.question = None
        if question.kind == WHAT:
            self._ask(DO)
        elif question.kind == DO and shown.release is not None:
            self._ask(CLEAR)
        if self.question is not None:
            return None
        answered = self._judge(shown, round(self._clock() - self._since, 1))
        self._answered.append(answered)
        if self.over:
            self._keep()
        else:
            self._store.append(DrillAnswered(sheet=self.sheet))
        return answered

    def leave(self) -> Sheet | None:
        """Leave the drill and log its unfinished sheet; return None if it has no answer."""
        self.question = None
        if not self._answered:
            return None
        self._keep()
        return self.sheet

    def _keep(self) -> None:
        if not self._kept:
            self._kept = True
            self._store.append(DrillHeld(sheet=self.sheet))

    def _judge(self, shown: Round, seconds: float) -> AnsweredRound:
        rule, table = shown.rule, self.simulator
        answered = AnsweredRound(
            shown.number,
            shown.code,
            "Nothing was wrong" if rule is None else table.rule_name(rule.code),
            shown.recovery,
            () if rule is None else tuple(table.plainly(rule, step) for step in rule.advice),
            self._given[WHAT],
            self._given[DO],
            seconds,
        )
        if shown.release is None:
            return answered
        cleared = self._given[CLEAR] == "yes"
        return replace(answered, may_clear=shown.release.right, cleared=cleared)

    def _ask(self, kind: DrillAsks) -> None:
        if kind == WHAT and self.round is not None:
            choices = [
                DrillOption(str(number), code, self.simulator.rule_name(code))
                for number, code in enumerate(self.round.choices, 1)
            ]
            choices.append(DrillOption(NOTHING, ""))
        elif kind == DO:
            choices = [
                DrillOption(str(number), recovery) for number, recovery in enumerate(ACTIONS, 1)
            ]
        else:
            choices = [DrillOption("y", "yes"), DrillOption("n", "no")]
        self.question = Question(kind, tuple(choices))
