"""Captions and remarks in the reports of the experiments."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tangy_tui.text.numbers import counted, number, percent
from tangy_tui.text.people import method_name

Document = Mapping[str, Any]
"""The JSON document of a scenario, or a part of it."""

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
BESIDE = "The paper and here"
MADE_FROM = "Settings and versions"
SAME_ANYWHERE = "The same settings, seeds and versions give the same figures on any machine."

# ------------------------------------------------------------------------------- scenario 1

LENGTH = "Length of a demonstration by chance"
DEMONSTRATIONS = "How many demonstrations"
TEACHERS = "Different teachers"
MINUTES = "Minutes to teach"
EXACT = (
    "A policy counts as exact when it does what is expected in every joint state that can "
    "come about, shown or not. In a guided game people err, ask and hide their cards so that "
    "every situation comes about once; otherwise that is left to chance."
)


def subtitle(document: Document) -> str:
    """Name the scenario, where it ran, and the version."""
    where = "in simulation" if document.get("simulated", True) else "on a bench of devices"
    version = document["versions"]["tangy"]
    return f"Scenario {document['experiment']} of the paper, run again {where} by Tangy {version}."


def demonstrations_caption(seeds: int) -> str:
    """Caption the figure of demonstrations."""
    return f"{counted(seeds, 'sequence')} of games; the bars of uncertainty are 95% intervals."


def flagged_words(flags: Document) -> str:
    """Tell how many right and wrong decisions were flagged after each demonstration."""
    return (
        f"After each demonstration by chance, {flags['wrong']} decisions were wrong, of which "
        f"{percent(flags['wrong_flagged'])} were flagged (Tangy would ask instead of acting); "
        f"{flags['right']} were right, of which {percent(flags['right_flagged'])} were flagged."
    )


def teachers_words(teachers: Document) -> str:
    """Describe the simulated teachers, and how long they continued."""
    return (
        f"{counted(teachers['groups'], 'group')} of {teachers['count']} simulated teachers, each "
        "with games of their own. They go on after the third while a situation was not shown yet, "
        "and then say of each conflict which answer is right."
    )


def mistakes_caption(sequences: int) -> str:
    """Caption the figure of wrong answers."""
    return (
        f"{counted(sequences, 'sequence')} for each point. Where both are the same, the dashes "
        "lie on the broad line."
    )


def mistakes_words(rows: Sequence[Document]) -> str:
    """Tell the effect of wrong answers, and how often Tangy asks in vain."""
    return (
        "A share of the answers is made wrong: anywhere, in the commonest situation, or in the "
        "rarest ones, where each keeps one right answer. What was only ever answered wrongly "
        "contradicts nothing, and cannot be found in demonstrations alone. While a conflict is "
        "open its decision is flagged, right or wrong: Tangy asks about right ones, too. "
        + _asked_in_vain(rows)
    )


def _asked_in_vain(rows: Sequence[Document]) -> str:
    """Tell which share of right decisions is flagged, before and after conflicts are settled."""

    def share(when: str) -> float | None:
        flags = [row[when] for row in rows if row["rate"] and row[when]["right"]]
        right = sum(flag["right"] for flag in flags)
        return sum(f["right"] * f["right_flagged"] for f in flags) / right if right else None

    return (
        f"Before conflicts are settled {percent(share('before'))} of the right decisions are "
        f"flagged, and afterwards {percent(share('after'))}."
    )


def typing_words(typed: Document) -> tuple[str, str]:
    """Tell how long teaching took, and how long it would take a slow typist."""
    pace, slow = typed["pace"], typed["ordinary"]
    return (
        f"{typed['steps']:.0f} behaviours were taught by {typed['keys']:.0f} keys in "
        f"{number(typed['minutes'])} minutes of real time, through the program in a terminal; "
        f"{number(60 * typed['machine_minutes'], 1)} s of these were the program's own "
        f"({number(typed['start_seconds'], 1)} s to start). Assumed of the typist: "
        f"{pace['keys']:g} keys a second, {pace['look']:g} s from seeing a step done to the next "
        f"key, {pace['read']:g} s from seeing a question to the y, no slip, the shortest phrase "
        "of each behaviour, and the arrow for the same command again.",
        f"At {slow['keys']:g} keys a second, {slow['look']:g} s to look and {slow['read']:g} s to "
        f"read, the same game would take {number(slow['minutes'], 1)} minutes (worked out, not "
        "measured).",
    )


# ------------------------------------------------------------------------------- scenario 2

BEFORE_CONVERGENCE = "Sub-optimal strategies before convergence"
OPTIMAL = "Optimal strategies over interactions"
OTHERWISE = "Had it been chosen otherwise"
OTHER_METHODS = "Other ways to choose"
OTHER_CHOICES = (
    "The paper says neither how probably its people complied, nor how many optimal strategies "
    "in a row count as convergence. Without games, for people of whom each prefers one "
    "strategy:"
)
REGRET = (
    "Without games: what a person would answer to each strategy at each interaction is drawn "
    "once, and every method meets the same. Regret is the compliance lost on average by not "
    "always using the best strategy."
)
REGRET_CAPTION = (
    "Regret at 23 (twenty games), 60 and 300 interactions, with standard errors. The dotted "
    "log term of Lai and Robbins says how regret must grow in the long run; it is no bound "
    "at so few interactions."
)


def optimal_caption(groups: int) -> str:
    """Caption the figure of optimal strategies."""
    return (
        f"For each user, the share of {counted(groups, 'run')} in which the "
        "interaction's strategy was the user's best (line), and one run's percentage so far "
        "(dashes)."
    )


def convergence_caption(before: Document) -> str:
    """Tell how many converged."""
    return (
        f"{counted(before['n'], 'person', 'people')} who converged, which is who had "
        f"{before['converged_means_in_a_row']} optimal strategies in a row."
    )


def crowd_words(name: str, crowd: Document, n: int) -> str:
    """Name the simulated people of a table of regret."""
    means = crowd["means"]
    rates = f" (means {', '.join(f'{mean:g}' for mean in means)})" if means else ""
    return f"{name.capitalize()}: {crowd['words']}{rates}; n = {n}."


def method_words(name: str) -> str:
    """Return the words for a compared method, by its name in the document."""
    return METHOD_WORDS.get(name) or method_name(name)


def not_compared(problem: str) -> str:
    """Tell which method of another package was left out, and why."""
    return f"Not compared: {problem}"


def prior_words(methods: Document) -> str:
    """Tell for each method how much it gains from a prior of earlier people."""
    gains = []
    for name in ("thompson", "bayes_ucb"):
        alone, lent = (methods[n]["regret"]["60"] for n in (name, f"{name}_prior"))
        share = f" ({percent(lent / alone)})" if alone else ""
        gains.append(f"{METHOD_WORDS[name]} {number(lent)} instead of {number(alone)}{share}")
    return f"Regret at 60 when it begins from earlier people: {'; '.join(gains)}."


# ------------------------------------------------------------------------------- scenario 3

DIAGNOSED = "Faults that were diagnosed"
SINCE_DIAGNOSIS = "From the diagnosis until it was recovered from"
BY_KIND = "Kind by kind"
BY_GAME = "Faults, game by game"
TIMES = "Time to recover"
TIMES_CAPTION = "A mark for each fault; the axis is even up to 1 s, and logarithmic from there on."
SIMULATED = (
    "What devices report when something is wrong is simulated, so that a right cause proves the "
    "rules, and no sensor. "
)
BENCHED = (
    "The devices are those of a bench: cards, faces and signs are rendered, scans are computed, "
    "and all of it goes through the drivers and the perception of a real robot. "
)
LIMITS = (
    "Simulated people at the table help with a probability of "
    "{help:g}, experts always mend what was diagnosed, and a scripted teacher answers at once and "
    "rightly: how long a real one takes is not in these times. One fault is induced at a time; "
    "none comes with the behaviour that ends a game, or while a teacher is asked. It takes three "
    "requests to tell that somebody never complies, so that is not noticed at once; and it "
    "may be diagnosed again in each visit: each is an instance, as in the paper's count of "
    "recoveries, and no false alarm."
)


def by_game_caption(drawn: int, games: int) -> str:
    """Caption the figure of faults, with the number of games drawn."""
    words = f"the first {drawn} of " if drawn < games else ""
    return (
        f"A line for each game ({words}{counted(games, 'game')}), as long as it had "
        "behaviours; a mark where a fault was diagnosed, by the recovery that was chosen first."
    )


def instances_words(false_alarms: int) -> str:
    """Define an instance of a fault, and count the false alarms."""
    return (
        "An instance is a diagnosis of something that was induced; it is recovered from if the "
        "right class of recovery was chosen for it, and it was over in the end, or borne where "
        f"that was planned. There were {counted(false_alarms, 'false alarm')}: "
        "diagnoses of something that was not induced."
    )


def limits_words(document: Document) -> str:
    """Tell what the figures of recovery prove, and what they do not."""
    where = SIMULATED if document["simulated"] else BENCHED
    return where + LIMITS.format(help=document["settings"]["P(people at the table help)"])


def left_words(kinds: Sequence[str]) -> str:
    """Name the planned faults that did not occur."""
    return f"Planned, but did not come about before its games ended: {', '.join(kinds)}."


def stopped_words(reason: str, games: int) -> str:
    """Tell how many games were stopped early, and why."""
    return f"Stopped before the end, {counted(games, 'game')}: {reason}"


def behaviours_words(document: Document) -> str:
    """Count the behaviours and interactions of a game, and those not carried out."""
    return (
        f"{number(document['behaviours_per_game'])} behaviours and "
        f"{number(document['interactions_per_user_game'])} interactions of each user in a game. "
        "What was not carried out is what a fault prevented; it was done again afterwards."
    )
