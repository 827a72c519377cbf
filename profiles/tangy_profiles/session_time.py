"""The planned time of a session, read from the log.

A session is one run of games, one after the other, for which staff set up once. Its time is that of
the home: pauses and interruptions count, because lunch does not wait.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

from tangy_profiles.game_records import GameBeginning
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store


@dataclass(frozen=True, slots=True)
class SessionTime:
    """When a session began, and until when it was planned; None: without a limit."""

    begins: datetime
    ends: datetime | None = None


def session_times(store: Store, games: Iterable[str]) -> dict[str, SessionTime]:
    """Return the planned time of the session of each of some games, by id, as far as they began.

    The plan of the first game of a session counts, and what staff have planned since. Older
    programs logged the same plan with each game.
    """
    session_of, begun = dict[str, str](), dict[str, SessionTime]()  # a session has its first game
    before = dict[str, GameBeginning]()
    for event in store.events(GameBeginning):
        game, last = event.record, before.get(event.record.activity)
        first = game.game if last is None or not game.follows(last) else session_of[last.game]
        session_of[game.game], before[game.activity] = first, game
        if first == game.game:
            began = datetime.fromisoformat(event.at)
            ends = began + timedelta(minutes=game.minutes) if game.minutes else None
            begun[first] = SessionTime(began, ends)
    wanted = {game: session_of[game] for game in games if game in session_of}
    for noted in store.events(StaffAction) if wanted else ():
        session = session_of.get(noted.record.game)
        if noted.record.did == "time planned" and session is not None:
            begun[session] = SessionTime(begun[session].begins, time_in(noted.record.detail))
    return {game: begun[session] for game, session in wanted.items()}


def time_in(detail: str) -> datetime | None:
    """Return the end that an action `time planned` has in its detail; None: without a limit."""
    with suppress(ValueError):
        return datetime.fromisoformat(detail).astimezone(UTC)
    return None


def session_time(store: Store, game: str) -> SessionTime | None:
    """Return the planned time of the session of a game; None if no such game has begun."""
    return session_times(store, [game]).get(game)
