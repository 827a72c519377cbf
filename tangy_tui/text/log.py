"""Games of the log in lines: one step by step, and a summary of a session."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.game_records import CallMade, GameChange
from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.monitoring.fault_table import fault_rows
from tangy_tui.monitoring.games import Game
from tangy_tui.monitoring.replay import AnsweredRequest, Done, GameReplay, Moment, Noted, Unclear
from tangy_tui.monitoring.session import Session
from tangy_tui.text.calls import logged_words
from tangy_tui.text.changes import changed_words
from tangy_tui.text.endings import TO_ITS_END, ending_sentence
from tangy_tui.text.fault_moves import RECOVERY_WORDS, move_words
from tangy_tui.text.numbers import counted, of_times, often
from tangy_tui.text.player_facts import (
    HEADING,
    in_game_words,
    look_after_lines,
    player_lines,
)
from tangy_tui.text.report import (
    FAULTS_SHORT,
    attention_lines,
    call_lines,
    care_lines,
    changes_lines,
    fault_outcome,
    how_long_words,
    quiet_words,
)
from tangy_tui.text.results import progress_line, response_line
from tangy_tui.text.session_page import CARE, HOW_LONG, NOBODY_NAMED, RESPONDED
from tangy_tui.text.sessions import note_words, status_words
from tangy_tui.text.staff_actions import action_line, chosen_words, with_behaviour
from tangy_tui.text.staff_report import staff_action_lines
from tangy_tui.text.steps import step_sentence, unfinished_words
from tangy_tui.text.taking_part import played_for_rows, took_part, with_stay
from tangy_tui.text.times import clock, day_and_time, time_of_day
from tangy_tui.text.worlds import WORLDS_IN_REPORTS

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.text.situations import Name

MOST_TOLD = 30
"""A report describes up to this many games one by one; of more, only those with problems."""


def game_words(game: Game, activity: Activity | None = None) -> str:
    """Name a game: number, id, activity (by its title, if given), world, policy, and so on."""
    known = activity is not None and activity.name == game.activity
    played = activity.title if activity is not None and known else game.activity
    return (
        f"Game {game.number} ({game.id}), {played}, {game.world}, policy {game.policy}, "
        f"{day_and_time(game.at)}"
    )


def staff_game_words(game: Game, activity: Activity | None) -> str:
    """Name a game for staff: number, activity, time, and where it was played."""
    played = game.activity if activity is None else activity.title
    return f"Game {game.number}: {played}, {day_and_time(game.at)}, {WORLDS_IN_REPORTS[game.world]}"


def replay_lines(replay: GameReplay, activity: Activity | None, name: Name) -> Iterator[str]:
    """Describe a game step by step; each line begins with time in the game and local time."""
    game = replay.game
    yield game_words(game, activity)
    yield f"With {', '.join(map(name, game.people)) or 'nobody that the log names'}."
    if not replay.timed:
        yield "An older Tangy kept no times within a game: what is given is the time of day alone."
    for moment in replay.moments:
        yield from moment_lines(moment, replay.timed, activity, name, ways=True)
    yield f"{counted(game.steps, 'step')}. {ending_sentence(game)}"


def moment_lines(
    moment: Moment, timed: bool, activity: Activity | None, name: Name, *, ways: bool = False
) -> Iterator[str]:
    """Describe one moment of a game, with the time in the game if `timed`, and local time.

    `ways`: name the ways of asking, which staff do not need.
    """
    when = _when(moment, timed)
    first, *more = told_lines(moment, activity, name, ways=ways)
    yield f"{when}  {first}"
    for line in more:
        yield f"{' ' * len(when)}  {line}"


def _when(moment: Moment, timed: bool) -> str:
    at = time_of_day(moment.at)
    return f"{clock(moment.seconds):>7} {at}" if timed else at


def told_lines(
    moment: Moment, activity: Activity | None, name: Name, *, ways: bool = False
) -> list[str]:
    """Describe one moment of a game without its time; what is not indented has a mark.

    `ways`: see `moment_lines`.
    """
    match moment.what:
        case Done() as done:
            return _done_lines(done, activity, name, ways=ways)
        case AnsweredRequest() as answer:
            way = f" ({answer.strategy})" if ways else ""
            return [f"   {name(answer.person)} {answer_words(answer)}{way}."]
        case Diagnosed(fault):
            if fault.asks_only:
                return ["?  Tangy does not know what to do here."]
            kind = "CRITICAL" if fault.critical else "non-critical"
            return [
                f"!  Fault, {kind}: {fault.name}. {fault.console}",
                f"   Why: {fault.why}.",
            ]
        case Noted() as noted:
            return [f"*  {action_line(with_behaviour(noted, activity), name)}"]
        case Unclear(person, asked_again, silent):
            again = ": Tangy asks again" if asked_again else ", and Tangy has asked often enough"
            did = "said nothing" if silent else "did not answer clearly"
            return [f"*  {name(person)} {did}{again}."]
        case CallMade(role=role, way=way, stage=stage, said=said_then):
            return [f"*  {logged_words(role, way, stage, said_then)}"]
        case GameChange() as change:
            return [f"*  {changed_words(change, activity, name)}"]
        case Moved(fault, move):
            said = [f"   Tangy says: {move.speech}"] if move.speech else []
            whose = "" if fault.asks_only else f"{fault.name}: "
            if move.answer:
                words = chosen_words(activity, move.answer, move.target, name)
                return [f"   {whose}{move.by} {words}.", *said]
            return [f"   {whose}{move_words(move)}.", *said]


def _done_lines(done: Done, activity: Activity | None, name: Name, *, ways: bool) -> list[str]:
    step = step_sentence(
        activity, done.state, done.behaviour, done.target, name,
        strategy=done.strategy if ways else "", teacher=done.teacher,
    )  # fmt: skip
    lines = [step]
    if done.said:
        lines.append(f"   Tangy says: {done.said}")
    if not done.completed:
        lines.append(f"   {unfinished_words(stopped=done.stopped, ended=done.ended)}")
    elif not done.right and not done.teacher:
        lines.append("   That is not what the activity expects here.")
    return lines


def answer_words(answer: AnsweredRequest) -> str:
    """Tell a person's response to a request."""
    if answer.complied is None:
        return "was asked; what they did was not known yet"
    if answer.complied:
        return "did it"
    return "did it a little late" if answer.followed else "would rather not just then"


