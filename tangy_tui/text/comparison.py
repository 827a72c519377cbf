"""The paper's figures beside ours, with the reasons for differences.

Words depend on the numbers, and only differences get a reason. Only a predicted figure can agree:
one that was chosen or fitted tests nothing, and its words tell that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Literal

from tangy_tui.text.numbers import counted, number, percent

SURE = 2.0
"""Differences of more standard errors than this are not attributed to chance."""

TO_ITS_END = "to its end"
"""The end of a game that was not stopped."""

ENOUGH = 20
"""From this n on, a share is also written as a percentage."""

Document = Mapping[str, Any]


Source = Literal["predicted", "fitted", "chosen", "measured"]
SOURCES: Mapping[Source, str] = MappingProxyType(
    {
        "predicted": "no value was fitted to this figure: it tests the program",
        "fitted": "a value was fitted to this figure: it tests nothing",
        "chosen": "it depends on a choice that the paper leaves open: other choices change it",
        "measured": "a time, measured where the program ran",
    }
)
"""Where a figure comes from, and how much it proves."""


@dataclass(frozen=True)
class ComparisonRow:
    """One row: the quantity, the paper's figure, ours, and a remark.

    `source` is the origin of our figure (see `SOURCES`).
    """

    what: str
    paper: str
    here: str
    words: str
    source: Source = "predicted"


WHY_A, WHY_B = "Why A does that", "Why B does that"


def compare(document: Document) -> list[ComparisonRow]:
    """Return the rows for the document of a scenario."""
    return {1: _learning, 2: _persuasion, 3: _recovery}[document["experiment"]](document)


def of_all(share: float | None, n: int) -> str:
    """Format a share as k of n, with the percentage if n is large enough."""
    if share is None:
        return "\N{EN DASH}"
    return f"{round(share * n)} of {n}" + (f" ({percent(share)})" if n >= ENOUGH else "")


def _mean(summary: Mapping[str, Any]) -> str:
    return (
        f"{number(summary['mean'])} \N{PLUS-MINUS SIGN} {number(summary['se'])} "
        f"(standard error, n = {summary['n']})"
    )


def _set_by(here: float, paper: float, error: float, why: str) -> str:
    """Compare a fitted mean with the value it was fitted to."""
    if abs(here - paper) <= SURE * error:
        return f"Within two standard errors. {why}"
    return f"{'Higher' if here > paper else 'Lower'} by {abs(here - paper):.2g}. {why}"


def _one_run(here: float | None, paper: float, runs: Mapping[str, Any]) -> str:
    """Tell whether the paper's single run could come from the distribution of our runs."""
    if here is None:
        return "Nobody converged here, so there is nothing to compare."
    chance = f"a mean of four users {_varies(runs['sd'], runs['n'])}"
    if runs["n"] > 1 and abs(here - paper) <= SURE * runs["sd"]:
        return f"Within the spread of single runs: {chance}."
    return f"{'Higher' if here > paper else 'Lower'} by {abs(here - paper):.2g}, and {chance}."


def _chosen(document: Document) -> str:
    """Tell which settings of Scenario 2 were chosen, and how far other choices move its figure."""
    used = (
        "Neither how often its users complied nor what counted as convergence is in the paper. "
        f"The {number(document['preferred'])} for the preferred strategy, "
        f"{number(document['other'])} for another, and "
        f"{document['suboptimal_before_convergence']['converged_means_in_a_row']} in a row were "
        "chosen with its figure in view, so this is no test"
    )
    others = [
        one["mean"]
        for one in document.get("other_choices", ())
        if not one["used"] and one["mean"] is not None
    ]
    if not others:
        return f"{used}."
    low, high = number(min(others), 1), number(max(others), 1)
    return f"{used}: {counted(len(others), 'other choice')} gave {low} to {high}."


def _varies(deviation: float, runs: int) -> str:
    if runs < 2:
        return "varies between runs, by how much one run cannot say"
    return f"varies by {number(deviation)} (standard deviation) between runs"


