"""The figures of reports: matplotlib drawings as SVG, with the colours of the page."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from io import StringIO
from typing import Any

from tangy_tui.experiments.estimates import share_interval
from tangy_tui.text import experiments as words

INKS = {
    "#010101": "var(--ink)",
    "#020202": "var(--dim)",
    "#030303": "var(--line)",
    **{f"#0{n}0{n}0{n}": f"var(--series-{n - 3})" for n in range(4, 10)},
}
"""Placeholder colours that are replaced by the page's, to suit light and dark themes."""

INK, DIM, LINE, *SERIES = INKS
LEGEND: dict[str, Any] = {"frameon": False, "labelcolor": INK, "fontsize": 9}
BARS: dict[str, Any] = {"ecolor": INK, "capsize": 3, "error_kw": {"elinewidth": 1}}


class Figure:
    """One drawing (its height in px) with axes side by side; `svg` returns it for the page."""

    def __init__(self, name: str, panels: int = 1, *, height: float = 3.2, rows: int = 1) -> None:
        from matplotlib.figure import Figure as Drawing

        self._name = name
        self._drawing = Drawing(figsize=(9.0, height), layout="constrained")
        self._drawing.patch.set_visible(False)
        grid = self._drawing.subplots(rows, panels, squeeze=False)
        self.axes = [axes for line in grid for axes in line]
        for axes in self.axes:
            _plain(axes)

    def legend(self, *, columns: int) -> None:
        """Draw one legend for the first axes, below all of them."""
        lines, names = self.axes[0].get_legend_handles_labels()
        self._drawing.legend(lines, names, loc="outside lower center", ncols=columns, **LEGEND)

    def svg(self) -> str:
        """Return the drawing as an SVG element without header and namespaces, with unique ids."""
        from matplotlib import rc_context

        text = StringIO()
        with rc_context({"svg.fonttype": "none", "svg.hashsalt": self._name}):
            self._drawing.savefig(text, format="svg", metadata={"Date": None})
        svg = text.getvalue()
        svg = svg[svg.index("<svg") :]
        svg = re.sub(r"<metadata>.*?</metadata>", "", svg, flags=re.DOTALL)
        svg = re.sub(r' xmlns(:\w+)?="[^"]*"', "", svg).replace("xlink:href", "href")
        svg = re.sub(r'(\bid="|href="#|url\(#)', rf"\g<1>{self._name}-", svg)
        svg = re.sub(r'font: ([\d.]+)px [^;"]*', r"font: \1px var(--font)", svg)
        for ink, of_page in INKS.items():
            svg = svg.replace(ink, of_page)
        return re.sub(r' width="[\d.]+pt" height="[\d.]+pt"', ' role="img"', svg, count=1)


def _plain(axes: Any) -> None:
    axes.patch.set_visible(False)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(DIM)
    axes.tick_params(colors=DIM, labelcolor=INK, labelsize=9)
    axes.grid(axis="y", color=LINE, linewidth=0.8)
    axes.set_axisbelow(True)


def _named(axes: Any, title: str, across: str, up: str) -> None:
    axes.set_title(title, color=INK, fontsize=10, loc="left")
    axes.set_xlabel(across, color=INK, fontsize=9)
    axes.set_ylabel(up, color=INK, fontsize=9)


def _counted(axes: Any) -> None:
    axes.yaxis.get_major_locator().set_params(integer=True)  # whole people only


def _papers(axes: Any, at: float, label: str) -> None:
    axes.axvline(at, color=INK, linewidth=1.2, linestyle="--", label=label)
    axes.set_ylim(top=1.2 * axes.get_ylim()[1])  # room for the legend
    axes.legend(loc="upper right", **LEGEND)


