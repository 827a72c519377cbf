"""The timeline of a game as a drawing: stages, announcements, visits, responses, faults."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from html import escape
from itertools import groupby
from typing import NamedTuple

from tangy_tui.monitoring.attention import attention_in
from tangy_tui.monitoring.fault import ENDINGS, OVER, Fault, Moved
from tangy_tui.monitoring.replay import AnsweredRequest, Done, GameReplay
from tangy_tui.monitoring.standstills import halts_in
from tangy_tui.text.results import RESULT_WORDS
from tangy_tui.text.sessions import status_words

WIDTH, LEFT, RIGHT = 1000, 118, 18
"""The layout of the drawing in its own units; the names of the lanes are at the left."""
AXIS, BAND, TICKS, MARKS = 26, 26, 24, 28
"""Heights: the axis, the stages, speech to all, one row of faults."""
LANE, NARROW, MANY = 26, 19, 8
"""The height of one person's lane, and of each of more people than so many."""
STEPS = (1, 2, 5, 10, 15, 20, 30, 60, 120, 240, 480)
MOST_TICKS = 11
INKS = (1, 3, 4, 6, 5, 2)
"""The inks of stages, in order; the one similar to faults' comes last."""
LETTER = 7.2
"""The approximate width of a letter."""


class Span(NamedTuple):
    """A span of the game, by time (s) or, without times, by steps."""

    begun: float
    over: float


class Scale:
    """Maps events to the drawing: by time, or by steps if the log has no times."""

    def __init__(self, replay: GameReplay) -> None:
        self.timed = replay.timed
        self.begun: dict[int, float] = {0: 0.0}
        for done in replay.done:
            self.begun[done.number] = done.over if self.timed else float(done.number)
        end = replay.seconds if self.timed else float(len(replay.done))
        self.end = max(end, 1.0)

    def at(self, seconds: float, step: int) -> float:
        """Return the position of a moment, in s of the game, on the axis (in s, or in steps)."""
        return seconds if self.timed else float(step)

    def x(self, where: float) -> float:
        """Return the x in px of a position on the axis (in s, or in steps)."""
        return LEFT + (WIDTH - LEFT - RIGHT) * min(max(where, 0.0), self.end) / self.end

    def ticks(self) -> Iterator[tuple[float, str]]:
        """Yield the ticks of the axis: their position (in s, or in steps), and label."""
        unit = 60 if self.timed else 1
        whole = self.end / unit
        step = next((s for s in STEPS if whole / s < MOST_TICKS), max(1, round(whole / 10)))
        for tick in range(0, int(whole) + 1, step):
            words = f"{tick} min" if self.timed else f"step {tick}" if tick else "begin"
            yield float(tick * unit), words


def timeline(
    replay: GameReplay,
    numbers: Mapping[str, int],
    names: Mapping[str, str],
    stages: Mapping[str, str],
) -> str:
    """Draw the timeline of a game as an SVG element.

    Args:
        replay: the game, step by step.
        numbers: the number on each fault's mark, by its id.
        names: the names of the people, by id.
        stages: the stages of the session with their words, in the order of their inks.
    """
    scale = Scale(replay)
    people = list(replay.game.people)
    spans = [(fault, *_fault_span(replay, fault, scale)) for fault in replay.real_faults]
    rows = _stacked([(scale.x(begun), scale.x(over)) for _, begun, over in spans])
    fault_rows = max(rows, default=-1) + 1
    top_band = AXIS
    top_ticks = top_band + BAND + 6
    top_people = top_ticks + TICKS
    lane = LANE if len(people) <= MANY else NARROW
    top_faults = top_people + lane * len(people) + 4
    height = top_faults + MARKS * max(fault_rows, 1) + 8
    parts = [
        *_axis(scale, height),
        *_halts(replay, scale, height),
        _label("stage", top_band + BAND / 2),
        *_stages(replay, scale, top_band, stages),
        _label("to everybody", top_ticks + TICKS / 2),
        *_to_all(replay, scale, top_ticks),
    ]
    waits = _waits(replay, scale)
    for place, person in enumerate(people):
        top = top_people + lane * place
        parts.append(_label(names.get(person, person), top + lane / 2))
        parts += _person(replay, person, scale, top + lane / 2, waits[person])
    parts.append(_label("faults", top_faults + MARKS / 2))
    if not spans:
        parts.append(_text(LEFT, top_faults + MARKS / 2, "none", "dim"))
    for (fault, begun, over), row in zip(spans, rows, strict=True):
        y = top_faults + MARKS * row + MARKS / 2
        parts += _fault(fault, numbers.get(fault.id, 0), scale.x(begun), scale.x(over), y)
    return (
        f'<svg role="img" viewBox="0 0 {WIDTH} {height:g}" class="timeline">'
        + "".join(parts)
        + "</svg>"
    )


