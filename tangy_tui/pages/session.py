"""The report of a session as one page: first what staff want to know, then the details."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape

from tangy_tui.monitoring.attention import attention
from tangy_tui.monitoring.fault import Fault, Moved
from tangy_tui.monitoring.fault_table import fault_rows
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.monitoring.session import Session
from tangy_tui.pages.beliefs import responses_part
from tangy_tui.pages.page import document, figure, heading, paragraph, table
from tangy_tui.pages.staff_parts import STYLE as PARTS_STYLE
from tangy_tui.pages.staff_parts import (
    calls_part,
    faults_part,
    game_part,
    people_part,
    player_facts_part,
    staff_part,
)
from tangy_tui.pages.timeline import INKS, ink, stages_of, timeline
from tangy_tui.text import session_page as say
from tangy_tui.text.activities import stage_words
from tangy_tui.text.endings import all_endings, ending_sentence
from tangy_tui.text.fault_moves import move_words
from tangy_tui.text.numbers import counted
from tangy_tui.text.player_facts import look_after_lines
from tangy_tui.text.report import care_lines
from tangy_tui.text.results import RESULT_WORDS
from tangy_tui.text.sessions import note_words, status_words
from tangy_tui.text.taking_part import played_for_rows, took_part, with_stay
from tangy_tui.text.times import clock, day_and_time, time_of_day
from tangy_tui.text.worlds import WORLDS_IN_REPORTS

MOST_DRAWN = 24
"""The most games drawn on one page: the last ones."""

FEW_DRAWN = 3
"""The most games drawn if the page should fit on two sheets: fewer for many people."""

FEW_ROWS = 24
"""The most people in all drawings together, if the page should fit on two sheets."""

FEW_GAMES = 3
"""Each further game takes the room of `GAME_ROWS` people in the drawings."""
GAME_ROWS = 4

STYLE = """
:root { --critical: #b91c1c; --minor: #b45309; --on: #ffffff; }
@media (prefers-color-scheme: dark) { :root { --critical: #f87171; --minor: #fbbf24;
  --on: #14181d; } }
@media print { :root { --critical: #b91c1c; --minor: #b45309; --on: #ffffff; } }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1rem; margin: .8rem 0; }
dt { color: var(--dim); } dd { margin: 0; }
h3 { font-size: 1rem; margin: 1.4rem 0 .2rem; }
.care { border-left: 4px solid var(--minor); background: var(--shade); padding: .5rem 1rem;
  margin: .8rem 0; } .care.critical { border-color: var(--critical); }
.care h3 { margin: 0 0 .2rem; } .care ul { margin: .2rem 0; padding-left: 1.2rem; }
.fine { border-left: 4px solid var(--series-3); background: var(--shade); padding: .5rem 1rem; }
.tag { border-radius: 3px; padding: .05rem .4rem; font-size: .8rem; font-weight: 600;
  color: var(--on); background: var(--minor); white-space: nowrap; }
.tag.critical { background: var(--critical); }
.both { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 20rem), 1fr));
  gap: .4rem 2rem; } .both figure { margin: .6rem 0; } .both h3 { margin-top: .6rem; }
.moves { font-size: .9rem; margin: .3rem 0; padding-left: 0; list-style: none; }
.moves li { padding: .15rem 0; border-bottom: 1px solid var(--line); display: flex; gap: .8rem; }
.moves .when { color: var(--dim); white-space: nowrap; font-variant-numeric: tabular-nums; }
svg text { font: 13px var(--font); fill: var(--ink); } svg text.dim { fill: var(--dim); }
svg text.on { fill: var(--on); font-weight: 700; font-size: 12px; }
.grid { stroke: var(--line); stroke-width: 1; } .base { stroke: var(--line); }
.stage { fill-opacity: .28; } .tick { stroke: var(--ink); stroke-width: 1.6; }
.tick.wrong { stroke: var(--critical); stroke-width: 3; }
.visit { fill: var(--series-1); fill-opacity: .45; } .asks { fill: var(--minor); }
.yes { fill: var(--ink); stroke: var(--paper); stroke-width: 1.2; }
.late { fill: var(--paper); stroke: var(--ink); stroke-width: 2; }
.no { stroke: var(--ink); stroke-width: 2.4; fill: none; }
.open { stroke: var(--dim); stroke-width: 1.6; stroke-dasharray: 2 2; fill: none; }
.halt { fill: var(--critical); fill-opacity: .13; }
.fault.critical { fill: var(--critical); } .fault.minor { fill: var(--minor); }
.mend { stroke-width: 3; } .mend.critical { stroke: var(--critical); }
.mend.minor { stroke: var(--minor); } .mend.stays { stroke-dasharray: 3 5; }
.before { fill: var(--paper); stroke: var(--dim); stroke-width: 1.6; }
.after { fill: var(--series-1); stroke: var(--series-1); stroke-width: 2.6; }
.key { display: flex; flex-wrap: wrap; gap: .2rem 1.1rem; font-size: .85rem; color: var(--dim);
  margin: .3rem 0; break-after: avoid; }
.key span { white-space: nowrap; } .key svg { display: inline-block;
  width: 20px; height: 16px; vertical-align: -3px; margin-right: .3rem; }
.timeline { min-width: 46rem; } .drawn { overflow-x: auto; }
@media print { .timeline { min-width: 0; } .drawn { overflow: visible; }
  .care, .called, .moves li, .fault-told, .game { break-inside: avoid; } }
""" + "".join(f".s{n} {{ fill: var(--series-{n}); }}\n" for n in INKS)  # the stages' inks

KEY = (
    ('<rect class="visit" x="1" y="2" width="18" height="12" rx="3"/>', say.VISIT),
    ('<rect class="asks" x="1" y="6" width="18" height="4"/>', say.WAITS),
    ('<circle class="yes" cx="10" cy="8" r="5"/>', RESULT_WORDS["complied"]),
    ('<circle class="late" cx="10" cy="8" r="4.4"/>', RESULT_WORDS["late"]),
    ('<path class="no" d="M6 4L14 12M6 12L14 4"/>', RESULT_WORDS["refused"]),
    ('<circle class="open" cx="10" cy="8" r="4.4"/>', RESULT_WORDS["awaited"]),
    ('<line class="tick" x1="6" x2="6" y1="4" y2="12"/>'
     '<line class="tick" x1="14" x2="14" y1="0" y2="16"/>', say.TICKS),
    ('<g class="fault minor"><circle cx="10" cy="8" r="7"/></g>', say.FAULT),
    ('<g class="fault critical"><path d="M10 0L18 8L10 16L2 8Z"/></g>', say.CRITICAL_FAULT),
    ('<rect class="halt" x="1" y="0" width="18" height="16"/>', say.STOOD_STILL),
)  # fmt: skip
"""The marks of the timeline, with their meanings."""


def session_page(session: Session, *, full: bool = True) -> str:
    """Return the report of a session for staff; `full` adds the details for researchers."""
    games = session.games
    title = f"{session.title}: session of {day_and_time(games[0].at)}"
    parts = [*_head(session, full=full), *_care(session), *people_part(session)]
    parts += [*player_facts_part(session), *calls_part(session)]
    parts += [*staff_part(session), *([] if full else faults_part(session))]
    parts += _timelines(session, MOST_DRAWN if full else drawn_games(session), full=full)
    if full:
        parts += [*responses_part(session), *_faults(session), *_tables(session)]
    return document(
        title, _sum(session, full=full), [*parts, *_notes(session)], STYLE + PARTS_STYLE
    )


def drawn_games(session: Session) -> int:
    """Return how many games are drawn if the page should fit on two sheets; the others are told."""
    games, people = len(session.games), max(1, len(session.people))
    rows = FEW_ROWS - GAME_ROWS * max(0, games - FEW_GAMES)
    return 1 if games == 1 else max(0, min(FEW_DRAWN, rows // people))


def _sum(session: Session, *, full: bool) -> str:
    steps = sum(game.steps for game in session.games)
    words = [counted(len(session.games), "game"), counted(len(session.faults), "fault")]
    return " · ".join([*words, *([counted(steps, "behaviour")] if full else [])])


def _head(session: Session, *, full: bool) -> Iterator[str]:
    games = session.games
    policies = dict.fromkeys(game.policy for game in games)
    facts = [
        (say.FROM_TO, f"{day_and_time(games[0].at)}{_until(session)}"),
        (say.WHERE, ", ".join(dict.fromkeys(WORLDS_IN_REPORTS[game.world] for game in games))),
        (say.WHO, took_part(session) or say.NOBODY_NAMED),
        *([("Policy", ", ".join(policies))] if full else []),
        (say.HOW_LONG, say.how_long(session)),
    ]
    if len(games) == 1:
        facts.append((say.ENDED, ending_sentence(games[0])))
    else:
        facts.append((say.ALL_ENDED, all_endings(games)))
    facts += played_for_rows(session)
    facts.append((say.FAULTS_HEAD, say.fault_sum(session.faults)))
    rows = "".join(f"<dt>{escape(name)}</dt><dd>{escape(words)}</dd>" for name, words in facts)
    yield f"<dl>{rows}</dl>"


def _until(session: Session) -> str:
    ended = session.games[-1].ended
    if ended is None:
        return ""  # how it ended is told below
    begun = session.games[0].at.astimezone().date()
    same = ended.astimezone().date() == begun
    return f" to {f'{ended.astimezone():%H:%M}' if same else day_and_time(ended)}"


def _care(session: Session) -> Iterator[str]:
    yield heading(say.CARE)
    people = look_after_lines(session.player_facts, session.name) + care_lines(
        attention(session.replays).values(),
        lambda person: with_stay(session, person),
        session.replays,
    )
    if people:
        lines = "".join(f"<li>{escape(line)}</li>" for line in people)
        yield f'<div class="care"><ul>{lines}</ul></div>'
    if not (session.look_after or people):
        yield f'<p class="fine">{escape(say.NOTHING_LEFT)}</p>'
    numbers = _numbers(session)
    told: set[tuple[str, str]] = set()
    for fault in session.look_after:
        if (fault.name, fault.console) in told:
            continue  # once is enough for repeated faults
        told.add((fault.name, fault.console))
        steps = "".join(f"<li>{escape(step)}</li>" for step in fault.advice)
        number = f"{numbers[fault.id]}. " if fault.id in numbers else ""
        yield (
            f'<div class="care{" critical" if fault.critical else ""}">'
            f"<h3>{escape(number + fault.name)} ({status_words(fault.status)})</h3>"
            f"<p>{escape(fault.console)}</p><ul>{steps}</ul></div>"
        )


def _timelines(session: Session, most: int, *, full: bool) -> Iterator[str]:
    numbers = _numbers(session)
    drawn = session.replays[-most:] if most else ()
    yield f'<div class="game">{heading(say.WHEN)}'
    if len(drawn) < len(session.replays):
        yield paragraph(say.drawn_words(most, len(session.replays), full=full))
        if not drawn:
            yield "</div>"
    played, stages = "", dict[str, str]()
    for index, replay in enumerate(drawn):
        if index:
            yield '<div class="game">'
        if len(session.replays) > 1:
            yield game_part(replay)
            yield paragraph(ending_sentence(replay.game))
        if not index or replay.game.activity != played:  # stages of the same name may differ
            played = replay.game.activity
            same = [r for r in session.replays if r.game.activity == played]
            stages = {s: stage_words(replay.activity, s) for s in stages_of(same)}
            yield _key(stages)
        yield f'<div class="drawn">{_timeline(replay, numbers, session, stages)}</div></div>'


def _timeline(
    replay: GameReplay, numbers: dict[str, int], session: Session, stages: Mapping[str, str]
) -> str:
    drawing = timeline(replay, numbers, session.names, stages)
    return figure(drawing, say.game_caption(replay.game.number, timed=replay.timed))


def _key(stages: Mapping[str, str]) -> str:
    bands = [
        (f'<rect class="stage {ink(stage, stages)}" x="1" width="18" height="16"/>', words)
        for stage, words in stages.items()
    ]
    marks = "".join(
        f'<span><svg viewBox="0 0 20 16" aria-hidden="true">{mark}</svg>{escape(words)}</span>'
        for mark, words in (*bands, *KEY)
    )
    return f'<p class="key">{marks}</p>'


def _faults(session: Session) -> Iterator[str]:
    yield heading(say.FAULTS)
    if not session.faults:
        yield paragraph(say.NO_FAULTS)
    numbers = _numbers(session)
    for replay in session.replays:
        for fault in replay.real_faults:
            yield _fault(fault, numbers[fault.id], replay, len(session.replays) > 1)
    if session.questions:
        yield heading(say.UNSURE)
        yield table(
            say.UNSURE_COLUMNS,
            [
                (replay.game.number, fault.step, _last_words(fault))
                for replay in session.replays
                for fault in replay.faults
                if fault.asks_only
            ],
        )


def _last_words(fault: Fault) -> str:
    told = [move_words(move) for move in fault.moves]
    return told[-1] if told else status_words(fault.status)


def _fault(fault: Fault, number: int, replay: GameReplay, many: bool) -> str:
    kind = "critical" if fault.critical else "minor"
    facts = say.fault_facts(fault, replay.game.number if many else None)
    ats = _times(replay, fault)
    moves = "".join(
        f'<li><span class="when">{clock(seconds)} · {at}</span><span>{words}</span></li>'
        for seconds, at, words in ats
    )
    return (
        f'<div class="fault-told"><h3>{number}. {escape(fault.name)} '
        f'<span class="tag {kind}">{"critical" if fault.critical else "not critical"}</span> '
        f'<span class="dim">{status_words(fault.status)}</span></h3>'
        f"<p>{escape(fault.console)}</p>"
        f'<p class="dim">{escape(facts)} Evidence: {escape(fault.why)}.</p>'
        f'<ul class="moves">{moves}</ul></div>'
    )


def _times(replay: GameReplay, fault: Fault) -> Iterator[tuple[float, str, str]]:
    """Yield the moments of a fault: time in the game (s), local time, and what was done."""
    moves = iter(fault.moves)
    for moment in replay.moments:
        if getattr(moment.what, "fault", None) is fault:
            at = time_of_day(moment.at)
            if isinstance(moment.what, Moved):
                move = next(moves)
                words = move_words(move)
                said = f' \N{EN DASH} "{move.speech}"' if move.speech else ""
                yield move.seconds, at, escape(words + said)
            else:
                yield fault.seconds, at, "was diagnosed"


def _tables(session: Session) -> Iterator[str]:
    yield heading(say.BEHAVIOURS)
    yield table(
        ("stage", "request", "user state", "behaviour", "success", "instances"),
        (
            (*row.situation, row.behaviour, f"{row.success:.0%}", row.instances)
            for row in session.rows
        ),
    )
    yield heading(say.SUMS)
    yield table(
        ("criticality", "recovery", "success", "instances"),
        (
            (row["criticality"], row["recovery"], _share(row["success"]), row["instances"])
            for row in fault_rows(session.faults)
        ),
    )


def _share(success: float | None) -> str:
    return "\N{EN DASH}" if success is None else f"{success:.0%}"


def _notes(session: Session) -> Iterator[str]:
    for note in session.notes:
        yield f'<p class="dim">{escape(note_words(note))}</p>'


def _numbers(session: Session) -> dict[str, int]:
    """Number the faults of a session, for the drawing and the lists."""
    faults: Sequence[Fault] = session.faults
    return {fault.id: number for number, fault in enumerate(faults, 1)}
