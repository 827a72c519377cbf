"""Activities in words: what a search found wrong with one, and what there is in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.situations import seen_facts
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.state import EVERYBODY, ActivityState
from tangy_tui.text.numbers import counted

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.declared.checking import ActivityFlaw, Findings
    from tangy_profiles.declared.model import Effect, Fact, FactCondition
    from tangy_profiles.declared.search import Cut
    from tangy_tui.learning.coverage_proof import CoverageProof
    from tangy_tui.learning.policy import Policy


def finding_words(source: str, found: ActivityFlaw) -> str:
    """Say what is wrong with an activity, in one line that names the place."""
    name = repr(found.name)
    match found.flaw:
        case "stage never reached":
            words = f"stages: no game reaches the stage {name}"
        case "situation never reached":
            words = f"stages: this situation never occurs: {found.name}"
        case "fact never changes":
            words = f"facts.{found.name}: nothing ever sets it"
        case "fact never cleared":
            words = f"facts.{found.name}: once it has changed, no behaviour sets it back"
        case "fact never looked at":
            words = f"facts.{found.name}: no stage, condition or text looks at it"
        case "behaviour never possible":
            words = f"behaviours.{found.name}: it can never be chosen; check 'needs' and 'to'"
        case "text lacks a word":
            words = f"behaviours.{found.name}: {found.text!r} lacks a word when it is said"
        case "never ends":
            words = f"stages: from here no game can end: {found.name}"
    return f"{source}: {words}."


def facts_words(state: ActivityState, name: Callable[[str], str]) -> list[str]:
    """Say what is seen of a game of a declared activity, and whose turn it is."""
    turn = dict(state.whom).get("whose turn")
    sentences = [f"It is the turn of {name(turn)}."] if turn is not None else []
    facts = seen_facts(state.situation)
    if facts:
        seen = ", ".join(f"{fact} is {value}" for fact, value in facts.items())
        sentences.append(f"Seen: {seen}.")
    return sentences


def activity_lines(activity: DeclaredActivity) -> Iterator[str]:
    """Tell what there is in an activity: stages, facts, behaviours, a line each."""
    declaration = activity.declaration
    yield f"{activity.title} ({activity.source})"
    yield f"  {activity_note(activity)}"
    if declaration.items.rows:
        items = declaration.items
        yield f"  {len(items.rows)} items, {items.rounds} in a game: {', '.join(items.columns)}"
    if activity.teams:
        yield f"  teams: {', '.join(activity.teams)}"
    yield "Stages, the first that fits:"
    for stage in declaration.stages:
        when = " and ".join(map(condition_words, stage.when)) or "otherwise"
        about = "" if stage.about == "group" else f", about {stage.about}"
        sees = f"; sees {', '.join(stage.sees)}" if stage.sees else ""
        yield f"  {stage.name}: {when}{about}{sees}"
        if stage.words:
            yield f"    people read: {stage.words}"
    yield "Facts:"
    for fact in declaration.facts.values():
        if not fact.built_in:
            yield f"  {fact.name}: {_fact_words(fact)}"
    yield "Behaviours:"
    for name, one in declaration.behaviours.items():
        to = f", for {' or '.join(one.to)}" if one.to else ""
        does = ", ".join(map(_effect_words, one.effects)) or "speaks only"
        yield f"  {name}{to}: {does}"


def condition_words(condition: FactCondition) -> str:
    """Write a condition as it stands in a file."""
    quantifier = f"{condition.quantifier} " if condition.quantifier else ""
    return f"{quantifier}{condition.fact} {condition.comparison} {condition.value}"


def _effect_words(effect: Effect) -> str:
    words = " ".join(part for part in (effect.does, effect.fact, effect.value) if part)
    conditions = " and ".join(map(condition_words, effect.conditions))
    return f"{words} if {conditions}" if conditions else words


def _fact_words(fact: Fact) -> str:
    values = ", ".join(fact.values) or "a number"
    whose = " of each player" if fact.per_player else ""
    sources = f", from {', '.join(fact.sources)}" if fact.sources else ""
    return f"{fact.kind}{whose} ({values}){sources}"


SELECTORS: dict[str, str] = {
    "first asking": "the person who asked first",
    "whose turn": "the person whose turn it is",
    "next in circle": "the next in the circle",
    "quietest": "the person who has done least so far",
    "last to act": "the person who did something last",
    "addressed": "the person spoken to last",
    "beside": "the person whom Tangy is with",
    EVERYBODY: "everybody",
}
"""What the selectors of an activity's file mean."""


def whom_words(activity: Activity, policy: Policy) -> list[str]:
    """Say for whom Tangy does something, where it has learnt that from what was shown."""
    return [
        f"{stage_words(activity, stage)} -> {activity.behaviour_words(behaviour)}: "
        f"for {_any_of(selectors)}."
        for (stage, behaviour), selectors in policy.whom.items()
    ]


