"""Games replayed from the log: observations, behaviours, responses and faults in order."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any, Literal, TypeAlias

from tangy_profiles.activity import Activity
from tangy_profiles.codec import encode
from tangy_profiles.declared.silence import SILENCE
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import (
    AnswerNotClear,
    CallMade,
    ChangeKind,
    FaultDiagnosed,
    FaultMove,
    GameChange,
    GameEnding,
    GameResumed,
    GameStep,
)
from tangy_profiles.past_game import OpenRequests
from tangy_profiles.people_records import ResponseAwaited, ResponseGiven
from tangy_profiles.session_time import SessionTime, session_times
from tangy_profiles.staff_records import StaffAction, StaffActionKind
from tangy_profiles.store import Event, Store
from tangy_tui.monitoring.done import Done as Done
from tangy_tui.monitoring.done import done_of
from tangy_tui.monitoring.fault import Diagnosed, Fault, Moved, fold_faults
from tangy_tui.monitoring.games import Game
from tangy_tui.monitoring.pauses import PauseClock, PauseTotal

IN_GAMES = (
    *(GameStep, ResponseGiven, ResponseAwaited, FaultDiagnosed, FaultMove, StaffAction),
    *(CallMade, GameResumed, GameChange, GameEnding, AnswerNotClear),
)


@dataclass(frozen=True, slots=True)
class AnsweredRequest:
    """A person's response to a request; None if it was not observed."""

    uuid: str
    person: str
    strategy: str
    complied: bool | None
    followed: bool | None
    took: float | None


@dataclass(frozen=True, slots=True)
class Noted:
    """Other actions of people: stops, injected faults, a resumed game (see `StaffAction`)."""

    did: StaffActionKind | Literal["resumed"]
    by: str
    person: str = ""
    detail: str = ""
    taken_back: int = 0
    """The number of a call that no longer counts; 0: none."""
    calls: int = 0
    """How many numbers were called when a claim was made or checked; 0: not known."""


@dataclass(frozen=True, slots=True)
class Unclear:
    """A person's answer was unclear, and was not judged."""

    person: str
    asked_again: bool
    silent: bool = False


OF_ITS_OWN: tuple[ChangeKind, ...] = (
    *("others first", "played on", "won", "claimed"),
    *("visit", "visit put off", "visit over", "calls first", "all called", "nobody won"),
)
"""Changes by the activity's rules; those by staff are logged as staff actions."""

What: TypeAlias = (
    Done | AnsweredRequest | Diagnosed | Moved | Noted | Unclear | CallMade | GameChange
)


@dataclass(frozen=True, slots=True)
class Moment:
    """An event of a game: its time in the game (s), the step before it, and its UTC time."""

    seconds: float
    step: int
    at: str
    what: What

    def to_json(self) -> dict[str, Any]:
        """Return the event as `--json` prints it, with its kind."""
        match self.what:
            case Done() as done:
                return {
                    "kind": "step",
                    "behaviour": done.behaviour,
                    "target": done.target,
                    "strategy": done.strategy,
                    "situation": list(done.state.situation),
                    "state": encode(done.state),
                    "after": encode(done.after),
                    "completed": done.completed,
                    "right": done.right,
                    "teacher": done.teacher,
                    "said": done.said,
                    "took": done.over - done.begun,
                }
            case AnsweredRequest() as answer:
                return {
                    "kind": "response",
                    "person": answer.person,
                    "strategy": answer.strategy,
                    "complied": answer.complied,
                    "followed": answer.followed,
                    "took": answer.took,
                }
            case Diagnosed(fault):
                return {"kind": "fault", **fault.document()}
            case Noted(did, by, person, detail, calls=calls):
                return {
                    "kind": "staff", "what": did, "person": person, "detail": detail, "by": by,
                    **({"calls": calls} if calls else {}),
                }  # fmt: skip
            case Moved(fault, move):
                return {"kind": "recovery", "fault": fault.id, "move": encode(move)}
            case Unclear(person, asked_again):
                return {"kind": "unclear", "person": person, "asked_again": asked_again}
            case CallMade() as made:
                return {"kind": "call", **made.body}
            case GameChange() as change:
                return {"kind": "change", **change.body}


