"""Attention to each person in a game: their requests and waits, and Tangy's visits.

It is derived from the log. Times are in s since the game began.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from tangy_profiles.activity import Activity
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.past_game import OpenRequests
from tangy_tui.monitoring.replay import Done, GameReplay, Noted


def goes_to_people(activity: Activity | None) -> bool:
    """Return whether Tangy visits people in an activity (True for an unknown activity)."""
    if not isinstance(activity, DeclaredActivity):
        return True
    return any(behaviour.visits for behaviour in activity.declaration.behaviours.values())


def visiting(replays: Iterable[GameReplay]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the titles of the activities in which Tangy visits people, and of the others."""
    titles = [(replay.title, goes_to_people(replay.activity)) for replay in replays]
    goes = dict.fromkeys(title for title, visits in titles if visits)
    stays = dict.fromkeys(title for title, visits in titles if not visits)
    return tuple(goes), tuple(stays)


LEAST_WAIT = 1.0
"""Who asked less than so many s before the end of a game did not wait."""


class Wait(NamedTuple):
    """A request for help: how long it was open (s), and whether Tangy came or it was closed."""

    seconds: float
    over: bool = True


@dataclass(slots=True)
class Attention:
    """The attention to one person in one game or several.

    `asked` are the person's requests in order of time. A request that goes over into the next game
    counts in the game in which it ends. `spans` are the begin and end of each wait in s since the
    game began; those of several games are not added up. `seconds` is Tangy's time with the person,
    `helped` counts its behaviours there, and `won` the person's wins.
    `could_visit`: Tangy visits people in that game, or in one of several.
    """

    id: str
    asked: list[Wait] = field(default_factory=list)
    spans: list[tuple[float, float]] = field(default_factory=list)
    visits: int = 0
    seconds: float = 0.0
    last_visit: float | None = None
    helped: Counter[str] = field(default_factory=Counter)
    won: int = 0
    could_visit: bool = True

    @property
    def never_visited(self) -> bool:
        """Whether Tangy could have visited the person, and did not."""
        return self.could_visit and not self.visits

    @property
    def waits(self) -> list[float]:
        """The times (s) from each request until Tangy arrived or the request was closed."""
        return [wait.seconds for wait in self.asked if wait.over]

    @property
    def open(self) -> list[float]:
        """How long (s) each request had been open when the game ended."""
        return [wait.seconds for wait in self.asked if not wait.over]

    @property
    def requests(self) -> int:
        """How often the person asked for help."""
        return len(self.asked)

    def add(self, other: Attention) -> None:
        """Add the same person's attention in another game."""
        self.asked += other.asked
        self.visits += other.visits
        self.seconds += other.seconds
        self.last_visit = other.last_visit if other.last_visit is not None else self.last_visit
        self.helped.update(other.helped)
        self.won += other.won
        self.could_visit = self.could_visit or other.could_visit


@dataclass(frozen=True, slots=True)
class Call:
    """A called number, the time of the call (s), and whether it was taken back."""

    number: int
    seconds: float
    taken_back: bool = False


def attention_in(replay: GameReplay) -> dict[str, Attention]:
    """Return the attention to each person in a game, by id, in the order of the log.

    People who were away for the whole game are left out, unless they had a request or a visit.
    """
    return attention_by_game([replay])[0]


def attention_by_game(replays: Iterable[GameReplay]) -> list[dict[str, Attention]]:
    """Return the attention to each person in each of some games, oldest first."""
    games = list[tuple[GameReplay, dict[str, Attention]]]()
    asked: dict[str, float] = {}  # when the open requests were made, in s since the game began
    for replay in replays:
        before, last = asked, games[-1] if games else None
        asked = {} if last is None else _gone_over(last[0], replay, before)
        if last is not None:
            _leave_open(*last, {who: at for who, at in before.items() if who not in asked})
        games.append((replay, _attend(replay, asked)))
    if games:
        _leave_open(*games[-1], asked)
    for replay, found in games:
        for person in replay.game.away & found.keys():
            if not (found[person].requests or found[person].visits):
                del found[person]
    return [found for _, found in games]


def _gone_over(last: GameReplay, replay: GameReplay, asked: dict[str, float]) -> dict[str, float]:
    """Return the open requests of a game with which the next one begins, in s of the next one.

    In a game of real people, who asked in vain before it still asks in its first step.
    """
    game = replay.game
    between = last.game.seconds_before(game.at, game.world)
    if last.game.ended is None or game.world == SIMULATED or between is None:
        return {}
    asking = set(game.people) - game.away
    if done := replay.done[:1]:
        users = [*done[0].state.users, *done[0].after.users]
        asking = {user.id for user in users if user.request == "AR"}
    over = last.seconds + between
    there = asking & set(game.people)
    return {person: since - over for person, since in asked.items() if person in there}


def _leave_open(replay: GameReplay, found: dict[str, Attention], asked: dict[str, float]) -> None:
    """Record requests that were still open when a game ended."""
    for person, since in asked.items():
        found[person].asked.append(Wait(max(0.0, replay.seconds - since), over=False))