def session_lines(session: Session, *, full: bool = True) -> Iterator[str]:
    """Summarise a session: games, faults, people, and what needs attention.

    Args:
        session: the session.
        full: whether to add the details for researchers: ids, policies, steps, expectations.
    """
    yield from _games_lines(session.replays, full=full)
    if session.timed:
        yield f"{HOW_LONG}: {how_long_words(session)}."
    yield f"Took part: {took_part(session) or NOBODY_NAMED}."
    yield from (f"{what}: {words}." for what, words in played_for_rows(session))
    yield ""
    yield from care_part(session)
    yield ""
    yield from changes_lines(session.replays, session.name)
    found = attention(session.replays).values()
    yield from attention_lines(found, session.name, session.replays)
    replays = {replay.game.id: replay for replay in session.replays}
    for facts in session.player_facts:
        yield f"{HEADING}{in_game_words(replays, facts)}:"
        yield from player_lines(facts, session.name)
    yield from call_lines(session)
    yield from staff_action_lines(session)
    yield ""
    yield from _fault_lines(session) if full else staff_fault_lines(session)
    yield ""
    asked = [person for person in session.people if person.interactions]
    if full:
        yield from map(progress_line, asked)
    elif asked:
        yield f"{RESPONDED}:"
        yield from (f"  {response_line(person, session.activities)}" for person in asked)
    if session.persuades and (quiet := [p.name for p in session.people if not p.interactions]):
        yield quiet_words(quiet)
    yield from limits_lines([r.game for r in session.replays if r.persuades], full=full)
    yield from map(note_words, session.notes)


