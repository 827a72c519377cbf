"""The report of a scenario: a page with figures, tables and the paper's results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tangy_tui.experiments import figures
from tangy_tui.experiments.recovery_report import recovery
from tangy_tui.pages.page import document as page
from tangy_tui.pages.page import figure, heading, paragraph, table
from tangy_tui.text import experiments as words
from tangy_tui.text.comparison import SOURCES, compare
from tangy_tui.text.numbers import number, percent

Document = Mapping[str, Any]


def report(document: Document) -> str:
    """Return the page for the document of a scenario, made from it alone."""
    which = document["experiment"]
    parts = {1: _learning, 2: _persuasion, 3: recovery}[which](document)
    return page(
        words.TITLES[which],
        words.subtitle(document),
        [*_beside(document), *parts, *_made_from(document)],
    )


def _beside(document: Document) -> Iterator[str]:
    yield heading(words.BESIDE)
    yield table(
        ("", "paper", "here", "which is", "where and why they differ"),
        [(row.what, row.paper, row.here, row.source, row.words) for row in compare(document)],
    )
    yield paragraph("; ".join(f"{name}: {worth}" for name, worth in SOURCES.items()) + ".")


def _made_from(document: Document) -> Iterator[str]:
    yield heading(words.MADE_FROM)
    yield table(("setting", "value"), document["settings"].items())
    yield table(("version of", "is"), [*document["versions"].items(), ("code", document["code"])])
    yield paragraph(words.SAME_ANYWHERE)


# ------------------------------------------------------------------------------- scenario 1


def _learning(document: Document) -> Iterator[str]:
    yield heading(words.DEMONSTRATIONS)
    yield figure(
        figures.demonstrations(document),
        words.demonstrations_caption(document["seeds"]),
    )
    yield paragraph(words.EXACT)
    by_users = document["guided"]["by_users"]
    yield table(
        ("people in a guided game", *by_users),
        [("exact after one", *(percent(share) for share in by_users.values()))],
    )
    yield paragraph(words.flagged_words(document["flagged_after_each"]))
    yield from _teachers(document["teachers"])
    yield from _mistakes(document["teachers"]["with_mistakes"])
    if document["typing"] is not None:
        yield from _typing(document["typing"])


def _teachers(teachers: Document) -> Iterator[str]:
    yield heading(words.TEACHERS)
    yield paragraph(words.teachers_words(teachers))
    yield table(
        (
            "teacher", "commands wrong", "left in", "conflicts", "games",
            "exact after three", "conflicts settled", "at the end",
        ),
        [
            (
                row["style"],
                percent(row["mistakes_made"]),
                percent(row["mistakes_kept"]),
                number(row["conflicts"]["mean"]),
                number(row["games"]["mean"]),
                *(percent(row["exact"][when]) for when in ("three", "three_resolved", "end")),
            )
            for row in teachers["each"]
        ],
    )  # fmt: skip


def _mistakes(rows: Any) -> Iterator[str]:
    yield heading("Wrong answers")
    yield figure(
        figures.mistakes(rows),
        words.mistakes_caption(rows[0]["n"]),
    )
    yield paragraph(words.mistakes_words(rows))
    yield table(
        (
            "wrong", "where", "n", "conflicts", "found", "no right answer left",
            "wrong decisions flagged", "right flagged", "exact", "exact once settled",
            "right flagged once settled",
        ),
        [
            (
                percent(row["rate"]),
                row["placed"],
                row["n"],
                row["conflicts"],
                percent(row["conflicts_found"]),
                row["no_right_answer_left"],
                _of(row["before"]["wrong_flagged"], row["before"]["wrong"]),
                percent(row["before"]["right_flagged"]),
                percent(row["exact_before"]),
                percent(row["exact_after"]),
                percent(row["after"]["right_flagged"]),
            )
            for row in rows
        ],
    )  # fmt: skip


def _of(share: float | None, n: int) -> str:
    return f"{percent(share)} of {n}" if n else "none wrong"


def _typing(typed: Document) -> Iterator[str]:
    yield heading(words.MINUTES)
    yield from map(paragraph, words.typing_words(typed))


# ------------------------------------------------------------------------------- scenario 2


def _persuasion(document: Document) -> Iterator[str]:
    before = document["suboptimal_before_convergence"]
    yield heading(words.OPTIMAL)
    yield figure(
        figures.optimal_shares(document["users"]),
        words.optimal_caption(document["groups"]),
    )
    yield heading("Before convergence")
    yield figure(
        figures.before_convergence(document),
        words.convergence_caption(before),
    )
    if document.get("other_choices"):
        yield from _other_choices(document["other_choices"])
    yield from _methods(document)


def _other_choices(choices: Sequence[Document]) -> Iterator[str]:
    yield heading(words.OTHERWISE)
    yield paragraph(words.OTHER_CHOICES)
    yield table(
        ("complies with the preferred", "with another", "in a row", "mean before", "never", ""),
        [
            (
                number(one["preferred"]),
                number(one["other"]),
                one["in_a_row"],
                number(one["mean"], 1),
                one["never"],
                "chosen here" if one["used"] else "",
            )
            for one in choices
        ],
    )


def _methods(document: Document) -> Iterator[str]:
    crowds = document["crowds"]
    yield heading(words.OTHER_METHODS)
    yield paragraph(words.REGRET)
    for problem in document.get("not_compared", {}).values():
        yield paragraph(words.not_compared(problem))
    named = [("even", "algorithms"), ("uneven", "uneven"), ("drifting", "drifting")]
    yield figure(
        figures.regrets(
            [(name, document[key]) for name, key in named],
            {name: words.method_words(name) for name in document["algorithms"]},
            document["lai_robbins"]["regret"],
        ),
        words.REGRET_CAPTION,
    )
    for name, key in named:
        first = next(iter(document[key].values()))
        yield paragraph(words.crowd_words(name, crowds[name], first["n"]))
        yield _regret_table(document[key], first, document["change"])
        yield paragraph(words.prior_words(document[key]))


def _regret_table(methods: Document, first: Document, change: int) -> str:
    """Return the regret table of a crowd; the columns are the same for all crowds."""
    horizons = list(first["regret"])
    base = first["regret"]
    return table(
        (
            "method",
            *(f"regret at {horizon}" for horizon in horizons),
            "of the paper's at 60",
            "optimal",
            f"optimal in {change + 1} to {2 * change}",
        ),
        [
            (
                words.method_words(name),
                *(
                    f"{number(row['regret'][h])} \N{PLUS-MINUS SIGN} {number(row['regret_se'][h])}"
                    for h in horizons
                ),
                number(row["regret"]["60"] / base["60"]) if base["60"] else "",
                percent(row["optimal_share"]),
                percent(row["optimal_share_after_change"]),
            )
            for name, row in methods.items()
        ],
    )
