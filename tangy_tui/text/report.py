"""Words of the session report for staff: people, waits, calls, actions of staff."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from datetime import datetime
from statistics import median_low
from typing import TYPE_CHECKING

from tangy_profiles.activity import Activity
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import SIMULATED
from tangy_tui.monitoring.attention import (
    LEAST_WAIT,
    Attention,
    Call,
    Wait,
    attention,
    calls_in,
    open_at_end,
    visiting,
    waiting_at_calls_first,
)
from tangy_tui.monitoring.claims import claims_in
from tangy_tui.monitoring.fault import Fault
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.played_for import wins_of
from tangy_tui.monitoring.presence import stays
from tangy_tui.monitoring.replay import AnsweredRequest, GameReplay, Moment
from tangy_tui.monitoring.session import Session
from tangy_tui.text.changes import changed_words, pattern_words
from tangy_tui.text.fault_moves import move_words
from tangy_tui.text.numbers import counted, listed, often
from tangy_tui.text.planned_time import planned_until_words
from tangy_tui.text.situations import SOMEBODY, Name
from tangy_tui.text.taking_part import with_card_words
from tangy_tui.text.times import length, time_of_day

if TYPE_CHECKING:
    from tangy_tui.monitoring.games import Game

PEOPLE = "Who got what"
CALLED = "Numbers that were called"
TAKEN_BACK, BACK = "crossed out: taken back", "taken back"
FAULTS_SHORT = "What went wrong"
FAULT_COLUMNS = ("when", "what", "what came of it")
NOT_REACHED = "not reached"
ASKED_LAST = "asked as the game ended"
WAITING = "Still waiting at the end"
IN_VAIN = "Asked in an earlier game, and Tangy did not come"
LONG = "Waited long for help"
FEW_WAITS = 3
"""Up to so many waits are told one by one."""
LONG_WAIT = 270.0
"""A longer wait (s) is told as 5 minutes or more, and needs attention."""


SET_UP = "in which Tangy set itself up for somebody new"
GAME_TIME = "of game time (a simulated game runs faster)"
MOST_NAMED = 5
"""The most people that one line of what to look after names, if there are more."""
LEAST_LEFT = 3
"""So many people are counted instead of named; fewer are named."""


def how_long_words(session: Session) -> str:
    """Tell how long the games lasted, were paused, halted by faults, and interrupted."""
    pauses, halts, breaks = session.staff_pauses, session.halts, session.interruptions
    asked, set_ups = session.answer_waits, session.set_ups
    part = [
        f"{length(pauses.seconds)} in {_pauses_words(pauses)}" if pauses.seconds >= 1 else "",
        f"{length(halts.seconds)} in which a fault stopped Tangy" if halts.seconds >= 1 else "",
        f"{length(asked.seconds)} in which Tangy waited for an answer of staff"
        if asked.seconds >= 1
        else "",
        f"{length(set_ups.seconds)} {SET_UP}" if set_ups.seconds >= 1 else "",
    ]
    words = listed(filter(None, part))
    simulated = all(replay.game.world == SIMULATED for replay in session.replays)
    game_time = f" {GAME_TIME}" if simulated and session.replays else ""
    told = f"{length(session.seconds)}{game_time}{f', of which {words}' if words else ''}"
    planned = planned_until_words(session.times)
    return f"{told}{_interrupted_words(breaks)}{f'; {planned}' if planned else ''}"


def _pauses_words(pauses: PauseTotal) -> str:
    """Count the pauses, and the times that people stopped the robot."""
    paused, stops = pauses.count - pauses.stops, pauses.stops
    words = [counted(paused, "pause") if paused else "", counted(stops, "STOP") if stops else ""]
    return listed(filter(None, words))


def _interrupted_words(breaks: PauseTotal) -> str:
    if not breaks.count:
        return ""
    return f"; interrupted {often(breaks.count)}, for another {length(breaks.seconds)}"


def asked_words(one: Attention) -> str:
    """Tell how often a person asked for help."""
    return often(one.requests) if one.requests else "no"


def waited_words(one: Attention) -> str:
    """Tell how long a person waited: each of a few waits in order, or what half of many took."""
    if not one.requests:
        return "\N{EN DASH}"
    if one.requests <= FEW_WAITS:  # "and" would make one time of two
        return ", then ".join(map(_wait_words, one.asked))
    more = f"; {often(len(one.open))} {NOT_REACHED}" if one.open else ""
    return usual_words([wait.seconds for wait in one.asked]) + more


def _wait_words(wait: Wait) -> str:
    """Tell how long a person waited, and whether in vain, unless the game ended just then."""
    if wait.over:
        return length(wait.seconds)
    return f"{length(wait.seconds)} ({NOT_REACHED})" if wait.seconds >= LEAST_WAIT else ASKED_LAST


def usual_words(waits: Sequence[float]) -> str:
    """Tell within which time (s) half of many waits were over, and the longest one."""
    half, most = length(median_low(waits)), length(max(waits))
    return half if half == most else f"half within {half}, at most {most}"


def visits_words(one: Attention) -> str:
    """Tell how often Tangy visited a person; a dash if Tangy visits nobody in the activity."""
    return "never" if one.never_visited else str(one.visits or "\N{EN DASH}")


def time_words(one: Attention) -> str:
    """Tell how long Tangy was with a person."""
    return length(one.seconds) if one.seconds else "\N{EN DASH}"


def helped_words(one: Attention, activities: Iterable[Activity]) -> str:
    """Tell what Tangy did with a person, and how often."""
    known = {b: a.behaviour_words(b) for a in activities for b in a.behaviours}
    parts = []
    for behaviour, times in one.helped.items():
        words = SOMEBODY.sub("them", known.get(behaviour, behaviour), count=1)
        parts.append(words if times == 1 else f"{words} ({times})")
    return ", ".join(parts) or "\N{EN DASH}"


def response_words(answers: Sequence[AnsweredRequest]) -> str:
    """Tell how often a person complied: "3 of 5, 1 late, 1 not known"."""
    if not answers:
        return "\N{EN DASH}"
    known = [one for one in answers if one.complied is not None]
    in_time = sum(bool(one.complied) for one in known)
    late = sum(bool(one.followed) and not one.complied for one in known)
    unknown = len(answers) - len(known)
    words = (
        f"{in_time} of {len(known)}" if known else "",
        f"{late} late" if late else "",
        f"{unknown} not known" if unknown else "",
    )
    return ", ".join(filter(None, words))


def people_table(session: Session) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Return the columns and rows of the table of people.

    What none of the activities has is left out: visits, requests to do something, or winners.
    """
    people = attention(session.replays).values()
    answers = [answer for replay in session.replays for _, answer in replay.answers]
    known, unknown = session.activities, any(r.activity is None for r in session.replays)
    visits = any(one.could_visit for one in people)
    wins = unknown or any(b.needs for one in known for b in one.behaviours.values())
    columns: list[tuple[str, Callable[[Attention], str]]] = [
        ("person", lambda one: session.name(one.id)),
        ("asked for help", asked_words),
        ("waited", waited_words),
    ]
    if visits:
        columns += [
            ("visits", visits_words),
            ("time with Tangy", time_words),
            ("help given", lambda one: helped_words(one, known)),
        ]
    if session.persuades:
        columns += [
            ("did as asked", lambda o: response_words([a for a in answers if a.person == o.id]))
        ]
    if wins:
        columns += [("won", lambda one: str(one.won or ""))]
    rows = [tuple(words(one) for _, words in columns) for one in people]
    return tuple(name for name, _ in columns), rows


