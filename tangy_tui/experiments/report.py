"""The report of a scenario: its document as a page with figures, tables and the paper beside."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tangy_tui.experiments import figures
from tangy_tui.experiments.comparison import SOURCES, compare
from tangy_tui.experiments.recovery_report import recovery
from tangy_tui.pages.page import document as page
from tangy_tui.pages.page import figure, heading, paragraph, table
from tangy_tui.text.numbers import counted, number, percent

Document = Mapping[str, Any]

TITLES = {
    1: "Learning an activity from demonstrations",
    2: "Learning how to persuade",
    3: "Noticing faults, and recovering from them",
}
METHOD_WORDS = {
    "thompson": "Thompson sampling (the paper's)",
    "bayes_ucb": "Bayes-UCB",
    "thompson_prior": "Thompson, from earlier people",
    "bayes_ucb_prior": "Bayes-UCB, from earlier people",
    "thompson_forgetting": "Thompson, forgetting",
    "bayes_ucb_forgetting": "Bayes-UCB, forgetting",
}


def report(document: Document) -> str:
    """Return the page for the document of a scenario; it is made from nothing else."""
    which = document["experiment"]
    parts = {1: _learning, 2: _persuasion, 3: recovery}[which](document)
    where = "in simulation" if document.get("simulated", True) else "on a bench of devices"
    version = document["versions"]["tangy"]
    subtitle = f"Scenario {which} of the paper, run again {where} by Tangy {version}."
    return page(TITLES[which], subtitle, [*_beside(document), *parts, *_made_from(document)])


def _beside(document: Document) -> Iterator[str]:
    yield heading("The paper and here")
    yield table(
        ("", "paper", "here", "which is", "where and why they differ"),
        [(row.what, row.paper, row.here, row.source, row.words) for row in compare(document)],
    )
    yield paragraph("; ".join(f"{name}: {words}" for name, words in SOURCES.items()) + ".")


def _made_from(document: Document) -> Iterator[str]:
    yield heading("Settings and versions")
    yield table(("setting", "value"), document["settings"].items())
    yield table(("version of", "is"), [*document["versions"].items(), ("code", document["code"])])
    yield paragraph("The same settings, seeds and versions give the same figures on any machine.")


# ------------------------------------------------------------------------------- scenario 1


def _learning(document: Document) -> Iterator[str]:
    seeds = document["seeds"]
    yield heading("How many demonstrations")
    yield figure(
        figures.demonstrations(document),
        f"{counted(seeds, 'sequence')} of games; the bars of uncertainty are 95% intervals.",
    )
    yield paragraph(
        "A policy counts as exact when it does what is expected in every joint state that can "
        "come about, shown or not. In a guided game people err, ask and hide their cards so that "
        "every situation comes about once; otherwise that is left to chance."
    )
    by_users = document["guided"]["by_users"]
    yield table(
        ("people in a guided game", *by_users),
        [("exact after one", *(percent(share) for share in by_users.values()))],
    )
    flags = document["flagged_after_each"]
    yield paragraph(
        f"After each demonstration by chance, {flags['wrong']} decisions were wrong, of which "
        f"{percent(flags['wrong_flagged'])} were flagged (Tangy would ask instead of acting); "
        f"{flags['right']} were right, of which {percent(flags['right_flagged'])} were flagged."
    )
    yield from _teachers(document["teachers"])
    yield from _mistakes(document["teachers"]["with_mistakes"])
    if document["typing"] is not None:
        yield from _typing(document["typing"])


def _teachers(teachers: Document) -> Iterator[str]:
    yield heading("Different teachers")
    yield paragraph(
        f"{counted(teachers['groups'], 'group')} of {teachers['count']} simulated teachers, each "
        "with games of their own. They go on after the third while a situation was not shown yet, "
        "and then say of each conflict which answer is right."
    )
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
        f"{counted(rows[0]['n'], 'sequence')} for each point. Where both are the same, the dashes "
        "lie on the broad line.",
    )
    yield paragraph(
        "A share of the answers is made wrong: anywhere, in the commonest situation, or in the "
        "rarest ones, where each keeps one right answer. What was only ever answered wrongly "
        "contradicts nothing, and cannot be found in demonstrations alone. While a conflict is "
        "open its decision is flagged, right or wrong: Tangy asks about right ones, too. "
        + _asked_in_vain(rows)
    )
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


def _asked_in_vain(rows: Any) -> str:
    """Say which share of the right decisions is flagged, before conflicts are settled and after."""

    def share(when: str) -> float | None:
        flags = [row[when] for row in rows if row["rate"] and row[when]["right"]]
        right = sum(flag["right"] for flag in flags)
        return sum(f["right"] * f["right_flagged"] for f in flags) / right if right else None

    return (
        f"Before conflicts are settled {percent(share('before'))} of the right decisions are "
        f"flagged, and afterwards {percent(share('after'))}."
    )


def _of(share: float | None, n: int) -> str:
    return f"{percent(share)} of {n}" if n else "none wrong"


def _typing(typed: Document) -> Iterator[str]:
    pace, slow = typed["pace"], typed["ordinary"]
    yield heading("Minutes to teach")
    yield paragraph(
        f"{typed['steps']:.0f} behaviours were taught by {typed['keys']:.0f} keys in "
        f"{number(typed['minutes'])} minutes of real time, through the program in a terminal; "
        f"{number(60 * typed['machine_minutes'], 1)} s of these were the program's own "
        f"({number(typed['start_seconds'], 1)} s to start). Assumed of the typist: "
        f"{pace['keys']:g} keys a second, {pace['look']:g} s from seeing a step done to the next "
        f"key, {pace['read']:g} s from seeing a question to the y, no slip, the shortest phrase "
        "of each behaviour, and the arrow for the same command again."
    )
    yield paragraph(
        f"At {slow['keys']:g} keys a second, {slow['look']:g} s to look and {slow['read']:g} s to "
        f"read, the same game would take {number(slow['minutes'], 1)} minutes (worked out, not "
        "measured)."
    )


# ------------------------------------------------------------------------------- scenario 2


def _persuasion(document: Document) -> Iterator[str]:
    before = document["suboptimal_before_convergence"]
    yield heading("Optimal strategies over interactions")
    yield figure(
        figures.optimal_shares(document["users"]),
        f"For each user, the share of {counted(document['groups'], 'run')} in which the "
        "interaction's strategy was the user's best (line), and one run's percentage so far "
        "(dashes).",
    )
    yield heading("Before convergence")
    yield figure(
        figures.before_convergence(document),
        f"{counted(before['n'], 'person', 'people')} who converged, which is who had "
        f"{before['converged_means_in_a_row']} optimal strategies in a row.",
    )
    if document.get("other_choices"):
        yield from _other_choices(document["other_choices"])
    yield from _methods(document)


def _other_choices(choices: Sequence[Document]) -> Iterator[str]:
    yield heading("Had it been chosen otherwise")
    yield paragraph(
        "The paper says neither how probably its people complied, nor how many optimal strategies "
        "in a row count as convergence. Without games, for people of whom each prefers one "
        "strategy:"
    )
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
    yield heading("Other ways to choose")
    yield paragraph(
        "Without games: what a person would answer to each strategy at each interaction is drawn "
        "once, and every method meets the same. Regret is the compliance lost on average by not "
        "always using the best strategy."
    )
    named = [("even", "algorithms"), ("uneven", "uneven"), ("drifting", "drifting")]
    yield figure(
        figures.regrets(
            [(name, document[key]) for name, key in named],
            METHOD_WORDS,
            document["lai_robbins"]["regret"],
        ),
        "Regret at 23 (twenty games), 60 and 300 interactions, with standard errors. The dotted "
        "log term of Lai and Robbins says how regret must grow in the long run; it is no bound "
        "at so few interactions.",
    )
    for name, key in named:
        first = next(iter(document[key].values()))
        means = crowds[name]["means"]
        rates = f" (means {', '.join(f'{mean:g}' for mean in means)})" if means else ""
        yield paragraph(f"{name.capitalize()}: {crowds[name]['words']}{rates}; n = {first['n']}.")
        yield _regret_table(document[key], first, document["change"])
        yield paragraph(_with_prior(document[key]))


def _with_prior(methods: Document) -> str:
    """Say of each method by its name what it gains by beginning from earlier people."""
    gains = []
    for name in ("thompson", "bayes_ucb"):
        alone, lent = (methods[n]["regret"]["60"] for n in (name, f"{name}_prior"))
        share = f" ({percent(lent / alone)})" if alone else ""
        gains.append(f"{METHOD_WORDS[name]} {number(lent)} instead of {number(alone)}{share}")
    return f"Regret at 60 when it begins from earlier people: {'; '.join(gains)}."


def _regret_table(methods: Document, first: Document, change: int) -> str:
    """Return a table of the methods; those of all crowds have the same columns."""
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
                METHOD_WORDS[name],
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