def _rising(users: Sequence[Mapping[str, Any]]) -> str:
    """Tell for whom the share of optimal strategies rises from the first quarter to the last."""
    level = []
    for user in users:
        shares = user["optimal_share"]
        size = max(1, len(shares) // 4)
        if sum(shares[-size:]) <= sum(shares[:size]):
            level.append(user["name"])
    return f"Does not rise for {', '.join(level)}." if level else "Rises for every user, too."


def _learning(document: Document) -> list[ComparisonRow]:
    paper, behaviours = document["paper"], document["behaviours"]
    within, guided = document["random"]["exact_within"], document["guided"]
    three = str(paper["demonstrations"])
    teachers, typed = document["teachers"], document["typing"]
    alike, groups, seeds = teachers["identical_share"], teachers["groups"], document["seeds"]

    def some(share: float) -> str:
        return percent(share) if seeds >= ENOUGH else str(round(share * seeds))

    def people(count: str) -> str:
        return counted(int(count), "person", "people")

    return [
        ComparisonRow(
            "Demonstrations needed, games by chance",
            f"{three} (one teacher, one sequence of games)",
            f"exact after 1, 2, 3, 4: {', '.join(some(within[n]) for n in sorted(within))} "
            f"of {counted(seeds, 'sequence')}",
            f"Sequences in which {three} are enough: {of_all(within[three], seeds)}; in which one "
            f"alone is: {of_all(within['1'], seeds)}. How many it takes is a matter of luck with "
            "the games, so one sequence cannot say.",
        ),
        ComparisonRow(
            "Demonstrations needed when one shows every situation",
            str(paper["demonstrations_all_shown"]),
            f"exact after 1: {percent(guided['exact_after_one'])} "
            f"({', '.join(f'{people(n)} {percent(s)}' for n, s in guided['by_users'].items())})",
            "Agrees." if guided["exact_after_one"] == 1 else "Some needed more: see the table.",
        ),
        ComparisonRow(
            "Behaviours in a demonstration",
            str(paper["behaviours_per_demonstration"]),
            _mean(behaviours),
            _set_by(
                behaviours["mean"],
                paper["behaviours_per_demonstration"],
                behaviours["se"],
                "How often simulated people ask for help in a teaching game was set by this "
                "figure, so it is no test of the simulator.",
            ),
            "fitted",
        ),
        ComparisonRow(
            "Policies of five teachers",
            "the same",
            f"groups of {teachers['count']} in which all are the same: "
            f"{of_all(alike['end'], groups)}; after exactly {three} games "
            f"{of_all(alike['three'], groups)}, with conflicts settled "
            f"{of_all(alike['three_resolved'], groups)}",
            "The paper's teachers are not said to have erred; these get up to 5% of their "
            "commands wrong, and go on until every situation was shown.",
        ),
        ComparisonRow(
            "Minutes to teach a game",
            str(paper["minutes_to_teach"]),
            _typed(typed),
            "Not measured in this run (--no-typing)."
            if typed is None
            else "The paper's teachers were new to it, spoke, and watched a simulated robot; here "
            "a typist who knows every command works as fast as is sensible, so this is the best "
            "that the program allows. "
            f"At an ordinary pace it would be {number(typed['ordinary']['minutes'], 1)} minutes.",
            "measured",
        ),
    ]


def _typed(typed: Mapping[str, Any] | None) -> str:
    if typed is None:
        return "\N{EN DASH}"
    return (
        f"{number(typed['minutes'])} for {typed['steps']:.0f} behaviours, of which the program "
        f"took {number(typed['machine_minutes'])}"
    )


def _persuasion(document: Document) -> list[ComparisonRow]:
    paper, before = document["paper"], document["suboptimal_before_convergence"]
    four, rate = document["four_users"], document["interactions_per_user_game"]
    last = [user["optimal_share"][-1] for user in document["users"]]
    never = f"; {before['never']} never converged" if before["never"] else ""
    asked = paper["interactions_per_user_game"]
    return [
        ComparisonRow(
            "Sub-optimal strategies before convergence",
            f"{paper['suboptimal_before_convergence']} (mean of four users, one run)",
            f"{_mean(before)}, standard deviation {number(before['sd'])} between people{never}",
            " ".join(
                (
                    _one_run(before["mean"], paper["suboptimal_before_convergence"], four),
                    _chosen(document),
                )
            ),
            "chosen",
        ),
        ComparisonRow(
            "Interactions of a user in a game",
            str(asked),
            f"{number(rate, 3)} ({counted(document['games'], 'game')})",
            f"{abs(rate / asked - 1):.1%} {'more' if rate > asked else 'fewer'}; a mean over "
            f"twenty games {_varies(document['interactions_sd_of_twenty_games'], four['n'])}. "
            "The rates of the simulated people were fitted to the twenty "
            "games of Table II, whose counts give 90 interactions of four people.",
            "fitted",
        ),
        ComparisonRow(
            "Optimal strategies over interactions (Fig. 5)",
            "rises to all of them, for each user",
            f"{', '.join(percent(share) for share in last)} at interaction "
            f"{max(len(user['optimal_share']) for user in document['users'])}, by user",
            f"{_rising(document['users'])} The paper draws one run of each user; here it is the "
            f"share of {counted(document['groups'], 'run')}. Thompson sampling never stops "
            "exploring altogether, so the share comes near to 100% and does not stay there.",
        ),
    ]


RECOVERIES = {
    "expert": "Critical: an expert is asked",
    "continue": "Non-critical: Tangy goes on",
    "user": "Non-critical: a user is asked",
    "teacher": "Non-critical: a teacher is asked",
}


SIMULATED = (
    "What devices report is simulated: this tests the rules and what follows from them, and no "
    "sensor."
)
BENCHED = (
    "Devices are simulated, what they report is not: it came from rendered pictures and scans, "
    "over the wires of real devices."
)


def _recovery(document: Document) -> list[ComparisonRow]:
    paper, games = document["paper"], document["games"]
    scale = games / paper["games"]
    rows = [
        ComparisonRow(
            RECOVERIES[here["recovery"]],
            f"{there['instances']} in {paper['games']} games, success {percent(there['success'])}",
            f"{here['instances']} in {games}, success {percent(here['success'])}",
            _recovered(here, there["instances"] * scale),
            "chosen",
        )
        for there, here in zip(paper["faults"], document["faults"], strict=True)
    ]
    behaviours = sum(row["instances"] for row in paper["rows"]) / paper["games"]
    mean = document["behaviours_per_game"]
    alarms, missed = document["false_alarms"], document["missed"]
    return [
        *rows,
        ComparisonRow(
            "Faults that were missed, and false alarms",
            "not said",
            f"{missed} of {document['induced']} missed; {counted(alarms, 'false alarm')}",
            SIMULATED if document["simulated"] else BENCHED,
        ),
        ComparisonRow(
            "Behaviours in a game",
            number(behaviours),
            number(mean),
            f"{abs(mean / behaviours - 1):.0%} {'more' if mean > behaviours else 'fewer'}. "
            "Repairs take time in which people ask for help, and Tangy repeats what a fault "
            "prevented. The rates of the simulated people were fitted to games without "
            "faults of this length.",
            "fitted",
        ),
        ComparisonRow(
            "Games played to their end",
            f"{paper['games']} of {paper['games']}",
            of_all(document["ended"].get(TO_ITS_END, 0) / games, games),
            "Here every expert mends what was diagnosed; the others are listed below."
            if document["ended"].get(TO_ITS_END, 0) < games
            else "Here every expert mends what was diagnosed.",
            "chosen",
        ),
    ]


def _recovered(row: Mapping[str, Any], asked: float) -> str:
    """Count the induced faults, and explain how instances differ from them."""
    words = [f"{counted(row['induced'], 'fault')} induced, a number that was chosen"]
    if row["again"]:
        words.append(f"{row['again']} of them diagnosed once more")
    if row["missed"]:
        words.append(f"{row['missed']} missed")
    if round(asked) != row["induced"]:
        words.append(f"the paper's share would be {asked:.0f}")
    if row["escalated"]:
        words.append(f"{row['escalated']} needed more than the first recovery")
    return "; ".join(words) + "."
