"""The coach's words while teaching: what is happening, what to do next, what is still missing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.scene import ArrangedSituation
from tangy_profiles.state import FRONT, ActivityState, Situation
from tangy_tui.text.situations import card_words, moment_words

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity, StageRule
    from tangy_profiles.scene import ArrangedCard, Scene

Name = Callable[[str], str]

NOBODY = "Nobody asks for help."
ALL_SHOWN = "Everything that can happen has been shown."
GUIDED = (
    "A guided game: everything that can happen comes about once, so that you can show it. Tangy "
    "announces what people do for that."
)


ASKED = "What should Tangy do?"
"""The coach's question if an activity's file gives no advice in a situation."""

SAYABLE = "You can say now"
EXAMPLES = "For example: {}."
MOST_EXAMPLES, FEWEST_EXAMPLES = 3, 2


def sayable_now(commands: Sequence[str]) -> str:
    """List the commands that can be given now."""
    return " · ".join(commands)


def coach_words(activity: Activity, state: ActivityState, scene: Scene, name: Name) -> str:
    """Describe the situation, suggest what a host might do, and add the relevant facts."""
    facts = _facts(activity, state, scene, name)
    return " ".join([host_sentence(activity, state, name), *facts])


def with_examples(
    said: str, activity: Activity, state: ActivityState, sayable: Sequence[str], room: int = 1_000
) -> str:
    """Add examples of what to type to the coach's words, unless they name what to type.

    The order of the examples does not tell which one is right.

    Args:
        said: the coach's words.
        activity: the activity taught.
        state: the present state.
        sayable: what can be said now, what is due first.
        room: the most characters; fewer examples are given if they do not fit, or none.
    """
    if isinstance(activity, DeclaredActivity) and activity.expectation(state.situation):
        return said
    for count in range(MOST_EXAMPLES, FEWEST_EXAMPLES - 1, -1):
        words = f"{said} {EXAMPLES.format(' · '.join(sorted(sayable[:count])))}"
        if len(sayable) >= count and len(words) <= room:
            return words
    return said


def host_sentence(activity: Activity, state: ActivityState, name: Name) -> str:
    """Describe the situation and suggest what a host might do, in the words of the activity."""
    who = name(state.attended) if state.attended else "Somebody"
    if isinstance(activity, DeclaredActivity):
        return f"{moment_words(activity, state, name)}. {_advice(activity, state, name) or ASKED}"
    if said := activity.host_words(state.situation):
        return said.replace("{name}", who)
    rule = next(r for r in activity.stage_rules if r.stage == state.stage)
    return _by_rule(activity, rule, state.situation, who)


def _advice(activity: DeclaredActivity, state: ActivityState, name: Name) -> str:
    """Suggest what the activity's file expects of a host in a situation; "" if nothing."""
    expected = activity.expectation(state.situation)
    if expected is None:
        return ""
    to = activity.behaviours[expected.behaviour].to
    person = dict(state.whom).get(expected.to or (to[0] if to else ""))
    whom = f" ({name(person)})" if person is not None else ""
    return f"A host might choose “{activity.behaviour_words(expected.behaviour)}”{whom}."


def _by_rule(activity: Activity, rule: StageRule, situation: Situation, who: str) -> str:
    """Return a default sentence if the activity has none."""
    match rule.condition:
        case "before":
            return f"It is time to {activity.behaviour_words(rule.behaviour)}."
        case "count":
            return f"{NOBODY} It is time to {activity.behaviour_words(rule.since)}."
        case "beside requester":
            shown = (s.hint for s in activity.user_states if s.name == situation.user_state)
            return next(shown, "") or f"{who}: {activity.state_label(situation.user_state)}."
        case "requested or away" if situation.request == "AR":
            return f"{who} asks for help."
        case "requested or away":
            return "Nobody is asking any more."
        case "after":
            return "It is time to end the game."
        case _:
            return f"{activity.in_words(situation).capitalize()}."


def _facts(activity: Activity, state: ActivityState, scene: Scene, name: Name) -> list[str]:
    facts: list[str] = []
    if state.place != FRONT:
        facts.append(f"Tangy is with {name(state.place)}.")
    waiting = [person for person in scene.requests if person != state.attended]
    if waiting:
        facts.append(f"Waiting: {', then '.join(map(name, waiting))}.")
    if scene.card is not None and activity.reads(state.stage):
        facts.append(card_words(activity, scene.card))
    return [fact for fact in facts if fact]


def arranged_words(
    activity: Activity, arranged: ArrangedCard | ArrangedSituation, name: Name
) -> str:
    """Announce what a guided game is about to arrange, and why."""
    if isinstance(arranged, ArrangedSituation):
        situation = activity.in_words(arranged.situation)
        if arranged.goes_back:
            return f"Back to an earlier moment, to show what has not come up yet: {situation}."
        return f"Coming up: {situation}."
    states = [activity.unread, arranged.user_state] if arranged.hidden else [arranged.user_state]
    labels = " and ".join(activity.state_label(state) for state in states)
    why = "nobody has shown that in this game yet"
    return f"Coming up: {name(arranged.person)} will ask for help ({labels}), because {why}."


def unseen_words(activity: Activity, missing: Sequence[Situation], room: int) -> str:
    """Name the missing situations, in limited space.

    Args:
        activity: the activity taught.
        missing: the situations not demonstrated yet.
        room: the most characters; situations that do not fit are counted.
    """
    if not missing:
        return f"✓ {ALL_SHOWN}"
    names = [_short(activity, situation) for situation in missing]
    said = _joined(len(missing), names, room)
    if "…" in said and isinstance(activity, DeclaredActivity):
        stages = Counter(situation.stage for situation in missing)
        named = ((activity.stage_words(stage), n) for stage, n in stages.items())
        by_stage = [f"{n}x {words}" if n > 1 else words for words, n in named]
        return _joined(len(missing), by_stage, room)
    return said


def _joined(count: int, names: Sequence[str], room: int) -> str:
    """Name as many as fit; count the others."""
    said = f"{count} still to show: "
    for number, label in enumerate(names):
        joint = " · " if number else ""
        rest = len(names) - number
        more = f" … and {rest} more"
        if number and len(said) + len(joint) + len(label) + len(more) * (rest > 1) > room:
            return said + more
        said += joint + label
    return said


def _short(activity: Activity, situation: Situation) -> str:
    """Name a situation by what distinguishes it: the state of the card, or the stage."""
    if activity.reads(situation.stage):
        return activity.state_label(situation.user_state)
    return activity.in_words(situation)
