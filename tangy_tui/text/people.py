"""Words for people: what works with each person, with how much data, and manual changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.people_records import FeedbackGiven, ResponseVoided, StrategySwitched
from tangy_tui.text.numbers import counted, of_times
from tangy_tui.text.times import ago, on_day

if TYPE_CHECKING:
    from tangy_profiles.beliefs import Beliefs, Beta
    from tangy_profiles.events import EventRecord
    from tangy_profiles.persuading import MethodName
    from tangy_profiles.store import Event
    from tangy_tui.interaction.feedback import FeedbackEntry
    from tangy_tui.interaction.record import PersonSummary

SELDOM = 0.5
"""A best strategy with a lower mean does not count as working."""


def sentence(record: PersonSummary) -> str:
    """Tell in one line what works with a person, with how much data, and when last seen."""
    return _what_works(record) + (
        f", last seen {ago(record.seen, record.now)}" if record.seen is not None else ""
    )


def _what_works(record: PersonSummary) -> str:
    name, best = record.person.name, record.leading
    responses = sum(belief.trials for belief in record.beliefs.values())
    complied = sum(belief.complied for belief in record.beliefs.values())
    if len(record.on) == 1:
        return _only(record)
    if responses and not complied:
        return f"nothing has worked with {name} yet: {complied} of {responses}"
    if best is None:
        if not responses:
            return f"nothing is known of {name} yet"
        return f"not clear yet what works with {name}: {counted(responses, 'response')} so far"
    belief = record.beliefs[best]
    if not belief.trials:
        if not responses:
            return f"nothing is known of {name} yet; {best} worked best with earlier people"
        return f"{best} is yet to be tried with {name}: others {complied} of {responses}"
    if not belief.complied:
        return f"not clear yet what works with {name}: {complied} of {responses} so far"
    if record.settled != best:
        return f"{best} may work best with {name}: {tally(belief)} so far"
    if belief.mean < SELDOM:
        return f"{best} works best with {name}, though seldom: {tally(belief)}"
    return f"{best} works with {name}: {tally(belief)}"


def _only(record: PersonSummary) -> str:
    """Tell the counts of the only strategy that is on, since one cannot be the best."""
    (only,) = record.on
    name, belief = record.person.name, record.beliefs[only]
    if record.known.off:
        words = f"only {only} is switched on for {name}"
        return f"{words}: {tally(belief)}" if belief.trials else f"{words}: no response yet"
    words = f"Tangy has only one way of asking {name}"
    if not belief.trials:
        return words
    return f"{words}: it worked {of_times(belief.complied, belief.trials)}"


def tally(belief: Beta) -> str:
    """Format the responses behind a posterior: "7 of 9"."""
    return f"{belief.complied} of {belief.trials}"


def method_words(record: PersonSummary) -> str:
    """Tell how the next strategy is chosen, and for whom that is set."""
    whose = "for this person" if record.known.own else "as the activity sets"
    return f"{record.known.method.words} ({whose})"


def drift_lines(record: PersonSummary) -> list[str]:
    """Name the strategies that have started to work better or worse with a person."""
    lines = []
    for drift in record.known.watch.drifts:
        before, now = (f"{yes} of {yes + no}" for yes, no in (drift.before, drift.after))
        name, strategy = record.person.name, drift.strategy
        if drift.worse:
            lines.append(f"{strategy} used to work with {name} ({before}), lately not ({now}).")
        else:
            lines.append(f"{strategy} works with {name} lately ({now}); before, {before}.")
    return lines


def prior_words(prior: Beliefs) -> str:
    """Describe the prior: the counts of earlier people for each strategy."""
    lent = [
        f"{strategy} {start.alpha - 1:g} of {start.alpha + start.beta - 2:g}"
        for strategy, start in prior.items()
        if start.counts is not None
    ]
    if not lent:
        return "starts with every strategy equal"
    return "starts from what worked with earlier people: " + ", ".join(lent)


def entry_words(entry: FeedbackEntry) -> str:
    """Tell the response to one request."""
    if entry.complied is None:
        return "answered later" if entry.settled else "no response yet"
    late = "did it a little late" if entry.followed else "would rather not"
    words = "did it" if entry.complied else late
    if entry.late:
        words += ", said later"
    if entry.void:
        words += f" (void: {entry.why})" if entry.why else " (void)"
    return words


def change_words(change: Event[EventRecord]) -> str:
    """Describe a change that can be undone."""
    match change.record:
        case FeedbackGiven():
            did = "did it" if change.complied else "would rather not"
            return f"the late response: {change.strategy}, {did}"
        case ResponseVoided():
            return f"that a response to {change.strategy} is void"
        case StrategySwitched(on=on):
            return f"that {change.strategy} was switched {'on' if on else 'off'}"
        case _:
            return "the method that was chosen"


BELIEF_COLUMNS = "worked/asked, average, chance to be best"


def what_works(world: str) -> str:
    """Return the title of the panel with people's posteriors, for the games of a world."""
    return f"What works with whom, {world} games" if world else "What works with whom"