def visiting_words(replays: Iterable[GameReplay]) -> str:
    """Tell in which of several activities Tangy goes to people; "" if that is the same in all."""
    goes, stays = visiting(replays)
    if not goes or not stays:
        return ""
    return f"Tangy goes to people only in {listed(goes)}, not in {listed(stays)}."


def care_lines(
    found: Iterable[Attention], name: Name, replays: Sequence[GameReplay] = ()
) -> list[str]:
    """Name the people who need attention: still waiting, after a long wait, or never visited.

    People still wait only if they did at the end of the last game. Requests of earlier games are
    told apart if Tangy did not come to the person after them.

    Args:
        found: the attention to each person.
        name: returns people's names.
        replays: the games, to name those in which Tangy goes to people.
    """
    people = list(found)
    lines = []
    if never := [name(one.id) for one in people if one.never_visited]:
        goes, stays = visiting(replays)
        where = f" in {listed(goes)} (in {listed(stays)} it goes to nobody)" if stays else ""
        lines.append(f"Tangy never went to {some_of(never)}{where}.")
    at_end = open_at_end(replays) if len(replays) > 1 else None
    told = [(_care_of(one, at_end), name(one.id)) for one in people]
    for what in (WAITING, IN_VAIN, LONG):
        groups = dict[str, list[str]]()
        for wait, who in sorted(
            ((w, who) for (w, kind), who in told if kind == what), key=_longest
        ):
            groups.setdefault(length(wait), []).append(who)
        if groups:
            lines.append(f"{what}: {_waits_words(groups)}.")
    return lines


