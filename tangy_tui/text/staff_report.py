"""Words for what staff did in a game or session, with times and names."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from datetime import datetime, timedelta
from typing import NamedTuple

from tangy_profiles.activity import Activity
from tangy_profiles.contacts import EXPERT
from tangy_profiles.game_records import CallMade, MoveKind
from tangy_profiles.game_world import SIMULATED
from tangy_profiles.staff_records import CLAIM_CHECKS
from tangy_tui.app.card_news import BY as TANGY
from tangy_tui.monitoring.claims import Claim, claims_in
from tangy_tui.monitoring.done import Done
from tangy_tui.monitoring.fault import Moved
from tangy_tui.monitoring.replay import GameReplay, Moment, Noted
from tangy_tui.monitoring.session import Session
from tangy_tui.text.situations import Name
from tangy_tui.text.staff_actions import (
    at_call,
    by_staff,
    card_words,
    chosen_words,
    did_words,
    with_behaviour,
)
from tangy_tui.text.times import time_of_day

STAFF = "What staff did"
STAFF_COLUMNS = ("when", "who", "what")
NO_STAFF = "Staff did not step in."
LATE_CHECK = 5.0
"""The report tells when a claim was checked if that was so much later (s)."""
LONGEST_STEP = 3600.0
"""No behaviour takes longer, in s."""
STAFF_MOVES: Mapping[MoveKind, str] = {
    "acknowledged": "saw",
    "expert called": "called the expert",
    "taught": "said what to do",
    "accepted": "said that all was well",
    "cleared": "cleared it",
    "given up": "ended the game",
}
"""Words for the actions of staff about a fault."""


SHOWN_EXPERT = "saw whom to call"
"""For "expert called", if Tangy called nobody itself."""


def staff_rows(replays: Iterable[GameReplay], name: Name) -> list[tuple[str, str, str]]:
    """Return the actions of staff: local time, who, and what."""
    rows: list[_Act] = []
    for replay in replays:
        for act in sorted(_done_by_staff(replay, name), key=lambda one: one.at):
            before = rows[-1] if rows else act
            same = act.did == before.did and act.who == before.who and act is not before
            if same and act.did == "pace":
                rows[-1] = act  # keys change it step by step: the last one counts
            else:
                rows.append(act)
    return [(time_of_day(one.at.isoformat()), one.who, one.words) for one in rows]


class _Act(NamedTuple):
    """What a member of staff did, and when."""

    at: datetime
    who: str
    words: str
    did: str = ""


def _done_by_staff(replay: GameReplay, name: Name) -> Iterator[_Act]:
    """Yield what staff did in a game; a claim counts when it was made, with what came of it."""
    for claim in claims_in(replay):
        if claim.by and claim.by != TANGY:
            yield _Act(datetime.fromisoformat(claim.at), claim.by, claim_words(claim, name))
    calls = (moment.what for moment in replay.moments)
    called = {call.fault for call in calls if isinstance(call, CallMade) and call.role == EXPERT}
    answered = ("", "")  # the answer that the next behaviour carries out, and for whom
    for moment in replay.moments:
        what, at = moment.what, datetime.fromisoformat(moment.at)
        if (told := _staff_words(moment, replay.activity, name, called)) is not None:
            act = _Act(at, *told)
            if isinstance(what, Noted):
                act = act._replace(did=what.did)
            yield act
        if isinstance(what, Moved) and what.move.answer:
            answered = (what.move.answer, what.move.target)
        elif isinstance(what, Noted) and what.did == "answered":
            answered = (what.detail, what.person)
        elif isinstance(what, Done) and what.teacher:
            whom = what.target or ""
            if answered != (what.behaviour, whom):  # after staff took over, in an older log
                words = chosen_words(replay.activity, what.behaviour, whom, name)
                yield _Act(at - _lasted(what, replay), what.teacher, words)
            answered = ("", "")


def _lasted(done: Done, replay: GameReplay) -> timedelta:
    """Return how long a behaviour took by the time of day; zero if the log cannot tell."""
    seconds = done.over - done.begun
    real = replay.game.world != SIMULATED and 0.0 <= seconds <= LONGEST_STEP
    return timedelta(seconds=seconds if real else 0.0)


def _staff_words(
    moment: Moment, activity: Activity | None, name: Name, called: Container[str]
) -> tuple[str, str] | None:
    """Return who of the staff did what; `called` are the faults with a call to the expert."""
    what = moment.what
    if isinstance(what, Noted):
        if what.did in ("claim made", *CLAIM_CHECKS):
            return None  # told as one claim
        return (
            (what.by, did_words(with_behaviour(what, activity), name)) if by_staff(what) else None
        )
    if not isinstance(what, Moved) or not what.move.by or what.move.kind not in STAFF_MOVES:
        return None
    move, fault = what.move, what.fault
    if move.kind == "expert called" and fault.id not in called:
        return move.by, f"{SHOWN_EXPERT}: {fault.name}"
    if move.answer:
        return move.by, chosen_words(activity, move.answer, move.target, name)
    return move.by, f"{STAFF_MOVES[move.kind]}: {fault.name}"


def claim_words(claim: Claim, name: Name) -> str:
    """Tell whose card staff had checked, at which call, and what came of it."""
    card = card_words(claim.card, name(claim.person) if claim.person else "")
    when = at_call(claim.calls)
    match claim.result:
        case "claim right":
            told = f"had {card} checked{when}: it wins"
        case "claim late":
            told = f"had {card} checked{when}: it wins, too, but another card was first"
        case "claim wrong":
            told = f"had {card} checked{when}: it does not win yet"
        case _:
            return f"asked Tangy to check {card}{when}; it was not checked"
    made, checked = map(datetime.fromisoformat, (claim.at, claim.checked_at))
    late = (checked - made).total_seconds() >= LATE_CHECK
    return f"{told} (Tangy checked it at {time_of_day(claim.checked_at)})" if late else told


def staff_action_lines(session: Session) -> Iterator[str]:
    """List what staff did, with times and names."""
    rows = staff_rows(session.replays, session.name)
    yield f"{STAFF}:" if rows else NO_STAFF
    yield from (f"  {when}  {who}: {what}" for when, who, what in rows)