@dataclass
class GameReplay:
    """One game as read from the log.

    `timed`: the log has the duration of each behaviour. Games of older versions do not; their times
    are those of the faults, or 0.
    """

    game: Game
    moments: list[Moment] = field(default_factory=list)
    faults: list[Fault] = field(default_factory=list)
    seconds: float = 0.0
    timed: bool = True
    unasked: set[tuple[int, str]] = field(default_factory=set)
    """Step and person of visits without a request."""
    staff_pauses: PauseTotal = field(default_factory=PauseTotal)
    """When staff paused the game or stopped the robot."""
    set_ups: PauseTotal = field(default_factory=PauseTotal)
    """How often, and for how many s in all, the robot was set up for people who joined."""
    staff_changes: list[Moment] = field(default_factory=list)
    """The changes that `moments` tell as actions of staff, or not at all."""
    activity: Activity | None = None
    """The activity of the game; None if it is unknown."""
    session: SessionTime | None = None
    """The planned time of its session."""

    @property
    def title(self) -> str:
        """The title of its activity, or the activity's name if it is unknown."""
        return self.game.activity if self.activity is None else self.activity.title

    @property
    def persuades(self) -> bool:
        """Whether Tangy asks people to do something in it (True if the activity is unknown)."""
        known = self.activity
        return known is None or any(one.persuades for one in known.behaviours.values())

    @property
    def requests(self) -> dict[int, frozenset[str]]:
        """Who was waiting after each step, by the step's number."""
        open_requests, found = OpenRequests(), dict[int, frozenset[str]]()
        for moment in self.moments:
            if isinstance(moment.what, GameChange):
                open_requests.change(moment.what)
            elif isinstance(done := moment.what, Done):
                called = done.draws and done.completed
                open_requests.step(done.state, done.after, called=called)
                found[done.number] = open_requests.people
        return found

    @property
    def done(self) -> list[Done]:
        """The behaviours that were executed."""
        return [moment.what for moment in self.moments if isinstance(moment.what, Done)]

    @property
    def answers(self) -> list[tuple[Moment, AnsweredRequest]]:
        """People's responses to requests, with their times."""
        return [(m, m.what) for m in self.moments if isinstance(m.what, AnsweredRequest)]

    @property
    def changes(self) -> list[tuple[Moment, GameChange]]:
        """The changes by the activity's rules, with their times."""
        return [(m, m.what) for m in self.moments if isinstance(m.what, GameChange)]

    @property
    def real_faults(self) -> list[Fault]:
        """The faults, without questions about what to do."""
        return [fault for fault in self.faults if not fault.asks_only]


def activities_of(replays: Iterable[GameReplay]) -> tuple[Activity, ...]:
    """Return the known activities of some games, each once, in order."""
    known = (replay.activity for replay in replays)
    return tuple({one.name: one for one in known if one is not None}.values())


def read_replays(
    store: Store,
    games: Sequence[Game],
    activities: Mapping[str, Activity],
    names: Mapping[str, str],
) -> list[GameReplay]:
    """Read games from the log.

    Args:
        store: the log.
        games: the games to read.
        activities: the known activities, by name; a game of another one has fewer details.
        names: people's names by id, for Tangy's speech.
    """
    events: dict[str, list[Event[EventRecord]]] = {game.id: [] for game in games}
    for event in _events(store, games):
        game = getattr(event.record, "game", None)
        if game in events:
            events[game].append(event)
    replays = [_replay(one, events[one.id], activities.get(one.activity), names) for one in games]
    times = session_times(store, events)
    return [replace(one, session=times.get(one.game.id)) for one in replays]


def _events(store: Store, games: Sequence[Game]) -> Iterator[Event[EventRecord]]:
    if not games:
        return
    ends = [game.last_seq for game in games]
    until = max(end for end in ends if end is not None) if None not in ends else None
    for event in store.events(*IN_GAMES, after=min(game.seq for game in games)):
        if until is not None and event.seq > until:
            return
        yield event


def _changes(events: Sequence[Event[EventRecord]]) -> Iterator[GameChange]:
    return (event.record for event in events if isinstance(event.record, GameChange))