NOBODY_KNOWN = "Nothing is known of anybody yet."

METHOD_TITLES: dict[MethodName, str] = {
    "thompson": "Thompson sampling, as in the paper",
    "bayes-ucb": "Bayes-UCB: tries less, settles sooner",
}
"""The titles of the persuasion methods."""


def method_name(name: str) -> str:
    """Return the name of a method; that of another package by its own name."""
    return next((words for known, words in METHOD_TITLES.items() if known == name), name)


def method_title(name: str) -> str:
    """Return the title of a person's method settings."""
    return f"How to persuade {name}"


PEOPLE_HELP = (
    "Everybody, with what works and how many responses show it. A way of asking works if it is at "
    "least 90% probable that no other is better. If only one is switched on, Tangy cannot tell. "
    "Up and down choose a person."
)
STRATEGIES_HELP = (
    "For each way of asking: the curve of what Tangy believes from 0 (never) to 1 (always), how "
    "often it was tried and how often the person complied, the mean, the 90% interval, and the "
    "probability of being the best of those that are on. Then how "
    "the next one is chosen, and where the beliefs began. {put_away} switches the chosen one off "
    "for this person, or on again."
)
HISTORY_HELP = (
    "What was asked and what came of it, the newest game first. {put_away} leaves the chosen "
    "response out; {feedback} answers for one that is left out, or has no response yet."
)
CHOOSE_COUNTING = "Choose a response that counts: tab goes to the history, arrows choose."
CHOOSE_OPEN = "Choose a request without an answer; leave a wrong answer out first."
PUT_AWAY = "Leave the chosen response out, or switch the way of asking off or on"
VOID = "Shall this response no longer count?"
SWITCH_DETAIL = "What Tangy has learnt of it stays."


def world_words(world: str) -> str:
    """Name the world whose games are shown."""
    return f"What is known from {world} games."


def void_detail(entry: FeedbackEntry, name: str) -> str:
    """Name the response that should not count."""
    return f"{entry.strategy}: {name} {entry_words(entry)}, {on_day(entry.at)}."


def comply_words(entry: FeedbackEntry, name: str) -> tuple[str, str]:
    """Ask whether a person complied, and with which request."""
    return f"Did {name} do it?", f"The request with {entry.strategy}, {on_day(entry.at)}."


def switch_words(strategy: str, name: str, *, on: bool) -> tuple[str, str]:
    """Ask before a strategy is switched, and tell which data stays."""
    return f"Switch {strategy} {'on again' if on else 'off'} for {name}?", SWITCH_DETAIL


def take_back_words(change: Event[EventRecord], name: str) -> tuple[str, str]:
    """Ask before a change is undone, and name it."""
    return f"Take this back for {name}?", f"What was said: {change_words(change)}."


def nothing_back_words(name: str) -> str:
    """Tell that there is no change to take back."""
    return f"There is nothing to take back for {name}."


def strategies_title(name: str) -> str:
    """Return the title of a person's strategies."""
    return f"What works with {name}"


COMPLIED = "Did it, of times asked (chance to be best)"
BEST = "Chance to be best: of the ways of asking that are on. "
STAR = "*: the most likely one."
SETTLED = "settled: at least 0.9."
HISTORY = "History by game"
NO_HISTORY = "There is no history yet."
NO_REQUESTS = "No request was put to this person yet."
