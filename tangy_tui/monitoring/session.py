"""A session: one or more games, as a report presents them, read from the log alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal, TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.beliefs import Beliefs, Beta
from tangy_profiles.persuading import PAPER
from tangy_profiles.staff_records import StaffActionKind
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.memory import PersonModel, PersonModels, counted, replayed
from tangy_tui.interaction.tally import TallyRow
from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.fault import BORNE, OPEN, Diagnosed, Fault
from tangy_tui.monitoring.fault_table import fault_rows
from tangy_tui.monitoring.games import Game
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.player_facts import PlayerFacts, player_facts
from tangy_tui.monitoring.replay import GameReplay, Noted, read_replays

RESULTS = (
    ("complied", "did it"),
    ("late", "did it late"),
    ("refused", "would rather not"),
    ("void", "void"),
    ("awaited", "without an answer"),
)
"""Outcomes of a request: the counts of `Attempts`, and their words."""

SET_ASIDE = "set aside"
"""The remedy that leaves a person alone: staff should look after them."""


INJECTED: tuple[StaffActionKind | Literal["resumed"], ...] = (
    "fault injected",
    "fault lifted",
    "faults planned",
)
"""Actions after which faults of a session came on purpose."""


@dataclass
class Attempts:
    """Results of one strategy with one person: its uses, and the responses.

    `late`: followed too late to count as complied. `void` ones do not count in the belief,
    `awaited` ones have no answer yet. `before` and `after` are the beliefs.
    """

    complied: int = 0
    late: int = 0
    refused: int = 0
    void: int = 0
    awaited: int = 0
    before: Beta = field(default_factory=Beta)
    after: Beta = field(default_factory=Beta)

    @property
    def used(self) -> int:
        """How often the strategy was used in the session."""
        return self.complied + self.late + self.refused + self.void + self.awaited

    @property
    def in_words(self) -> str:
        """The results in words: "2 complied, 1 without an answer"."""
        return result_words({what: getattr(self, what) for what, _ in RESULTS})

    def to_json(self) -> dict[str, Any]:
        """Return the counts, and the beliefs with mean and interval."""
        return {
            "used": self.used,
            "complied": self.complied,
            "late": self.late,
            "not": self.refused,
            "void": self.void,
            "awaited": self.awaited,
            "before": _belief(self.before),
            "after": _belief(self.after),
        }


@dataclass(frozen=True, slots=True)
class Progress:
    """One person in a session: strategy -> results."""

    id: str
    name: str
    strategies: Mapping[str, Attempts]

    @property
    def interactions(self) -> int:
        """How often the person was asked for something."""
        return sum(one.used for one in self.strategies.values())

    def total(self, what: str) -> int:
        """Sum one of the counts over the strategies."""
        return sum(getattr(one, what) for one in self.strategies.values())

    @property
    def in_words(self) -> str:
        """The results of all requests, over the strategies."""
        return result_words({what: self.total(what) for what, _ in RESULTS})


def result_words(counts: Mapping[str, int]) -> str:
    """Format the outcomes of requests in words, without zero counts."""
    return ", ".join(f"{counts[what]} {words}" for what, words in RESULTS if counts[what])


NoteKind: TypeAlias = Literal["unknown activity", "no times", "brought about"]


@dataclass(frozen=True, slots=True)
class SessionNote:
    """A limit of a report: an unknown activity, games without times, or injected faults.

    `about` is the activity's name, or the injected faults.
    """

    kind: NoteKind
    about: str = ""


@dataclass(frozen=True, slots=True)
class Session:
    """The contents of a session's report; `title` is the activity's."""

    replays: tuple[GameReplay, ...]
    title: str
    rows: tuple[TallyRow, ...]
    people: tuple[Progress, ...]
    notes: tuple[SessionNote, ...]
    """Notes for the reader about the sources of the report."""
    names: Mapping[str, str]
    reads: frozenset[str] = frozenset()
    """The stages in which Tangy helps a person."""
    activity: Activity | None = None
    """The first known activity of the games."""

    def name(self, person: str) -> str:
        """Return a person's name."""
        return self.names.get(person, person)

    @property
    def player_facts(self) -> list[PlayerFacts]:
        """People's answers and counts, game by game, in an activity by facts."""
        return player_facts(self.replays, self.activity)

    @property
    def timed_faults(self) -> tuple[tuple[str, Fault], ...]:
        """The faults in order, each with the time of its diagnosis (ISO 8601)."""
        return tuple(
            (moment.at, moment.what.fault)
            for replay in self.replays
            for moment in replay.moments
            if isinstance(moment.what, Diagnosed) and not moment.what.fault.asks_only
        )

    @property
    def games(self) -> tuple[Game, ...]:
        """The games, newest last."""
        return tuple(replay.game for replay in self.replays)

    @property
    def faults(self) -> tuple[Fault, ...]:
        """The faults of all games, in order."""
        return tuple(fault for replay in self.replays for fault in replay.real_faults)

    @property
    def questions(self) -> tuple[Fault, ...]:
        """The questions about what to do, though nothing was wrong."""
        return tuple(fault for r in self.replays for fault in r.faults if fault.asks_only)

    @property
    def look_after(self) -> tuple[Fault, ...]:
        """Faults for staff to follow up: open and tolerated ones, and people left alone."""
        return tuple(
            fault
            for replay in self.replays
            for fault in replay.faults
            if fault.status in (OPEN, BORNE)
            or any(move.remedy == SET_ASIDE for move in fault.moves)
        )

    @property
    def seconds(self) -> float:
        """The duration of all games, in the world's own time (s)."""
        return sum(one.seconds for one in self.replays)

    @property
    def staff_pauses(self) -> PauseTotal:
        """When staff paused the games, in all."""
        return PauseTotal.of(replay.staff_pauses for replay in self.replays)

    @property
    def timed(self) -> bool:
        """Whether the log has all durations."""
        return all(replay.timed for replay in self.replays)

    def to_json(self) -> dict[str, Any]:
        """Return the document that `--json` prints, without the words of its notes."""
        return {
            "title": self.title,
            "seconds": self.seconds if self.timed else None,
            "staff_pauses": self.staff_pauses.to_json(),
            "games": [
                {
                    **r.game.to_json(),
                    "seconds": r.seconds if r.timed else None,
                    "staff_pauses": r.staff_pauses.to_json(),
                }
                for r in self.replays
            ],
            "rows": [
                {
                    "stage": row.situation.stage,
                    "request": row.situation.request,
                    "user_state": row.situation.user_state,
                    "behaviour": row.behaviour,
                    "instances": row.instances,
                    "success": row.success,
                }
                for row in self.rows
            ],
            "faults": fault_rows(self.faults),
            "fault_list": [one.document() for one in self.faults],
            "questions": [one.document() for one in self.questions],
            "people": [
                {
                    "id": person.id,
                    "name": person.name,
                    "interactions": person.interactions,
                    "strategies": {s: one.to_json() for s, one in person.strategies.items()},
                }
                for person in self.people
            ],
            "player_facts": [one.to_json() for one in self.player_facts],
            "look_after": [
                {"fault": f.id, "name": f.name, "status": f.status, "advice": list(f.advice)}
                for f in self.look_after
            ],
        }


