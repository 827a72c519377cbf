"""A session: one or more games, as a report presents them, read from the log alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.session_time import SessionTime
from tangy_profiles.staff_records import StaffActionKind
from tangy_profiles.state import Situation
from tangy_profiles.store import Store
from tangy_tui.interaction.tally import TallyRow
from tangy_tui.monitoring.claims import claims_in
from tangy_tui.monitoring.fault import BORNE, OPEN, Diagnosed, Fault
from tangy_tui.monitoring.fault_table import fault_rows
from tangy_tui.monitoring.games import Game
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.people_progress import Progress, people_progress
from tangy_tui.monitoring.played_for import PlayedFor, played_for
from tangy_tui.monitoring.player_facts import PlayerFacts, player_facts
from tangy_tui.monitoring.presence import Stay, stays
from tangy_tui.monitoring.replay import GameReplay, Noted, activities_of, read_replays
from tangy_tui.monitoring.standstills import answer_waits, halts, interruptions

SET_ASIDE = "set aside"
"""The remedy that leaves a person alone: staff should look after them."""


INJECTED: tuple[StaffActionKind | Literal["resumed"], ...] = (
    "fault injected",
    "fault lifted",
    "faults planned",
)
"""Actions after which faults of a session came on purpose."""


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
    """The contents of a session's report; `title` names its activities."""

    replays: tuple[GameReplay, ...]
    title: str
    rows: tuple[TallyRow, ...]
    people: tuple[Progress, ...]
    notes: tuple[SessionNote, ...]
    """Notes for the reader about the sources of the report."""
    names: Mapping[str, str]

    def name(self, person: str) -> str:
        """Return a person's name."""
        return self.names.get(person, person)

    @property
    def player_facts(self) -> list[PlayerFacts]:
        """People's answers and counts, game by game, in an activity by facts."""
        return player_facts(self.replays)

    @property
    def times(self) -> tuple[SessionTime, ...]:
        """The planned times: one for each time that staff set up for games."""
        return tuple(dict.fromkeys(one.session for one in self.replays if one.session is not None))

    @property
    def activities(self) -> tuple[Activity, ...]:
        """The known activities of the games, in order."""
        return activities_of(self.replays)

    @property
    def persuades(self) -> bool:
        """Whether Tangy asks people to do something in one of the games."""
        return any(replay.persuades for replay in self.replays)

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
    def halts(self) -> PauseTotal:
        """When faults halted the robot, in all."""
        return PauseTotal.of(map(halts, self.replays))

    @property
    def answer_waits(self) -> PauseTotal:
        """When games waited for staff to say what to do, in all."""
        return PauseTotal.of(map(answer_waits, self.replays))

    @property
    def set_ups(self) -> PauseTotal:
        """When the robot was set up for people who joined a game, in all."""
        return PauseTotal.of(replay.set_ups for replay in self.replays)

    @property
    def interruptions(self) -> PauseTotal:
        """When games were interrupted and resumed, in all; not part of `seconds`."""
        return PauseTotal.of(map(interruptions, self.replays))

    @property
    def played_for(self) -> tuple[tuple[PlayedFor, ...], ...]:
        """The patterns of each game, with their winners; empty if nobody can win in it."""
        return tuple(map(played_for, self.replays))

    @property
    def stays(self) -> dict[str, tuple[Stay, ...]]:
        """From when to when each person took part, by id."""
        return stays(self.replays)

    @property
    def timed(self) -> bool:
        """Whether the log has all durations."""
        return all(replay.timed for replay in self.replays)

    def to_json(self) -> dict[str, Any]:
        """Return the document that `--json` prints, without the words of its notes."""
        here = self.stays
        return {
            "title": self.title,
            "seconds": self.seconds if self.timed else None,
            "staff_pauses": self.staff_pauses.with_stops(),
            "halts": self.halts.to_json(),
            "answer_waits": self.answer_waits.to_json(),
            "set_ups": self.set_ups.to_json(),
            "interruptions": self.interruptions.to_json(),
            "planned": [
                {"begins": one.begins.isoformat(), "ends": one.ends and one.ends.isoformat()}
                for one in self.times
            ],
            "games": [
                {
                    **r.game.to_json(),
                    "seconds": r.seconds if r.timed else None,
                    "staff_pauses": r.staff_pauses.with_stops(),
                    "halts": halts(r).to_json(),
                    "answer_waits": answer_waits(r).to_json(),
                    "set_ups": r.set_ups.to_json(),
                    "interruptions": interruptions(r).to_json(),
                    "played_for": [one.to_json() for one in played_for(r)],
                    "claims": [one.to_json() for one in claims_in(r)],
                }
                for r in self.replays
            ],
            "rows": [row.to_json() for row in self.rows],
            "faults": fault_rows(self.faults),
            "fault_list": [one.document() for one in self.faults],
            "questions": [one.document() for one in self.questions],
            "people": [
                {**one.to_json(), "present": [stay.to_json() for stay in here.get(one.id, ())]}
                for one in self.people
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
    unknown = sorted({g.activity for g in games if g.activity not in activities})
    notes = [SessionNote("unknown activity", name) for name in unknown]
    if not all(replay.timed for replay in replays):
        notes.append(SessionNote("no times"))
    noted = [m.what for r in replays for m in r.moments if isinstance(m.what, Noted)]
    on_purpose = dict.fromkeys(one.detail for one in noted if one.did in INJECTED)
    if on_purpose:
        notes.append(SessionNote("brought about", "; ".join(on_purpose)))
    titles = dict.fromkeys(replay.title for replay in replays)
    return Session(
        replays=replays,
        title=", ".join(titles),
        rows=_rows(replays),
        people=people_progress(store, replays, names),
        notes=tuple(notes),
        names=names,
    )


def _rows(replays: Sequence[GameReplay]) -> tuple[TallyRow, ...]:
    done: Counter[tuple[Situation, str]] = Counter()
    right: Counter[tuple[Situation, str]] = Counter()
    for step in (step for replay in replays for step in replay.done):
        done[step.state.situation, step.behaviour] += 1
        right[step.state.situation, step.behaviour] += step.right
    known = [situation for one in activities_of(replays) for situation in one.situations]
    order = dict.fromkeys([*known, *(situation for situation, _ in done)])
    rank = {situation: place for place, situation in enumerate(order)}
    return tuple(
        TallyRow(situation, behaviour, count, right[situation, behaviour] / count)
        for (situation, behaviour), count in sorted(
            done.items(), key=lambda item: (rank[item[0][0]], item[0])
        )
    )