def _longest(told: tuple[float, str]) -> float:
    return -told[0]


def _care_of(one: Attention, at_end: Mapping[str, float] | None) -> tuple[float, str]:
    """Return a person's wait (s) that needs attention, and of which kind it is, "" if none."""
    in_vain, longest = max(one.open, default=0.0), max(one.asked, default=Wait(0.0)).seconds
    still = in_vain if at_end is None else at_end.get(one.id, 0.0)
    if still >= LEAST_WAIT:
        return still, WAITING
    if in_vain >= LEAST_WAIT:
        return in_vain, IN_VAIN
    return longest, LONG if longest > LONG_WAIT else ""


def some_of(names: Sequence[str]) -> str:
    """Name a few people, and count the others: a report names all of them further below."""
    left = len(names) - MOST_NAMED
    return listed(names if left < LEAST_LEFT else [*names[:MOST_NAMED], counted(left, "other")])


def _waits_words(groups: Mapping[str, Sequence[str]]) -> str:
    """Tell who waited how long, the longest waits first, and count the others if they are many."""
    each, left = list[str](), sum(map(len, groups.values()))
    most = left if left < MOST_NAMED + LEAST_LEFT else MOST_NAMED
    for wait, names in groups.items():
        if most > 0:
            each.append(f"{listed(names[:most])}, {wait}")
            left -= len(names[:most])
            most -= len(names)
    return "; ".join([*each, *([counted(left, "other")] if left else [])])


def quiet_words(names: Sequence[str]) -> str:
    """Name the people whom Tangy did not ask to do anything."""
    return f"Tangy did not ask these people to do anything: {', '.join(names)}."


def attention_lines(
    found: Iterable[Attention], name: Name, replays: Sequence[GameReplay] = ()
) -> list[str]:
    """Tell how long those who asked for help waited and had Tangy with them."""
    people = list(found)
    lines, asked = list[str](), [_asked_line(one, name) for one in people if one.requests]
    where = visiting_words(replays)
    if asked:
        lines += ["Asked for help:", *asked, *([f"  {where}"] if where else [])]
    never = [name(one.id) for one in people if one.never_visited]
    if len(never) >= MOST_NAMED + LEAST_LEFT:  # the line of what to look after names a few
        lines.append(f"Never visited: {', '.join(never)}.")
    return lines


def _asked_line(one: Attention, name: Name) -> str:
    told = f"  {name(one.id)} {often(one.requests)}, waited: {waited_words(one)}"
    if not one.could_visit:
        return told
    visited = f"{counted(one.visits, 'visit')}, {length(one.seconds)} in all"
    return f"{told}; {visited if one.visits else 'never visited'}"


