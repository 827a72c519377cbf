"""A person's posteriors before and after a session, as a small drawing."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from html import escape

from tangy_profiles.beliefs import Beta
from tangy_tui.monitoring.people_progress import Attempts, Progress

WIDTH, LEFT, RIGHT, ROW, AXIS = 460, 100, 22, 30, 20
"""The layout of the drawing in its own units: names of strategies at the left, the axis below."""
LONGEST = 13
"""The most letters of a strategy's name."""


@cache
def interval(alpha: float, beta: float) -> tuple[float, float]:
    """Return the interval of a Beta posterior, two probabilities; cached."""
    return Beta(alpha, beta).interval()


def belief_drawing(person: Progress) -> str:
    """Draw mean and interval of each strategy that was used, before (ring) and after (dot)."""
    used = {strategy: one for strategy, one in person.strategies.items() if one.used}
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
