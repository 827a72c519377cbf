"""What staff chose for their last game, and who sat where, to offer it for the next one."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from datetime import UTC, datetime, timedelta

from tangy_profiles.game_records import GameBeginning, GameChange
from tangy_profiles.game_rules import GamePlan
from tangy_profiles.game_world import BENCH, LIVE
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store

SAME_DAY = timedelta(hours=8)
"""Who was away so long ago may be back."""


def last_plan(store: Store, activity: str, now: datetime | None = None) -> GamePlan | None:
    """Return the plan of the last game of an activity with people or on the bench, None if none.

    It has the pace and the people that staff changed during the game; nobody is absent if that
    game began more than `SAME_DAY` before `now` (default: the present time).
    """
    begun = [
        event
        for event in store.events(GameBeginning)
        if event.record.activity == activity and event.record.world in (BENCH, LIVE)
    ]
    if not begun:
        return None
    last, plan = begun[-1].record, begun[-1].record.plan
    away = set(plan.absent)
    for change in (event.record for event in store.events(GameChange)):
        if change.game != last.game:
            continue
        if change.what == "pace" and change.seconds:
            plan = replace(plan, pace=change.seconds)
        elif change.what == "left":
            away.add(change.person)
        elif change.what in ("came", "joined"):
            away.discard(change.person)
    began = datetime.fromisoformat(begun[-1].at)
    recent = (now or datetime.now(UTC)) - began <= SAME_DAY
    return replace(plan, absent=tuple(sorted(away)) if recent else ())


def seated_as_before(store: Store, people: Iterable[str]) -> list[str]:
    """Sort people (ids) as they sat in the last game with people or on the bench.

    People who came during it have the places that staff gave them, also if it was interrupted
    before it went on with them. People who were not in it come after the others.
    """
    games = [event.record for event in store.events(GameBeginning)]
    last = next((game for game in reversed(games) if game.world in (BENCH, LIVE)), None)
    sat = [] if last is None else list(last.people)
    game = "" if last is None else last.game
    for event in store.events(GameChange, StaffAction):
        place: int | None = None
        match event.record:
            case GameChange(what="joined", person=person, place=place) as new:
                pass
            case StaffAction(did="came", person=person, seat=seat) as new if seat:
                place = seat - 1
            case _:
                continue
        if new.game == game and person not in sat:
            sat.insert(len(sat) if place is None else place, person)
    before = {person: place for place, person in enumerate(sat)}
    return sorted(people, key=lambda person: before.get(person, len(before)))
