"""How people responded in a session, with drawings of the posteriors before and after it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from html import escape

from tangy_profiles.beliefs import Beta
from tangy_tui.monitoring.people_progress import RESULTS, Attempts, Progress
from tangy_tui.monitoring.session import Session
from tangy_tui.pages.page import figure, heading, paragraph, table
from tangy_tui.text import results
from tangy_tui.text import session_page as say
from tangy_tui.text.report import quiet_words

COLUMNS = (
    "person", "way of asking", "asked", *(results.RESULT_WORDS[what] for what in RESULTS),
    "before", "after",
)  # fmt: skip
"""The columns of the table of people: the results add up to the number of requests."""

WIDTH, LEFT, RIGHT, ROW, AXIS = 460, 100, 22, 30, 20
"""The layout of the drawing in its own units: names of strategies at the left, the axis below."""
LONGEST = 13
"""The most letters of a strategy's name."""


@cache
def interval(alpha: float, beta: float) -> tuple[float, float]:
    """Return the interval of a Beta posterior, two probabilities; cached."""
    return Beta(alpha, beta).interval()


def responses_part(session: Session) -> Iterator[str]:
    """Report how people responded to each strategy, with the beliefs by the method used."""
    if not session.persuades:
        return
    yield heading(say.RESPONDED)
    asked = [person for person in session.people if person.interactions]
    if not asked:
        yield paragraph(say.NOBODY_ASKED)
        return
    yield paragraph(say.BELIEFS)
    if any(len(person.methods) > 1 for person in asked):
        yield paragraph(results.BY_METHOD)
    yield '<div class="both">'
    for person in asked:
        for method in (one for one in person.methods if one.interactions):
            where = results.method_words(person, method)
            title = f"{person.name}, {where}" if where else person.name
            drawing = belief_drawing(method.strategies)
            yield f"<div><h3>{escape(title)}</h3>"
            yield figure(drawing, results.asked_words([method])) + "</div>"
    yield "</div>"
    quiet = [person.name for person in session.people if not person.interactions]
    if quiet:
        yield paragraph(quiet_words(quiet))
    yield table(COLUMNS, _rows(asked))


def _rows(people: Iterable[Progress]) -> Iterator[tuple[object, ...]]:
    for person in people:
        for method in person.methods:
            where = results.method_words(person, method)
            for strategy, one in method.strategies.items():
                if one.used:
                    yield (
                        person.name,
                        f"{strategy} ({where})" if where else strategy,
                        one.used,
                        *(getattr(one, what) for what in RESULTS),
                        *(_belief(belief.alpha, belief.beta) for belief in (one.before, one.after)),
                    )


def _belief(alpha: float, beta: float) -> str:
    low, high = interval(alpha, beta)
    words = f"{alpha / (alpha + beta):.0%} ({low:.0%} to {high:.0%})"
    return words.replace(" ", "\N{NO-BREAK SPACE}")


def belief_drawing(strategies: Mapping[str, Attempts]) -> str:
    """Draw mean and interval of each strategy that was used, before (ring) and after (dot)."""
    used = {strategy: one for strategy, one in strategies.items() if one.used}
    height = ROW * len(used) + AXIS
    parts = [*_axis(height)]
    for place, (strategy, one) in enumerate(used.items()):
        parts += _strategy(strategy, one, ROW * place + ROW / 2)
    return f'<svg role="img" viewBox="0 0 {WIDTH} {height}" class="beliefs">{"".join(parts)}</svg>'


def _x(share: float) -> float:
    return LEFT + (WIDTH - LEFT - RIGHT) * share


def _axis(height: float) -> Iterator[str]:
    for percent in (0, 25, 50, 75, 100):
        x = _x(percent / 100)
        yield f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="0" y2="{height - AXIS}"/>'
        yield (
            f'<text class="dim" x="{x:.1f}" y="{height - 5}" text-anchor="middle">{percent}%</text>'
        )


def _strategy(strategy: str, one: Attempts, y: float) -> Iterator[str]:
    short = strategy if len(strategy) <= LONGEST else strategy[: LONGEST - 1] + "…"
    yield (
        f'<text class="ink" x="{LEFT - 10}" y="{y + 4.5}" text-anchor="end">{escape(short)}</text>'
    )
    for belief, kind, dy, radius in (
        (one.before, "before", -5.0, 3.6),
        (one.after, "after", 5.0, 4.6),
    ):
        low, high = interval(belief.alpha, belief.beta)
        words = f"{kind}: {belief.mean:.0%}, {low:.0%} to {high:.0%}"
        yield (
            f'<g class="{kind}"><title>{words}</title>'
            f'<line x1="{_x(low):.1f}" x2="{_x(high):.1f}" y1="{y + dy}" y2="{y + dy}"/>'
            f'<circle cx="{_x(belief.mean):.1f}" cy="{y + dy}" r="{radius}"/></g>'
        )