def changes_lines(replays: Iterable[GameReplay], name: Name) -> list[str]:
    """Tell who won early, whom Tangy visited unasked, and how often calls came first."""
    games = list(replays)
    changes = [one for replay in games for one in replay.changes]
    lines = [
        f"At {time_of_day(moment.at)} {_change_words(replay, moment, change, name)}"
        f"{_left_words(replay, moment, change, name)}"
        for replay in games
        for moment, change in replay.changes
        if change.what in ("played on", "others first", "all called", "nobody won")
    ]
    visits = Counter(name(change.person) for _, change in changes if change.what == "visit")
    visits -= Counter(
        name(change.person) for _, change in changes if change.what == "visit put off"
    )
    if visits:
        each = [who if n == 1 else f"{who} ({often(n)})" for who, n in visits.items()]
        lines.append(f"Tangy visited {listed(each)} although they had not asked.")
    if waited := [count for replay in games for count in waiting_at_calls_first(replay)]:
        lines.append(_calls_first_words(waited))
    return lines


def _change_words(replay: GameReplay, moment: Moment, change: GameChange, name: Name) -> str:
    """Describe a change, and the card of a win."""
    told, won = changed_words(change, None, name), f"{name(change.person)} has won"
    before = [one for one in wins_of(replay, change.person) if one[1].at <= moment.at]
    if not before or not told.startswith(won):
        return told
    pattern, win = before[-1]
    what = f" ({pattern_words(replay.activity, (pattern,))})" if pattern else ""
    return f"{won}{what}{with_card_words(replay, win)}{told.removeprefix(won)}"


def _calls_first_words(waited: Sequence[int]) -> str:
    """Tell how often calls came first, and how many people waited then."""
    least, most = min(waited), max(waited)
    who = counted(most, "person", "people")
    who = who if least == most else f"{least} to {who}"
    return f"{often(len(waited)).capitalize()}, Tangy called some numbers first while {who} waited."


def _left_words(replay: GameReplay, won: Moment, change: GameChange, name: Name) -> str:
    """Tell how a person won who had left: staff had a card checked."""
    if change.what not in ("played on", "others first"):
        return ""
    there = stays([replay]).get(change.person, ())
    if not there or any(stay.at(datetime.fromisoformat(won.at)) for stay in there):
        return ""
    who = name(change.person)
    for claim in reversed(claims_in(replay)):
        if claim.person != change.person or claim.result != "claim right":
            continue
        if claim.checked_at > won.at:
            continue
        if any(stay.at(datetime.fromisoformat(claim.at)) for stay in there):
            made = time_of_day(claim.at)
            return f" {who} left after the claim with card {claim.card} at {made}."
        return f" {who} had left before. Staff had {who}'s card {claim.card} checked."
    return f" {who} had left before."


def fault_outcome(fault: Fault, status: str) -> str:
    """Describe how a fault ended: the last move, and its status."""
    told = [move_words(move) for move in fault.moves][-1:]
    if told and status in told[0]:
        return told[0]
    return "; ".join([*told, status])


def call_rows(session: Session) -> list[tuple[Game, list[tuple[str, bool]]]]:
    """Return the calls of each game that has any: each label, and whether it was taken back."""
    rows = [(replay, calls_in(replay)) for replay in session.replays]
    return [(replay.game, call_labels(calls, replay.activity)) for replay, calls in rows if calls]


def call_lines(session: Session) -> Iterator[str]:
    """List the calls of each game in order."""
    rows = call_rows(session)
    if rows:
        yield f"{CALLED}:"
    for game, labels in rows:
        which = f"game {game.number}: " if len(session.replays) > 1 else ""
        called = [f"{label} ({BACK})" if taken else label for label, taken in labels]
        yield f"  {which}{', '.join(called)}"


def call_labels(calls: Sequence[Call], activity: Activity | None) -> list[tuple[str, bool]]:
    """Return the label of each call, and whether it was taken back."""
    label = str if activity is None else activity.deck.label
    return [(label(call.number), call.taken_back) for call in calls]