def stages_of(replays: Sequence[GameReplay]) -> list[str]:
    """Return the stages that occurred, in order of first occurrence."""
    return list(dict.fromkeys(done.state.stage for replay in replays for done in replay.done))


def _axis(scale: Scale, height: float) -> Iterator[str]:
    for where, words in scale.ticks():
        x = scale.x(where)
        yield f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="{AXIS - 6}" y2="{height:g}"/>'
        last = x + LETTER * len(words) > WIDTH - 4
        anchor = "end" if last else "start" if not where else "middle"
        yield _text(x, 10, words, "dim", anchor)


def _halts(replay: GameReplay, scale: Scale, height: float) -> Iterator[str]:
    """Shade the time in which a critical fault halted the robot."""
    for begun, over in halts_in(replay):
        end = scale.end if over is None else scale.at(over.seconds, over.step)
        yield _halt(scale, Span(scale.at(begun.seconds, begun.step), end), height)


def _halt(scale: Scale, span: Span, height: float) -> str:
    x = scale.x(span.begun)
    wide = max(3.0, scale.x(span.over) - x)
    return (
        f'<rect class="halt" x="{x:.1f}" y="{AXIS - 4}" width="{wide:.1f}" '
        f'height="{height - AXIS:g}"><title>Tangy stood still</title></rect>'
    )


def ink(stage: str, stages: Iterable[str]) -> str:
    """Return the CSS class of a stage's band."""
    return f"s{INKS[list(stages).index(stage) % len(INKS)]}"


def _stages(
    replay: GameReplay, scale: Scale, top: float, stages: Mapping[str, str]
) -> Iterator[str]:
    for stage, steps in groupby(replay.done, key=lambda done: done.state.stage):
        some = list(steps)
        begun = some[0].begun if scale.timed else some[0].number - 1.0
        over = some[-1].over if scale.timed else float(some[-1].number)
        x, end = scale.x(begun), scale.x(over)
        yield (
            f'<rect class="stage {ink(stage, stages)}" x="{x:.1f}" y="{top}" '
            f'width="{max(1.0, end - x - 0.8):.1f}" height="{BAND}" rx="2">'
            f"<title>{escape(stages[stage])}</title></rect>"
        )
        if end - x > LETTER * len(stages[stage]) + 8:
            yield _text((x + end) / 2, top + BAND / 2, stages[stage], "ink", "middle")


def _to_all(replay: GameReplay, scale: Scale, top: float) -> Iterator[str]:
    """Mark behaviours for the group: a tick for each call, a taller one for others."""
    for done in replay.done:
        with_one = done.target is not None or done.after.place in replay.game.people
        if with_one and not done.draws:  # staff may have a number called during a visit
            continue
        x = scale.x(done.begun if scale.timed else done.number)
        rise = 5 if done.draws else 10
        middle = top + TICKS / 2
        yield (
            f'<line class="tick{"" if done.right else " wrong"}" x1="{x:.1f}" x2="{x:.1f}" '
            f'y1="{middle - rise:g}" y2="{middle + rise:g}">'
            f"<title>{escape(done.behaviour)}</title></line>"
        )


def _waits(replay: GameReplay, scale: Scale) -> dict[str, list[Span]]:
    """Return when each person waited, as the table of people counts it: until Tangy arrived."""
    people = replay.game.people
    if scale.timed:
        found = attention_in(replay)
        return {p: [Span(*one) for one in found[p].spans] if p in found else [] for p in people}
    requests = replay.requests

    def waits(person: str) -> list[Span]:
        asks = {n for n, waiting in requests.items() if person in waiting}
        found = _spans(replay, scale, lambda d: d.number in asks and d.after.place != person)
        return list(found)

    return {person: waits(person) for person in people}


def _person(
    replay: GameReplay, person: str, scale: Scale, middle: float, waits: Sequence[Span]
) -> Iterator[str]:
    yield f'<line class="base" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{middle}" y2="{middle}"/>'
    for span in waits:
        x, end = scale.x(span.begun), scale.x(span.over)
        yield (
            f'<rect class="asks" x="{x:.1f}" y="{middle - 2}" width="{max(2.0, end - x):.1f}" '
            f'height="4"><title>waits for help</title></rect>'
        )
    for span in _spans(replay, scale, lambda done: done.after.place == person):
        x, end = scale.x(span.begun), scale.x(span.over)
        yield (
            f'<rect class="visit" x="{x:.1f}" y="{middle - 8}" width="{max(3.0, end - x):.1f}" '
            f'height="16" rx="3"><title>Tangy is here</title></rect>'
        )
    for moment, answer in replay.answers:
        if answer.person == person:
            yield _answer(scale.x(scale.at(moment.seconds, moment.step)), middle, answer)


