"""The parts of a session's report that staff read first: people, calls, staff actions, faults."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.monitoring.session import Session
from tangy_tui.pages.page import heading, paragraph, table
from tangy_tui.text import player_facts as players
from tangy_tui.text import report as say
from tangy_tui.text import staff_report as staff
from tangy_tui.text.sessions import status_words
from tangy_tui.text.times import day_and_time, time_of_day

FEW_ROWS = 10
"""Of more actions of staff, a printed page has two columns."""

STYLE = """
.called { display: flex; flex-wrap: wrap; gap: .15rem .5rem; margin: .3rem 0;
  font-variant-numeric: tabular-nums; }
.called s { color: var(--dim); }
.people td:nth-child(2), .people td:nth-child(5), .people td:nth-child(7) { white-space: nowrap; }
.people td:nth-child(3) { min-width: 10rem; }
@media print { :root { font-size: 10pt; } body { font-size: 9.5pt; line-height: 1.35; }
  h1 { font-size: 15pt; }
  h2 { font-size: 12pt; margin: 10pt 0 2pt; } h3 { font-size: 10pt; margin: 6pt 0 2pt; }
  table { font-size: 8pt; line-height: 1.2; } th, td { padding: .5pt 4pt; }
  .called { gap: 0 .45rem; font-size: 9pt; margin: 1pt 0; }
  .staff td:nth-child(-n+2) { white-space: nowrap; width: 1%; }
  .staff.long { columns: 2; column-gap: 14pt; }
  .wide { margin: 2pt 0; } .care { padding: 3pt 8pt; margin: 4pt 0; }
  dl { margin: 4pt 0; font-size: 9pt; gap: 0 1rem; line-height: 1.25; }
  p { margin: 2pt 0; } .key { font-size: 8pt; margin: 2pt 0; gap: 0 .8rem; }
  .game figcaption { display: none; } figure { margin: 4pt 0; } @page { margin: 10mm 12mm; } }
"""


def people_part(session: Session) -> Iterator[str]:
    """Report each person's requests, waits, visits, help, and responses."""
    columns, rows = say.people_table(session)
    yield heading(say.PEOPLE)
    yield '<div class="people">'
    yield table(columns, rows)
    yield "</div>"
    if where := say.visiting_words(session.replays):
        yield paragraph(where)
    for line in say.changes_lines(session.replays, session.name):
        yield paragraph(line)


def calls_part(session: Session) -> Iterator[str]:
    """List the calls of each game, in order."""
    told = say.call_rows(session)
    if not told:
        return
    yield heading(say.CALLED)
    for game, labels in told:
        cells = "".join(
            f"<s>{escape(label)}</s>" if taken else f"<span>{escape(label)}</span>"
            for label, taken in labels
        )
        which = f"<b>Game {game.number}:</b>" if len(session.replays) > 1 else ""
        yield f'<p class="called">{which}{cells}</p>'
        if any(taken for _, taken in labels):
            yield f'<p class="dim">{escape(say.TAKEN_BACK)}</p>'


def player_facts_part(session: Session) -> Iterator[str]:
    """Report people's answers and counts, game by game."""
    found = session.player_facts
    if not found:
        return
    yield heading(players.HEADING)
    replays = {replay.game.id: replay for replay in session.replays}
    for one in found:
        if len(replays) > 1:
            yield game_part(replays[one.game])
        yield table(players.player_columns(one), players.player_rows(one, session.name))
        if one.acts:
            yield table(players.act_columns(one), players.act_rows(one, session.name))


def game_part(replay: GameReplay) -> str:
    """Return the heading of a game in a session of several."""
    words = players.game_heading(replay)
    return f"<h3>{escape(words[:1].upper() + words[1:])}, {day_and_time(replay.game.at)}</h3>"


def staff_part(session: Session) -> Iterator[str]:
    """List the actions of staff, with times."""
    rows = staff.staff_rows(session.replays, session.name)
    yield heading(staff.STAFF)
    if not rows:
        yield paragraph(staff.NO_STAFF)
        return
    yield f'<div class="staff{" long" if len(rows) > FEW_ROWS else ""}">'
    yield table(staff.STAFF_COLUMNS, rows)
    yield "</div>"


def faults_part(session: Session) -> Iterator[str]:
    """List the faults: when, what, and how each ended."""
    rows = [
        (time_of_day(at), fault.name, say.fault_outcome(fault, status_words(fault.status)))
        for at, fault in session.timed_faults
    ]
    if rows:
        yield heading(say.FAULTS_SHORT)
        yield table(say.FAULT_COLUMNS, rows)
