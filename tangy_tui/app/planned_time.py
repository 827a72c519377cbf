"""The planned time of the session that a controller runs, and staff's changes of it."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

from tangy_profiles.errors import TangyError
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.past_game import PastGame
from tangy_profiles.session_time import SessionTime, session_time
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import PlanTime
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.monitoring.supervision import Supervision

HALF_DAY = timedelta(hours=12)
SOON = timedelta(hours=6)
"""Staff who name a time of day that is over mean the afternoon or tomorrow, if it is that soon."""


class PlannedTime:
    """Reads the planned time of the session from the log, and logs what staff plan anew."""

    def __init__(self, supervision: Supervision, past: PastGame | None, by: str) -> None:
        """Read the time of a supervision's games, or of the game that it resumes first."""
        self._supervision, self._store, self._by = supervision, supervision.store, by
        self._resumes = "" if past is None else past.beginning.game
        self._times = dict[str, SessionTime]()  # by game

    @property
    def _game(self) -> str:
        return self._supervision.game.game or self._resumes

    @property
    def now(self) -> SessionTime | None:
        """The planned time; None before the first game."""
        game, times = self._game, self._times  # another thread may plan, and begin new ones
        if game and game not in times and (found := session_time(self._store, game)) is not None:
            times[game] = found
        return times.get(game)

    @property
    def ends(self) -> datetime | None:
        """When the planned time is over; None: there is no limit, or no game has begun."""
        return None if (time := self.now) is None else time.ends

    def clock(self) -> datetime:
        """Return the time by the clock of the log, which the planned time is compared with."""
        return self._store.now()

    @property
    def left(self) -> float | None:
        """The time left in s, negative once it is over; None: there is no limit."""
        return None if (ends := self.ends) is None else (ends - self.clock()).total_seconds()

    def plan(self, command: PlanTime) -> StaffNote:
        """Plan the time anew, from now on; raises TangyError if that cannot be."""
        if (time := self.now) is None:
            return StaffNote("no game")
        if self._supervision.world.played_in == SIMULATED:
            return StaffNote("not in a simulation")
        now = self.clock()
        ends = planned_end(command, now, time.ends)
        self.end_at(ends)
        if ends is None:
            return StaffNote("time planned")
        minutes = round((ends - now).total_seconds() / 60)
        return StaffNote("time planned", ends.isoformat(), str(minutes))

    def end_at(self, ends: datetime | None) -> None:
        """Log until when staff plan the session; None: without a limit."""
        game = self._supervision.game
        until = "" if ends is None else ends.astimezone(UTC).isoformat(timespec="seconds")
        at = None if self._supervision.over else game.log.seconds
        self._store.append(
            StaffAction(game=self._game, did="time planned", by=self._by, detail=until, seconds=at)
        )
        self._times = {}


def planned_end(command: PlanTime, now: datetime, before: datetime | None) -> datetime | None:
    """Return when the time is over that staff plan; None: without a limit.

    Args:
        command: what staff said.
        now: the present time.
        before: when the time planned before is over; None: there is none.

    Raises:
        TangyError: that time has passed.
    """
    if command.until is not None:
        local = now.astimezone()
        if (ends := _next(command.until, local)) is None:
            raise TangyError(f"It is {local:%H:%M} already. Plan a later time.")
        return ends
    if not command.minutes:
        return None
    begins = max(now, before or now) if command.more else now
    return begins + timedelta(minutes=command.minutes)


def _next(time: tuple[int, int], now: datetime) -> datetime | None:
    """Return when it is some time of day next, in which 3:30 may be in the afternoon; None: it was.

    Args:
        time: the hour and the minute.
        now: the local time.
    """
    hour, minute = time
    ends = now.replace(hour=hour, minute=minute, second=0, microsecond=0)
    if ends > now:
        return ends
    later = [ends + timedelta(days=1)]
    if 1 <= hour < 12:
        later.insert(0, ends + HALF_DAY)
    return next((one for one in later if timedelta(0) < one - now <= SOON), None)
