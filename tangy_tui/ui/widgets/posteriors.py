"""The posterior of each person (Eq. 1): a small curve for every persuasive strategy."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rich.cells import cell_len
from textual import events
from textual.binding import Binding, BindingType

from tangy_profiles.beliefs import Beliefs, Beta, leading, probability_best, settled
from tangy_tui.text.people import BELIEF_COLUMNS, NOBODY_KNOWN, what_works
from tangy_tui.ui.clean_output import clean
from tangy_tui.ui.widgets.rows import Row, RowView, Span, fit, shorten

BLOCKS = " ▁▂▃▄▅▆▇█"
LOWEST_PEAK = 3.0
"""Lower densities share this scale, so that an uninformed posterior looks flat."""

LINES_FROM = 36
"""From this width in cells, each strategy has a line; below it, each person."""

WORDS_FROM = 50
"""From this width in cells, P(best) is labelled."""

LONGEST_CURVE = 24


def curve(belief: Beta, width: int) -> str:
    """Draw the density from 0 (left) to 1 (right) in some characters."""
    density = belief.density(width)
    peak = max(LOWEST_PEAK, *density)
    levels = len(BLOCKS) - 1
    return "".join(BLOCKS[round(value / peak * levels)] for value in density)


class Posteriors(RowView, can_focus=True):
    """For each person and strategy: curve, complied / asked, mean and P(best).

    A star marks the strategy with the highest P(best) if it is unique; a settled one is named
    beside the person. Only changed lines are redrawn.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("k", "scroll_up", "Up", show=False),
        Binding("j", "scroll_down", "Down", show=False),
    ]
    HELP = (
        "What works with whom: how likely each person is to do what Tangy asks for, with each way "
        "of asking. 7/9 means that it worked 7 times of 9. A hump on the right means it works, on "
        "the left it does not, a flat line that Tangy does not know yet. For researchers: "
        "the curve is the posterior density from 0 to 1; its mean follows, and the probability "
        "that this way is the best of all. It is settled when that is at least .9."
    )

    def __init__(
        self,
        *,
        world: str = "",
        compact: bool | None = None,
        id: str | None = "posteriors",
        classes: str | None = None,
    ) -> None:
        """Create the view.

        Args:
            world: the world whose games the posteriors are from, for the title; "" omits it.
            compact: give each person one line (None: only if the widget is narrow).
            id: the widget's id.
            classes: the widget's classes.
        """
        super().__init__(id=id, classes=classes)
        self._compact_wanted = compact
        self.border_title = what_works(world)
        self._beliefs: dict[str, Beliefs] = {}
        self._names: Mapping[str, str] = {}
        self._highlight: tuple[str, str] | None = None
        self._best: dict[str, dict[str, float]] = {}

    def show(
        self,
        beliefs: Mapping[str, Beliefs],
        names: Mapping[str, str],
        highlight: tuple[str, str] | None = None,
    ) -> None:
        """Show the posteriors; `highlight` marks the person and strategy in use."""
        for person, profile in beliefs.items():
            if self._beliefs.get(person) != profile:
                self._best[person] = probability_best(profile)
        self._beliefs = {person: dict(profile) for person, profile in beliefs.items()}
        self._names = dict(names)
        self._highlight = highlight
        self._show()

    def on_resize(self, event: events.Resize) -> None:
        """Lay out again."""
        self._show()

    def _show(self) -> None:
        width = self._rows.width
        if not self.is_attached or width <= 0:
            return
        compact = width < LINES_FROM if self._compact_wanted is None else self._compact_wanted
        self.border_subtitle = "" if compact else BELIEF_COLUMNS
        rows: list[Row] = []
        marks: dict[int, str] = {}
        for person, profile in self._beliefs.items():
            name = clean(self._names.get(person, person))
            if compact:
                if self._highlight is not None and self._highlight[0] == person:
                    marks[len(rows)] = "now"
                rows.append(self._compact(person, name, profile, width))
                continue
            known = settled(self._best[person])
            if known is not None and (len(profile) == 1 or not profile[known].complied):
                known = None  # a single strategy is no choice, and one that never worked no answer
            head: Row = ((fit(name, width), "person"),)
            if known is not None:
                mark = f"  settled: {clean(known)}"
                head = ((shorten(name, width - cell_len(mark)), "person"), (mark, "good"))
            rows.append(head)
            for strategy, belief in profile.items():
                if self._highlight == (person, strategy):
                    marks[len(rows)] = "now"
                rows.append(self._line(person, strategy, belief, width))
        self._rows.put(rows or [((NOBODY_KNOWN, "dim"),)], marks)
        if marks:
            self._rows.show(min(marks))

    def _line(self, person: str, strategy: str, belief: Beta, width: int) -> Row:
        """Format one strategy: name, curve, counts, mean, P(best)."""
        best = self._best[person]
        leads = len(best) > 1 and leading(best) == strategy and belief.trials > 0
        label = min(12, max(cell_len(s) for s in self._beliefs[person]))
        word = " best " if width >= WORDS_FROM else ""
        tail: tuple[Span, ...] = (
            (f" {_counts(belief):>6}", "text"),
            (f" {share(belief.mean)}", "strong"),
            (f" {word}{share(best[strategy])}", "good" if leads else "dim"),
            ("★" if leads else " ", "good"),
        )
        used = 2 + label + sum(cell_len(text) for text, _ in tail)
        points = min(LONGEST_CURVE, max(6, width - used))
        return (
            (" ", "text"),
            (fit(clean(strategy), label), "text"),
            (" ", "text"),
            (curve(belief, points), "curve"),
            *tail,
        )

    def _compact(self, person: str, name: str, profile: Beliefs, width: int) -> Row:
        """Format one person: the strategy in use or the best one, with its curve and mean."""
        best = self._best[person]
        strategy = max(best, key=lambda s: best[s])
        if self._highlight is not None and self._highlight[0] == person:
            strategy = self._highlight[1]
        belief = profile[strategy]
        leads = len(best) > 1 and leading(best) == strategy and belief.trials > 0
        label = min(10, max(cell_len(s) for s in profile))
        tail = f" {_counts(belief)} {share(belief.mean)}"
        mark = "★" if leads else " "
        room = width - label - cell_len(tail) - 3
        points = min(10, max(0, room - 6))
        return (
            (fit(name, max(4, min(10, room - points))), "person"),
            (" ", "text"),
            (fit(clean(strategy), label), "text"),
            (mark, "good"),
            (curve(belief, points) if points >= 4 else "", "curve"),
            (tail, "strong"),
        )


def _counts(belief: Beta) -> str:
    return f"{belief.complied}/{belief.trials}"


def share(value: float) -> str:
    """Format a probability in three characters, as papers do: .87, and 1.0 from .995 on."""
    return "1.0" if value >= 0.995 else f".{round(value * 100):02d}"