def _replay(
    game: Game,
    events: Sequence[Event[EventRecord]],
    activity: Activity | None,
    names: Mapping[str, str],
) -> GameReplay:
    told = (event for event in events if isinstance(event.record, FaultDiagnosed | FaultMove))
    replay = GameReplay(game, faults=fold_faults(told, names), activity=activity)
    faults = {fault.id: fault for fault in replay.faults}
    moved: dict[str, int] = {}  # fault id -> number of its moves so far
    step, acted = 0, 0.0
    done = Counter[str]()  # how often each behaviour was completed so far
    new = {change.person for change in _changes(events) if change.what == "joined"}
    pauses = PauseClock()
    stopped = False  # the robot, by people
    lets_in = ""  # when staff let a person in, for whom the game is resumed at once
    for event in events:
        what: What
        match event.record:
            case GameStep(seconds=took, clock=over) as record:
                step += 1
                replay.timed &= took is not None
                replay.seconds = max(replay.seconds, (over or 0.0) - (took or 0.0))
                begun = replay.seconds
                pauses.step(begun)
                replay.seconds += took or 0.0
                times = done[record.behaviour]
                done[record.behaviour] += record.completed
                what = done_of(
                    record, step, (begun, replay.seconds), activity, names, times, stopped=stopped
                )
            case ResponseGiven(followed=followed, seconds=took):
                what = _answered(event, followed, took)
            case ResponseAwaited():
                what = _answered(event, None, None)
            case GameChange() as what if what.what in OF_ITS_OWN:
                if what.what in ("visit", "won", "claimed"):
                    replay.unasked.add((step + 1, what.person))
            case GameChange() as what:
                at = max(acted, replay.seconds)
                replay.staff_changes.append(Moment(at, step, event.at, what))
                continue
            case GameResumed() if lets_in:
                since = datetime.fromisoformat(event.at) - datetime.fromisoformat(lets_in)
                set_up = PauseTotal(1, max(0.0, since.total_seconds()))
                replay.set_ups = PauseTotal.of((replay.set_ups, set_up))
                lets_in = ""
                continue
            case GameResumed(by=by):
                what = Noted("resumed", by)
                pauses.resumed(max(acted, replay.seconds))
            case StaffAction() as action:
                if action.did == "came" and action.person in new:
                    lets_in = lets_in or event.at
                    new -= {action.person}
                if action.did in ("stopped", "let go on"):
                    stopped = action.did == "stopped"
                if action.did == "ended":
                    _break_off_last(replay.moments)
                # while a step was carried out that comes later
                acted = max(acted, action.seconds or 0.0)
                pauses.did(action.did, max(acted, replay.seconds))
                what = Noted(
                    *(action.did, action.by, action.person, action.detail),
                    taken_back=action.taken_back,
                    calls=action.calls,
                )
            case CallMade() as what:
                pass
            case AnswerNotClear(asked_again=asked_again, source=source):
                what = Unclear(event.person or "", asked_again, silent=source == SILENCE)
            case FaultDiagnosed(fault=id, seconds=at) if id in faults and id not in moved:
                replay.seconds = max(replay.seconds, at)
                moved[id] = 0
                what = Diagnosed(faults[id])
            case FaultMove(fault=id, move=move) if id in moved:
                replay.seconds = max(replay.seconds, move.seconds)
                what = Moved(faults[id], faults[id].moves[moved[id]])
                moved[id] += 1
            case _:  # an ending; a repeated fault; or a move of an unknown fault
                continue
        replay.moments.append(Moment(max(acted, replay.seconds), step, event.at, what))
    replay.seconds = max(acted, replay.seconds)
    replay.staff_pauses = pauses.total(replay.seconds)
    return replay


def _break_off_last(moments: list[Moment]) -> None:
    """Mark the last step as ended by staff if it was not completed, and nothing followed it."""
    if moments and isinstance(last := moments[-1].what, Done) and not last.completed:
        moments[-1] = replace(moments[-1], what=replace(last, ended=not last.stopped))


def _answered(
    event: Event[EventRecord], followed: bool | None, took: float | None
) -> AnsweredRequest:
    person, strategy = event.person or "", event.strategy or ""
    return AnsweredRequest(event.uuid, person, strategy, event.complied, followed, took)