def stage_words(activity: Activity | None, stage: str) -> str:
    """Say what is going on in a stage, where the file of its activity has words for it."""
    return activity.stage_words(stage) if isinstance(activity, DeclaredActivity) else stage


def _any_of(selectors: tuple[str, ...]) -> str:
    words = [SELECTORS.get(one, one) for one in selectors]
    more = ", as long as they are the same" if len(words) > 1 else ""
    return f"{' or '.join(words)}{more}"


def proof_words(activity: Activity, found: CoverageProof) -> list[str]:
    """Say for which groups a search of all games has proved that everything was shown."""
    teams = bool(activity.teams)
    reached = counted(len(found.reached), "situation")
    lines = []
    if found.proved:
        lines.append(f"Tangy searched all games of {_sizes_words(found.proved, teams=teams)}.")
    lines += [
        f"Tangy could not search all games of {_sizes_words((size,), teams=teams)}: "
        f"{_cut_words(one.cut, one.states)}"
        for size, one in found.searches
        if one.cut
    ]
    if not teams:
        lines.append("Larger groups were not searched.")
    if found.open:
        lines.append(f"{reached} came about, and in these Tangy would ask you:")
        lines += [
            f"  {activity.in_words(one)}{': for whom?' if why else ''}"
            for one, why in found.open.items()
        ]
    else:
        lines.append(f"{reached} came about, and each was shown.")
    if found.stuck is not None:
        lines.append(f"From here no game ends: {activity.in_words(found.stuck)}.")
    return lines


def without_words(activity: DeclaredActivity) -> list[str]:
    """Say which stages of a file have no words for people."""
    stages = [stage.name for stage in activity.declaration.stages if not stage.words]
    if not stages:
        return []
    names = ", ".join(stages)
    return [
        f"{activity.source}: stages: say in 'words' what is going on in {names}: teachers read it."
    ]


def search_lines(found: Findings, *, teams: bool) -> list[str]:
    """Say how far the games of an activity were searched, and what did not come up by then."""
    tried = [one for one in found.searches if not one.as_expected]
    whole = tuple(one.players for one in tried if not one.cut)
    lines = [f"searched all games of {_sizes_words(whole, teams=teams)}."] if whole else []
    lines += [
        f"not searched to the end: games of {_sizes_words((one.players,), teams=teams)}"
        f"{' that go as expected' if one.as_expected else ''}. "
        f"{_cut_words(one.cut, one.states)}"
        for one in found.searches
        if one.cut
    ]
    if found.not_met:
        names = ", ".join(one.name for one in found.not_met)
        lines.append(f"did not come up by then, and may be impossible: {names}.")
    return lines


def _cut_words(cut: Cut, states: int) -> str:
    why = "the time for it was over" if cut == "time" else "there are too many"
    return f"The search stopped after {counted(states, 'state')}, because {why}."


def _sizes_words(sizes: Sequence[int], *, teams: bool) -> str:
    """Name sizes of groups: "1, 2 and 3 players"."""
    *first, last = map(str, sizes)
    both = f"{', '.join(first)} and {last}" if first else last
    noun = "team" if teams else "player"
    return f"{both} {noun if list(sizes) == [1] else noun + 's'}"


TRIED = "The game has come to its end."


def tried_lines(number: int, situation: str, behaviour: str, whom: str, said: str) -> list[str]:
    """Tell a step of a game that was tried, in one line or two."""
    lines = [f"{number}. {situation} -> {behaviour}{f' ({whom})' if whom else ''}"]
    return [*lines, f"   Tangy says: {said}"] if said else lines


def people_did(doing: dict[str, str]) -> str:
    """Tell what people did after a step ("": nothing)."""
    did = "; ".join(f"{person}: {what}" for person, what in doing.items())
    return f"   {did}" if did else ""


def with_activity(mode: str, activity: Activity) -> str:
    """Name the activity beside a part of the program, unless it is the usual one."""
    return mode if activity.name == DEFAULT_ACTIVITY else f"{mode}: {activity.title}"


CHOOSE_ACTIVITY = "Which activity do you want to teach and play?"


def activity_note(activity: Activity) -> str:
    """Say for how many people an activity is, how long it takes, and what they need."""
    if activity.summary or not isinstance(activity, DeclaredActivity):
        return activity.summary
    rounds = activity.declaration.items.rounds
    who = f"{len(activity.teams)} teams" if activity.teams else "people take turns"
    selectors = activity.declaration.selectors
    if not activity.teams and not selectors & {"whose turn", "next in circle"}:
        who = "for everybody together"
    return f"{who}, {counted(rounds, 'round')}" if rounds else who


def chosen_words(title: str) -> str:
    """Say that an activity was chosen."""
    return f"From now on you teach and play {title}."