def _fault_lines(session: Session) -> Iterator[str]:
    """List the faults with their steps, and how often each kind of recovery worked."""
    yield f"{counted(len(session.faults), 'fault')}:" if session.faults else "No faults."
    numbers = {game.id: game.number for game in session.games}
    for number, fault in enumerate(session.faults, 1):
        kind = "CRITICAL, " if fault.critical else ""
        where = f"game {numbers[fault.game]}, " if len(numbers) > 1 else ""
        yield (
            f"  {number}. {where}{clock(fault.seconds)}, step {fault.step}: {fault.name} "
            f"({kind}{status_words(fault.status)})"
        )
    for row in fault_rows(session.faults):
        if row["instances"]:
            worked = round(row["success"] * row["instances"])
            yield (
                f"  {row['criticality']}, first recovery “{RECOVERY_WORDS[row['recovery']]}”: "
                f"it worked {of_times(worked, row['instances'])}"
            )


def staff_fault_lines(session: Session) -> Iterator[str]:
    """List the faults for staff: when, what, and how each ended."""
    yield f"{FAULTS_SHORT}:" if session.faults else "No faults."
    for at, fault in session.timed_faults:
        outcome = fault_outcome(fault, status_words(fault.status))
        yield f"  {time_of_day(at)}  {fault.name}: {outcome}"


def care_part(session: Session) -> Iterator[str]:
    """Tell what staff should look after: people, and faults that are not over."""
    people = attention(session.replays).values()
    told = look_after_lines(session.player_facts, session.name)
    told += care_lines(people, lambda one: with_stay(session, one), session.replays)
    if not told and not session.look_after:
        yield f"{CARE}: nothing."
        return
    yield f"{CARE}:"
    yield from (f"  {line}" for line in told)
    for console, advice in dict.fromkeys((one.console, one.advice) for one in session.look_after):
        yield f"  {console}"
        yield from (f"    - {step}" for step in advice)


def limits_lines(games: Sequence[Game], *, full: bool = True) -> Iterator[str]:
    """Tell the limits of requests in vain; if `full`, also how often a robot waited for data."""
    limits = dict.fromkeys(game.asks for game in games if game.asks != (0, 0))
    for visit, most in limits:
        yield (
            f"If a person does not do what Tangy asks, it asks at most {often(visit)} in a visit, "
            f"and {often(most)} in a game."
        )
    pauses, seconds = sum(g.pauses[0] for g in games), sum(g.pauses[1] for g in games)
    if pauses and full:
        yield f"The robot waited for late data {often(pauses)}, for {seconds:.1f} s in all."


def _games_lines(replays: Sequence[GameReplay], *, full: bool) -> Iterator[str]:
    """Describe each game, of many only those with problems, and the totals."""
    games = [replay.game for replay in replays]
    activities = {replay.game.id: replay.activity for replay in replays}
    told = games
    if len(games) > MOST_TOLD:
        told = [game for game in games if game.critical or game.other or not game.smooth]
        days = dict.fromkeys(day_and_time(game.at) for game in (games[0], games[-1]))
        yield f"{len(games)} games, {' to '.join(days)}: {_sums(games)}."
        if told:
            yield "Those with faults, or that did not go to their end:"
    for game in told:
        if not full:
            yield f"{staff_game_words(game, activities[game.id])}. {ending_sentence(game)}"
            continue
        steps = counted(game.steps, "step")
        yield f"{game_words(game, activities[game.id])}: {steps}. {ending_sentence(game)}"
    if len(told) < len(games):
        rest = counted(len(games) - len(told), "game")
        other = "other " if told else ""
        yield (
            f"The {other}{rest} went to the end without a fault; `tangy log list` names them, "
            "and `tangy log show NUMBER` tells one step by step."
        )


def _sums(games: Sequence[Game]) -> str:
    stopped = sum(game.stopped is not None for game in games)
    endless = sum(game.ended is None for game in games)
    early = sum(bool(game.due) for game in games)
    parts = [
        counted(sum(game.steps for game in games), "step"),
        f"{len(games) - stopped - endless - early} {TO_ITS_END}",
    ]
    if early:
        parts.append(f"{early} ended early")
    if stopped:
        parts.append(f"{stopped} stopped before it")
    if endless:
        parts.append(f"{endless} without an end in the log")
    return ", ".join(parts)


HOW_TO_GO_ON = "`tangy log show 1`: a game step by step. `tangy report session 1`: its report."