def _spans(replay: GameReplay, scale: Scale, holds: Callable[[Done], bool]) -> Iterator[Span]:
    """Yield the spans, from the end of one behaviour to the next, in which a condition holds."""
    begun: float | None = None
    for done in replay.done:
        here = scale.begun[done.number]
        if holds(done) and begun is None:
            begun = here
        elif not holds(done) and begun is not None:
            yield Span(begun, here)
            begun = None
    if begun is not None:
        yield Span(begun, scale.end)


def _answer(x: float, y: float, answer: AnsweredRequest) -> str:
    """Mark a person's response: a dot, a ring if it was late, a cross if there was none.

    An unknown response is a broken ring.
    """
    if answer.complied:
        words = RESULT_WORDS["complied"]
        return f'<circle class="yes" cx="{x:.1f}" cy="{y}" r="5"><title>{words}</title></circle>'
    if answer.followed or answer.complied is None:
        kind, what = ("late", "late") if answer.followed else ("open", "awaited")
        mark = f'<circle class="{kind}" cx="{x:.1f}" cy="{y}" r="4.4">'
        return f"{mark}<title>{RESULT_WORDS[what]}</title></circle>"
    arm = 4.2
    return (
        f'<path class="no" d="M{x - arm:.1f} {y - arm:.1f}L{x + arm:.1f} {y + arm:.1f}'
        f'M{x - arm:.1f} {y + arm:.1f}L{x + arm:.1f} {y - arm:.1f}">'
        f"<title>{RESULT_WORDS['refused']}</title></path>"
    )


def _fault_span(replay: GameReplay, fault: Fault, scale: Scale) -> tuple[float, float]:
    """Return the start and end of a fault; an open one lasts to the end of the game."""
    begun, over = None, scale.end
    for moment in replay.moments:
        if getattr(moment.what, "fault", None) is not fault:
            continue
        where = scale.at(moment.seconds, moment.step)
        begun = where if begun is None else begun
        if isinstance(moment.what, Moved) and moment.what.move.kind in ENDINGS:
            over = where
    begun = 0.0 if begun is None else begun
    return begun, over if fault.status != OVER else max(over, begun)


def _stacked(spans: Sequence[tuple[float, float]]) -> list[int]:
    """Assign every mark to the first row in which it does not overlap another."""
    ends: list[float] = []
    rows: list[int] = []
    for begun, over in spans:
        left, right = begun - 12, max(over, begun) + 14
        row = next((n for n, end in enumerate(ends) if end <= left), len(ends))
        if row == len(ends):
            ends.append(0.0)
        ends[row] = right
        rows.append(row)
    return rows


def _fault(fault: Fault, number: int, x: float, end: float, y: float) -> Iterator[str]:
    kind = "critical" if fault.critical else "minor"
    stays = fault.status != OVER
    if end - x > 2:
        yield (
            f'<line class="mend {kind}{" stays" if stays else ""}" x1="{x:.1f}" x2="{end:.1f}" '
            f'y1="{y}" y2="{y}"/>'
        )
    if not stays and end - x > 12:
        yield (
            f'<line class="mend {kind}" x1="{end:.1f}" x2="{end:.1f}" y1="{y - 6}" y2="{y + 6}"/>'
        )
    words = f"{number}. {fault.name} ({status_words(fault.status)})"
    shape = (
        f'<path d="M{x:.1f} {y - 13}L{x + 13:.1f} {y}L{x:.1f} {y + 13}L{x - 13:.1f} {y}Z"/>'
        if fault.critical
        else f'<circle cx="{x:.1f}" cy="{y}" r="10"/>'
    )
    yield (
        f'<g class="fault {kind}"><title>{escape(words)}</title>{shape}'
        f"{_text(x, y, str(number), 'on', 'middle')}</g>"
    )


def _label(words: str, y: float) -> str:
    most = int((LEFT - 10) / LETTER)
    short = words if len(words) <= most else words[: most - 1] + "\N{HORIZONTAL ELLIPSIS}"
    return _text(LEFT - 10, y, short, "ink", "end")


def _text(x: float, y: float, words: str, kind: str, anchor: str = "start") -> str:
    return (
        f'<text class="{kind}" x="{x:.1f}" y="{y + 4.5:.1f}" text-anchor="{anchor}">'
        f"{escape(words)}</text>"
    )