def demonstrations(document: Mapping[str, Any]) -> str:
    """Plot how many demonstrations were needed, and their lengths."""
    figure = Figure("demonstrations", 2)
    first, second = figure.axes
    within = document["random"]["exact_within"]
    shares = [within[count] for count in sorted(within)]
    spans = [share_interval(share, document["seeds"]) for share in shares]
    errors = [
        [share - low for share, (low, _) in zip(shares, spans, strict=True)],
        [high - share for share, (_, high) in zip(shares, spans, strict=True)],
    ]
    places = range(1, len(shares) + 1)
    first.bar(places, shares, color=SERIES[0], width=0.6, yerr=errors, label="by chance", **BARS)
    guided = document["guided"]["exact_after_one"]
    first.plot([1], [guided], "D", color=SERIES[1], markersize=8, label="guided", clip_on=False)
    first.set_xticks(list(places))
    first.set_ylim(0, 1.25)
    first.set_yticks([0, 0.25, 0.5, 0.75, 1])
    _named(first, "Policy exact", "demonstrations", "share of sequences")
    first.legend(loc="upper right", ncols=2, **LEGEND)
    lengths = document["behaviours"]["all"]
    second.hist(lengths, bins=range(0, max(lengths) + 6, 5), color=SERIES[0])
    second.set_xlim(left=max(0, min(lengths) - 5))
    _counted(second)
    _named(second, words.LENGTH, "behaviours", "demonstrations")
    _papers(second, document["paper"]["behaviours_per_demonstration"], "the paper's mean")
    return figure.svg()


def mistakes(rows: Sequence[Mapping[str, Any]]) -> str:
    """Plot the share of exact policies, with wrong answers and after resolving conflicts."""
    places = list(dict.fromkeys(row["placed"] for row in rows))
    figure = Figure("mistakes", len(places), height=2.8)
    for axes, place in zip(figure.axes, places, strict=True):
        some = [row for row in rows if row["placed"] == place]
        rates = [100 * row["rate"] for row in some]
        # The first line is thick with hollow markers, so that the second does not cover it.
        broad = {"linewidth": 4, "markersize": 11, "markerfacecolor": "none"}
        thin = {"linewidth": 1.2, "markersize": 4}
        for key, label, ink, form, drawn in (
            ("exact_before", "as they are", SERIES[0], "o-", broad),
            ("exact_after", "conflicts settled", SERIES[1], "s--", thin),
        ):
            axes.plot(rates, [row[key] for row in some], form, color=ink, label=label, **drawn)
        axes.set_ylim(-0.08, 1.08)
        axes.set_yticks([0, 0.25, 0.5, 0.75, 1])
        _named(axes, f"Wrong answers: {place}", "wrong answers (%)", "policy exact")
    figure.legend(columns=2)
    return figure.svg()