def read_session(
    store: Store,
    games: Sequence[Game],
    activities: Mapping[str, Activity],
    names: Mapping[str, str],
) -> Session:
    """Build the session of some games from the log.

    Args:
        store: the log.
        games: the games.
        activities: the known activities, by name; a game of another one has fewer details.
        names: people's names, by id.
    """
    replays = tuple(read_replays(store, games, activities, names))
    activity = next((activities[g.activity] for g in games if g.activity in activities), None)
    unknown = sorted({g.activity for g in games if g.activity not in activities})
    notes = [SessionNote("unknown activity", name) for name in unknown]
    if not all(replay.timed for replay in replays):
        notes.append(SessionNote("no times"))
    noted = [m.what for r in replays for m in r.moments if isinstance(m.what, Noted)]
    on_purpose = dict.fromkeys(one.detail for one in noted if one.did in INJECTED)
    if on_purpose:
        notes.append(SessionNote("brought about", "; ".join(on_purpose)))
    titles = {activities[g.activity].title if g.activity in activities else g.activity
              for g in games}  # fmt: skip
    return Session(
        replays=replays,
        title=", ".join(sorted(titles)),
        rows=_rows(replays, activity),
        people=_people(store, replays, activity, names),
        notes=tuple(notes),
        names=names,
        reads=frozenset(s for s in activity.stages if activity.reads(s))
        if activity
        else frozenset(),
        activity=activity,
    )


