"""Words for activities: their parts, and the course of their games."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.items import empty_cells
from tangy_profiles.declared.model import PAUSE_SECONDS
from tangy_profiles.declared.situation_words import seen_words
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.state import EVERYBODY, ActivityState
from tangy_tui.text.names import turn_words
from tangy_tui.text.numbers import counted, listed

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.declared.model import Effect, Fact, FactCondition
    from tangy_tui.app.trying import TriedStep
    from tangy_tui.learning.policy import Policy


def facts_words(
    activity: DeclaredActivity, state: ActivityState, name: Callable[[str], str]
) -> list[str]:
    """Describe the facts seen in a game of a declared activity, and whose turn it is."""
    turn = dict(state.whom).get("whose turn")
    seen = seen_words(activity.declaration, state.situation)
    return [
        *([f"{turn_words(name(turn))}."] if turn is not None else []),
        *([f"{seen[:1].upper()}{seen[1:]}."] if seen else []),
    ]


def activity_lines(activity: DeclaredActivity) -> Iterator[str]:
    """Describe the parts of an activity: stages, facts, behaviours, one per line."""
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
        more = [f"shows {one.picture}"] if one.picture else []
        more += [f"plays {one.sound}"] if one.sound else []
        more += [f"waits {one.pause:g} s"] if one.pause != PAUSE_SECONDS else []
        yield f"  {name}{to}: {', '.join((does, *more))}"


def condition_words(condition: FactCondition) -> str:
    """Format a condition as in an activity file."""
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
    "next in circle": "the person who sits next",
    "quietest": "the person who has done least so far",
    "last to act": "the person who did something last",
    "addressed": "the person spoken to last",
    "beside": "the person whom Tangy is with",
    EVERYBODY: "everybody",
}
"""What the selectors of an activity's file mean."""


def whom_words(activity: Activity, policy: Policy) -> list[str]:
    """Tell the learnt target selectors: whom Tangy does something for."""
    return [
        f"{stage_words(activity, stage)} -> {activity.behaviour_words(behaviour)}: "
        f"for {_any_of(selectors)}."
        for (stage, behaviour), selectors in policy.whom.items()
    ]


def stage_words(activity: Activity | None, stage: str) -> str:
    """Return the words for a stage, or its name if the activity's file has none."""
    if isinstance(activity, DeclaredActivity):
        return activity.stage_words(stage)
    rules = () if activity is None else activity.stage_rules
    own = [rule.label for rule in rules if rule.stage == stage]
    labels = [words for request in ("AR", "ANR") for one in own if (words := one.get(request))]
    return listed(dict.fromkeys(labels), "or") or stage


def selector_words(selector: str) -> str:
    """Tell what a selector of an activity's file means."""
    return SELECTORS.get(selector) or f"the person {selector}"


def _any_of(selectors: tuple[str, ...]) -> str:
    words = [selector_words(one) for one in selectors]
    more = ", as long as they are the same" if len(words) > 1 else ""
    return f"{' or '.join(words)}{more}"


def without_words(activity: DeclaredActivity) -> list[str]:
    """Name the stages of a file that have no words for people."""
    stages = [stage.name for stage in activity.declaration.stages if not stage.words]
    if not stages:
        return []
    names = ", ".join(stages)
    return [
        f"{activity.source}: stages: say in 'words' what is going on in {names}: teachers read it."
    ]


def table_lines(activity: DeclaredActivity) -> Iterator[str]:
    """Tell how tables were read that are not plain CSV, and which cells are missing."""
    declaration = activity.declaration
    for table in declaration.tables:
        if table.windows:
            yield (
                f"{table.file}: it is not saved as UTF-8, so Tangy reads it as text of Windows. If"
                " letters with accents look wrong, save it as CSV UTF-8 in your program."
            )
    for cell in islice(empty_cells(declaration), MOST_CELLS):
        yield (
            f"{declaration.items.file}: row {cell.row}, column {cell.column} is empty: there"
            f" {cell.behaviour!r} has nothing to say."
        )


def uneven_notes(activity: DeclaredActivity) -> Iterator[str]:
    """Tell if teams that take turns cannot have as many rounds each."""
    declaration = activity.declaration
    rounds, teams = declaration.items.rounds, len(declaration.teams)
    if declaration.takes_turns and teams and rounds % teams:
        yield f"{teams} teams cannot share {counted(rounds, 'round')} evenly: some get one more."


def separator_notes(activity: DeclaredActivity) -> Iterator[str]:
    """Tell which tables have something else than commas between their cells."""
    for table in activity.declaration.tables:
        if table.separator in SEPARATORS:
            yield f"read {table.file} with {SEPARATORS[table.separator]} between its columns."


MOST_CELLS = 10
SEPARATORS = {";": "semicolons", "\t": "tabs"}
SAYS_NOTHING = "says nothing and is asked again"
TRIED = "The game has come to its end."


def tried_lines(step: TriedStep) -> list[str]:
    """Describe one step of a trial game, in up to three lines."""
    whom = f" ({step.whom})" if step.whom else ""
    lines = [f"{step.number}. {step.situation} -> {step.behaviour}{whom}"]
    lines += [f"   Tangy says: {step.said}"] if step.said else []
    return [*lines, *(f"   Tangy shows or plays: {name}" for name in step.media)]


def people_did(doing: dict[str, str], silent: Sequence[str] = ()) -> str:
    """Tell what people did after a step, and who was asked again first ("": nothing)."""
    told = [f"{person} {SAYS_NOTHING}" for person in silent]
    did = "; ".join([*told, *(f"{person}: {what}" for person, what in doing.items())])
    return f"   {did}" if did else ""


def with_activity(mode: str, activity: Activity) -> str:
    """Name the activity beside a mode of the program, unless it is the default one."""
    return mode if activity.name == DEFAULT_ACTIVITY else f"{mode}: {activity.title}"


CHOOSE_ACTIVITY = "Which activity do you want to teach and play?"


def activity_note(activity: Activity) -> str:
    """Tell for how many people an activity is, how long it takes, and what it needs."""
    if activity.summary or not isinstance(activity, DeclaredActivity):
        return activity.summary
    rounds = activity.declaration.items.rounds
    who = f"{len(activity.teams)} teams" if activity.teams else "people take turns"
    selectors = activity.declaration.selectors
    if not activity.teams and not selectors & {"whose turn", "next in circle"}:
        who = "for everybody together"
    return f"{who}, {counted(rounds, 'round')}" if rounds else who


def chosen_words(title: str) -> str:
    """Tell that an activity was chosen."""
    return f"From now on you teach and play {title}."