def optimal_shares(users: Sequence[Mapping[str, Any]]) -> str:
    """Plot Fig. 5: the percentage of optimal strategies for each user, over interactions."""
    across = min(len(users), 4)
    rows = -(-len(users) // across)
    figure = Figure("optimal", across, height=2.6 * rows, rows=rows)
    for axes, user in zip(figure.axes, users, strict=False):
        shares, one = user["optimal_share"], user["one_run"]
        times = range(1, len(shares) + 1)
        axes.plot(times, [100 * share for share in shares], color=SERIES[0], label="all runs")
        running = [100 * sum(one[: n + 1]) / (n + 1) for n in range(len(one))]
        axes.plot(
            range(1, len(running) + 1),
            running,
            color=SERIES[1],
            linestyle="--",
            linewidth=1,
            label="one run, so far",
        )
        axes.set_ylim(0, 102)
        _named(axes, f"{user['name']} ({user['best']})", "interaction", "optimal (%)")
    for axes in figure.axes[len(users) :]:
        axes.set_visible(False)
    figure.legend(columns=2)
    return figure.svg()


def before_convergence(document: Mapping[str, Any]) -> str:
    """Plot the histogram of sub-optimal strategies before convergence."""
    figure = Figure("before", height=2.8)
    (axes,) = figure.axes
    counts = document["suboptimal_before_convergence"]["all"]
    axes.hist(counts, bins=range(max(counts, default=0) + 2), color=SERIES[0], align="left")
    _counted(axes)
    _named(axes, words.BEFORE_CONVERGENCE, "strategies", "people")
    _papers(
        axes, document["paper"]["suboptimal_before_convergence"], "the paper's mean of four users"
    )
    return figure.svg()


def regrets(
    crowds: Sequence[tuple[str, Mapping[str, Mapping[str, Any]]]],
    names: Mapping[str, str],
    log_term: Mapping[str, float],
) -> str:
    """Plot the regret (in responses) of every method at every horizon, one panel per crowd.

    Args:
        crowds: (title, method -> row); the first panel also shows the Lai-Robbins log term.
        names: the names of the methods, in the order of the lines.
        log_term: the regret of the Lai-Robbins log term, by horizon.
    """
    figure = Figure("regret", len(crowds), height=3.6)
    beside = {name: 1.03 ** (place - len(names) / 2) for place, name in enumerate(names)}
    for axes, (title, methods) in zip(figure.axes, crowds, strict=True):
        for place, (name, row) in enumerate(methods.items()):
            times = [int(horizon) for horizon in row["regret"]]
            axes.errorbar(
                [time * beside[name] for time in times],  # shifted against overlaps
                list(row["regret"].values()),
                yerr=list(row["regret_se"].values()),
                color=SERIES[place % len(SERIES)],
                marker="osD^vP"[place % 6],
                markersize=4,
                label=names[name],
            )
        axes.set_xscale("log")
        axes.set_xticks(times, [str(time) for time in times])
        axes.minorticks_off()
        _named(axes, title, "interactions", "regret")
        axes.set_ylim(bottom=0)
    figure.axes[0].plot(
        [int(t) for t in log_term], list(log_term.values()), ":", color=INK, label="log term"
    )
    figure.legend(columns=3)
    return figure.svg()


MARKERS = {"expert": "X", "continue": "o", "user": "^", "teacher": "s"}
"""The marker of each class of recovery; its colour is the series at the same index."""


def faults_by_game(games: Sequence[Mapping[str, Any]], names: Mapping[str, str]) -> str:
    """Plot a line for each game, with a marker for each diagnosed fault.

    Args:
        games: each with its `number`, its `steps` and its faults.
        names: the names of the recoveries.
    """
    figure = Figure("faults", height=1.2 + 0.2 * len(games))
    (axes,) = figure.axes
    for game in games:
        axes.plot([0, game["steps"]], [game["number"]] * 2, color=LINE, linewidth=1.2, zorder=1)
    for place, (recovery, marker) in enumerate(MARKERS.items()):
        some = [
            (fault["step"], game["number"])
            for game in games
            for fault in game["faults"]
            if fault["recovery"] == recovery
        ]
        axes.plot(
            [step for step, _ in some],
            [number for _, number in some],
            marker,
            color=SERIES[place],
            markersize=6,
            label=names[recovery],
        )
    missed = [(o["step"], game["number"]) for game in games for o in game["induced"] if o["missed"]]
    if missed:
        axes.plot(*zip(*missed, strict=True), "|", color=INK, markersize=11, label="missed")
    axes.invert_yaxis()
    axes.set_yticks([game["number"] for game in games])
    axes.grid(visible=False)
    _named(axes, words.DIAGNOSED, "behaviours", "game")
    figure.legend(columns=5)
    return figure.svg()


def times_to_recover(games: Sequence[Mapping[str, Any]], names: Mapping[str, str]) -> str:
    """Plot the duration of each recovery, one row per class."""
    figure = Figure("times", height=2.4)
    (axes,) = figure.axes
    for place, (recovery, marker) in enumerate(MARKERS.items()):
        seconds = sorted(
            fault["seconds"]
            for game in games
            for fault in game["faults"]
            if fault["called_for"] == recovery and fault["seconds"] is not None
        )
        # Spread vertically, so that equal durations do not overlap.
        beside = [0.6 * (at + 1) / (len(seconds) + 1) - 0.3 for at in range(len(seconds))]
        axes.plot(seconds, [place + up for up in beside], marker, color=SERIES[place], markersize=4)
    axes.set_yticks(range(len(MARKERS)), [names[recovery] for recovery in MARKERS])
    axes.invert_yaxis()
    axes.set_xscale("symlog", linthresh=1)
    axes.set_xlim(left=-0.2)
    axes.set_xticks([0, 1, 5, 10, 25, 60, 300], ["0", "1", "5", "10", "25", "60", "300"])
    axes.minorticks_off()
    axes.grid(axis="x", color=LINE, linewidth=0.8)
    _named(axes, words.SINCE_DIAGNOSIS, "s in the simulated world", "")
    return figure.svg()