def _rows(replays: Sequence[GameReplay], activity: Activity | None) -> tuple[TallyRow, ...]:
    done: Counter[tuple[Situation, str]] = Counter()
    right: Counter[tuple[Situation, str]] = Counter()
    for step in (step for replay in replays for step in replay.done):
        done[step.state.situation, step.behaviour] += 1
        right[step.state.situation, step.behaviour] += step.right
    order = (
        activity.situations if activity is not None else tuple(dict.fromkeys(s for s, _ in done))
    )
    rank = {situation: place for place, situation in enumerate(order)}
    return tuple(
        TallyRow(situation, behaviour, count, right[situation, behaviour] / count)
        for (situation, behaviour), count in sorted(
            done.items(), key=lambda item: (rank.get(item[0][0], len(rank)), item[0])
        )
    )


def _people(
    store: Store,
    replays: Sequence[GameReplay],
    activity: Activity | None,
    names: Mapping[str, str],
) -> tuple[Progress, ...]:
    present = tuple(attention(replays))  # without those who were away for all games
    if not present:
        return ()
    said = {a.uuid: a.followed for replay in replays for _, a in replay.answers}
    strategies = activity.strategies if activity is not None else dict.fromkeys(
        a.strategy for replay in replays for _, a in replay.answers
    )  # fmt: skip
    chosen = activity.persuasion if activity is not None else PAPER
    memory = PersonModels(store, tuple(strategies), chosen, world=replays[-1].game.world)
    responses = memory.responses()
    return tuple(
        _progress(
            person,
            names.get(person, person),
            memory.recall(person, responses),
            memory.history(person),
            replays,
            said,
        )
        for person in present
    )


def _progress(
    person: str,
    name: str,
    known: PersonModel,
    history: Sequence[FeedbackEntry],
    replays: Sequence[GameReplay],
    said: Mapping[str, bool | None],
) -> Progress:
    """Count the results of each strategy, and compute the beliefs before and after.

    Corrections made later apply: a response that was voided counts in neither belief.
    """
    games = {replay.game.id for replay in replays}
    first, last = replays[0].game, replays[-1].game
    asked = {entry.request: entry.seq for entry in history if entry.request == entry.uuid}
    before = [e for e in history if asked.get(e.request, e.seq) < first.seq]
    after = [
        e for e in history
        if last.last_seq is None or asked.get(e.request, e.seq) <= last.last_seq or e.game in games
    ]  # fmt: skip
    until = last.ended or max((entry.at for entry in after), default=last.at)
    old = _beliefs(known, person, before, first.at)
    new = _beliefs(known, person, after, until)
    found = {s: Attempts(before=old[s], after=new[s]) for s in known.beliefs}
    for entry in history:
        one = found.get(entry.strategy)
        if entry.game not in games or one is None or entry.settled:
            continue  # another entry has the answer to this request
        if entry.void:
            one.void += 1
        elif entry.complied is None:
            one.awaited += 1
        elif entry.complied:
            one.complied += 1
        elif said.get(entry.uuid):
            one.late += 1
        else:
            one.refused += 1
    return Progress(person, name, found)


def _beliefs(
    known: PersonModel, person: str, entries: Sequence[FeedbackEntry], now: datetime
) -> Beliefs:
    if known.method.forgets:
        return replayed(known.method, known.prior, entries, now)
    counts: dict[tuple[str, str], tuple[int, int]] = {}
    for entry in entries:
        if entry.counts:
            yes, no = counts.get((person, entry.strategy), (0, 0))
            complied = bool(entry.complied)
            counts[person, entry.strategy] = (yes + complied, no + (not complied))
    return counted(known.prior, person, counts)


def _belief(belief: Beta) -> dict[str, Any]:
    return {
        "alpha": belief.alpha,
        "beta": belief.beta,
        "mean": belief.mean,
        "interval": list(belief.interval()),
    }
