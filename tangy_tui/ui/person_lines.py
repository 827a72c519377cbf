"""The lines of a person's record on a panel: people, strategies, history."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.cells import cell_len

from tangy_profiles.beliefs import Beta
from tangy_profiles.person import is_guest
from tangy_tui.interaction.feedback import FeedbackEntry
from tangy_tui.interaction.record import PersonSummary
from tangy_tui.text.people import (
    NO_REQUESTS,
    drift_lines,
    entry_words,
    method_words,
    prior_words,
    sentence,
    tally,
)
from tangy_tui.text.register import GUEST_NOTE
from tangy_tui.text.times import on_day
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.choice_list import ChoiceLine
from tangy_tui.ui.widgets.posteriors import BLOCKS, LOWEST_PEAK, share
from tangy_tui.ui.widgets.rows import Row, Span, fit, shorten
from tangy_tui.ui.widgets.wrapping import wrap

LONGEST_CURVE = 40
HIGHEST_CURVE = 5
COUNTS = 9  # columns: "40 of 100"
STATE = 13


def people_lines(records: Sequence[PersonSummary], width: int) -> list[ChoiceLine]:
    """Format one sentence for each person, with the name highlighted."""
    lines = []
    for record in records:
        guest = GUEST_NOTE if is_guest(record.person.id) else ""
        words = shorten(f"{guest}{clean(sentence(record))}", width)
        before, name, after = words.partition(clean(record.person.name))
        lines.append(
            ChoiceLine(((before, "text"), (name, "person"), (after, "text")), record.person.id)
        )
    return lines


def strategy_lines(record: PersonSummary, width: int, height: int) -> list[ChoiceLine]:
    """Format each strategy with curve, counts, mean, interval and P(best), then the method.

    The curves are as high as the panel allows.
    """
    label = min(12, max(cell_len(clean(s)) for s in record.beliefs))
    points = max(6, min(LONGEST_CURVE, width - label - COUNTS - STATE - 22))
    tall = max(1, min(HIGHEST_CURVE, (height - 4) // len(record.beliefs) - 1))
    head = f"{fit('0 to 1', points)} {'complied':>{COUNTS}} mean  90%     best"
    lines = [ChoiceLine(((" " * (label + 1), "dim"), (shorten(head, width - label - 1), "dim")))]
    for strategy, belief in record.beliefs.items():
        *above, last = curve_lines(belief, points, tall)
        lead = (" " * (label + 1), "text")
        lines += [ChoiceLine((lead, (part, "curve")), strategy) for part in above]
        lines.append(ChoiceLine(_strategy(record, strategy, label, last), strategy))
        if tall > 1:
            lines.append(ChoiceLine(()))
    for words in (*drift_lines(record), method_words(record), prior_words(record.known.prior)):
        lines += [ChoiceLine(((line, "dim"),)) for line in wrap(clean(words), width)]
    return lines


def curve_lines(belief: Beta, width: int, height: int) -> list[str]:
    """Draw the density from 0 (left) to 1 (right) on some lines, the top one first."""
    density = belief.density(width)
    peak = max(LOWEST_PEAK, *density)
    full = len(BLOCKS) - 1
    levels = [round(value / peak * full * height) for value in density]
    return [
        "".join(BLOCKS[min(full, max(0, level - full * below))] for level in levels)
        for below in range(height - 1, -1, -1)
    ]


def _strategy(record: PersonSummary, strategy: str, label: int, drawn: str) -> Row:
    belief = record.beliefs[strategy]
    low, high = belief.interval()
    off = strategy in record.known.off
    state, ink = "", "text"
    if off:
        state, ink = "off", "warn"
    elif strategy == record.settled:
        state, ink = "★ settled", "good"
    elif strategy == record.leading and belief.trials:
        state, ink = "★ so far", "good"
    spans: list[Span] = [
        (fit(clean(strategy), label), "dim" if off else "text"),
        (" ", "text"),
        (drawn, "curve"),
        (f" {tally(belief):>{COUNTS}}", "text"),
        (f"  {share(belief.mean)}", "strong"),
        (f" {share(low)}-{share(high)}", "text"),
        (f"  {share(record.best[strategy])}", ink if ink == "good" else "dim"),
        (f" {state}", ink),
    ]
    return tuple(spans)


def history_lines(record: PersonSummary, width: int) -> list[ChoiceLine]:
    """Format the history, the newest game first, and in it the newest response first."""
    if not record.games:
        return [ChoiceLine(((NO_REQUESTS, "dim"),))]
    strategy = min(12, max(cell_len(clean(e.strategy)) for e in record.history))
    digits = len(str(len(record.history)))
    lines = []
    for game in reversed(record.games):
        heading = "game of" if game.id is not None else "outside of a game, from"
        lines.append(ChoiceLine(((f"{heading} {on_day(game.begun)}", "dim"),)))
        for entry in reversed(game.entries):
            lines.append(ChoiceLine(_entry(entry, digits, strategy, width), entry.seq))
    return lines


def _entry(entry: FeedbackEntry, digits: int, strategy: int, width: int) -> Row:
    local = entry.at.astimezone()
    front = f" {entry.number:>{digits}}  {local:%H:%M}  "
    words = shorten(clean(entry_words(entry)), width - cell_len(front) - strategy - 2)
    ink = ("good" if entry.complied else "text") if entry.counts else "dim"
    return (
        (front, "dim"),
        (fit(clean(entry.strategy), strategy), "text" if entry.counts else "dim"),
        ("  ", "text"),
        (words, "warn" if entry.open and entry.complied is None else ink),
    )


def strategy_hint(strategies: Mapping[str, str], chosen: object) -> str:
    """Describe the chosen strategy in the words of the activity."""
    words = strategies.get(str(chosen), "")
    return clean(f"{chosen}: {words}") if words else ""