def _attend(replay: GameReplay, asked: dict[str, float]) -> dict[str, Attention]:
    """Return the attention to each person in a game; update the open requests."""
    goes = goes_to_people(replay.activity)
    found = {person: Attention(person, could_visit=goes) for person in replay.game.people}
    sent = set[str]()  # whom Tangy visits unasked, until their request is closed
    requests = replay.requests
    before: Done | None = None
    won = wins(replay)
    for done in replay.done:
        _count_visit(found, done, "" if before is None else before.after.place)
        if done.number in won and done.after.place in found:
            found[done.after.place].won += 1
        waited = frozenset(asked) if before is None else requests[before.number]
        sent |= {who for step, who in replay.unasked if step == done.number and who not in waited}
        if before is not None:
            _count_between(replay, asked, (before, done), waited | sent)
        before, waiting = done, requests[done.number]
        _count_requests(found, asked, done, waiting - sent)
        sent &= waiting
    for person, since in asked.items():
        found[person].spans.append((max(0.0, since), max(since, replay.seconds)))
    return found


def attention(replays: Sequence[GameReplay]) -> dict[str, Attention]:
    """Return the attention to each person, summed over the games of a session.

    A request that did not go over into the next game is over if Tangy came to the person later.
    """
    added: dict[str, Attention] = {}
    for found in attention_by_game(replays):
        for person, one in found.items():
            whole = added.setdefault(person, Attention(person, could_visit=False))
            if one.visits:
                whole.asked = [wait._replace(over=True) for wait in whole.asked]
            whole.add(one)
    return added


def open_at_end(replays: Sequence[GameReplay]) -> dict[str, float]:
    """Return how long (s) each person has waited who still waits when the last game has ended."""
    found = attention_by_game(replays)[-1] if replays else {}
    return {who: max(one.open) for who, one in found.items() if one.open}


def wins(replay: GameReplay) -> set[int]:
    """Return the numbers of the steps that won; a win that is celebrated again counts once."""
    found, celebrated = set[int](), set[str]()
    for moment in replay.moments:
        match moment.what:
            case GameChange(what="played on"):
                celebrated.clear()
            case Done(wins=True) as done if done.after.place not in celebrated:
                celebrated.add(done.after.place)
                found.add(done.number)
            case _:
                pass
    return found


def _count_visit(found: dict[str, Attention], done: Done, before: str) -> None:
    """Count a step for the person the robot was with, and the arrival at a person."""
    there = found.get(done.state.place)
    if there is not None and done.after.place == there.id:
        there.seconds += done.over - done.begun
        if done.target == there.id and done.completed:
            there.helped[done.behaviour] += 1
    came = found.get(done.after.place)
    if came is not None:
        came.visits += done.after.place != before
        came.last_visit = done.over


def _count_between(
    replay: GameReplay, asked: dict[str, float], steps: tuple[Done, Done], waited: frozenset[str]
) -> None:
    """Record requests that began between two steps, as in live games."""
    before, done = steps
    for user in done.state.users:
        waits = user.request == "AR" and done.state.place != user.id
        if waits and user.id in replay.game.people and user.id not in waited | asked.keys():
            asked[user.id] = max(before.over, done.since.get(user.id, done.begun))


def _count_requests(
    found: dict[str, Attention], asked: dict[str, float], done: Done, waiting: frozenset[str]
) -> None:
    """Record new requests, and the waits that ended because Tangy arrived or the request closed."""
    for user in done.after.users:
        if user.id not in found:
            continue
        waits = user.id in waiting and done.after.place != user.id
        closed_at_once = done.after.closed == user.id and user.request == "AR"
        if user.id in asked and (not waits or closed_at_once):
            since = asked.pop(user.id)
            found[user.id].asked.append(Wait(max(0.0, done.over - since)))
            found[user.id].spans.append((max(0.0, since), max(since, done.over)))
        if waits and user.id not in asked and not _is_with(done, user.id):
            asked[user.id] = max(done.begun, done.since.get(user.id, done.over))


def _is_with(done: Done, person: str) -> bool:
    """Return whether the robot left this person while their request was still open."""
    return done.state.place == person and done.after.closed != person


def waiting_at_calls_first(replay: GameReplay) -> list[int]:
    """Return how many people waited each time that calls came before the next visit."""
    requests, found = OpenRequests(), list[int]()
    for moment in replay.moments:
        match moment.what:
            case GameChange() as change:
                if change.what == "calls first":  # somebody waits, or it would not be due
                    found.append(max(1, len(requests.people)))
                requests.change(change)
            case Done() as done:
                called = done.draws and done.completed
                requests.step(done.state, done.after, called=called)
            case _:
                pass
    return found


def calls_in(replay: GameReplay) -> list[Call]:
    """Return the called numbers in order, including those that were taken back."""
    calls: list[Call] = []
    for moment in replay.moments:
        match moment.what:
            case Done(draws=True, completed=True, numbers=numbers, over=over):
                calls += [Call(number, over) for number in numbers]
            case Noted(taken_back=number) if number:
                for place in range(len(calls) - 1, -1, -1):
                    if calls[place].number == number and not calls[place].taken_back:
                        calls[place] = Call(number, calls[place].seconds, taken_back=True)
                        break
    return calls
