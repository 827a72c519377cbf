"""Words for situations and steps, the same on screens, in the console and in reports."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.behaviour import calling
from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.reading import plain
from tangy_profiles.state import FRONT, ActivityState
from tangy_profiles.teaching_records import Deletion, Division, Merger, Restoration, Settlement
from tangy_tui.learning.verification import (
    Asked,
    NotUnderstood,
    Offered,
    Refused,
    Rejected,
    Verification,
)
from tangy_tui.text.activities import facts_words
from tangy_tui.text.numbers import counted, often
from tangy_tui.text.refusals import not_understood_words, refused_words

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.demonstration import Step
    from tangy_profiles.scene import CardView, Scene
    from tangy_tui.learning.conflicts import Conflict
    from tangy_tui.learning.library_entries import Edit, Library
    from tangy_tui.learning.online_learning import Lesson
    from tangy_tui.learning.policy import Policy

OVER_NOW = "the game is over"
"""The status line's words for a game that has ended."""

MOST_STEPS = 3
"""The steps named for each answer of a conflict."""

SOMEBODY = re.compile(r"\bthe (user|player|person|resident|guest)\b")
"""The words of activities for a person whose name they do not know."""

Name = Callable[[str], str]
"""Returns a person's name for an id."""


def agreement_words(activity: Activity, policy: Policy) -> str:
    """Tell whether a policy agrees with the activity's expected behaviours.

    If it is unsure it asks instead of acting, which counts as not doing what is expected.
    """
    if not activity.expected:
        return "nothing to compare it with"
    wrong = len(policy.errors(activity))
    asks = sum(not policy.decide(situation).sure for situation in activity.expected)
    if wrong:
        return f"differs from the reference in {counted(wrong, 'situation')}"
    return f"asks in {counted(asks, 'situation')}" if asks else "matches the reference"


def step_words(
    activity: Activity, step: Step, name: Name, numbers: Sequence[int] | None = None
) -> str:
    """Format one step of a trajectory: situation, behaviour, target, and called number.

    Args:
        activity: the activity taught.
        step: the step.
        name: returns a person's name for an id.
        numbers: the numbers of the step, if known.
    """
    target = f" ({name(step.target)})" if step.target else ""
    calls = step.behaviour in calling(activity.behaviours)
    called = f" {activity.deck.label(numbers[0])}" if numbers and calls else ""
    done = f"{activity.behaviour_words(step.behaviour)}{called}{target}"
    return f"{moment_words(activity, step.state, name)} -> {done}"


WRONG_STEP = "x wrong: "
"""Stands before a step that a teacher called wrong."""


def marked_step(words: str, *, wrong: bool) -> str:
    """Mark the words of a step if a teacher called it wrong."""
    plain_words = words.removeprefix(WRONG_STEP)
    return f"{WRONG_STEP}{plain_words}" if wrong else plain_words


def moment_words(activity: Activity, state: ActivityState, name: Name) -> str:
    """Format the situation of a state, with the person it is about if its words name one."""
    if isinstance(activity, DeclaredActivity):
        about = name(state.attended) if state.attended else ""
        return activity.told_of(state.situation, about)
    return activity.in_words(state.situation)


def reason_of(activity: Activity, state: ActivityState, name: Name) -> tuple[str, bool]:
    """Return the situation that decides about a step, and whether it is a clause."""
    why = moment_words(activity, state, name)
    if isinstance(activity, DeclaredActivity):
        return why, bool(activity.declaration.stage(state.stage).words)
    return why, why in {label for rule in activity.stage_rules for label in rule.label.values()}


def addressed_step(words: str, whom: str, why: str = "") -> str:
    """Tell a step, to whom, and in which situation: "encourage Rosa (helping: all correct)".

    Args:
        words: the behaviour's words.
        whom: the name of the person concerned; "": nobody.
        why: the situation; "": it is told elsewhere.
    """
    told, named = SOMEBODY.subn(lambda _: whom, words, count=1) if whom else (words, 0)
    notes = "; ".join(filter(None, ("" if named else whom, why)))
    return f"{told} ({notes})" if notes else told


def state_words(activity: Activity, state: ActivityState, scene: Scene, name: Name) -> str:
    """Tell what the robot knows now, in a sentence or two that a newcomer can act on."""
    if state.place == FRONT:
        sentences = ["Tangy is at the front."]
    else:
        sentences = [f"Tangy is with {name(state.place)}."]
    if scene.requests:
        asking = ", then ".join(name(person) for person in scene.requests)
        sentences.append(f"Asking for help: {asking}.")
    else:
        sentences.append("Nobody asks for help.")
    shown = next((s for s in activity.user_states if s.name == state.situation.user_state), None)
    if any(r.stage == state.stage and r.condition == "after" for r in activity.stage_rules):
        sentences.append("The game is won. It is time to end it.")
    elif shown is not None and activity.reads(state.stage):
        sentences.append(shown.hint)
        if scene.card is not None:
            sentences.append(card_words(activity, scene.card))
    if isinstance(activity, DeclaredActivity):
        sentences += facts_words(activity, state, name)
    return " ".join(part for part in sentences if part)


def card_words(activity: Activity, card: CardView) -> str:
    """Name the numbers of a card that are marked wrongly or not marked."""

    def labels(mask: int) -> str:
        numbers = (n for place, n in enumerate(card.numbers) if mask >> place & 1)
        return ", ".join(activity.deck.label(number) for number in numbers)

    wrong, missing = labels(card.marked & ~card.called), labels(card.called & ~card.marked)
    parts = [f"Wrong: {wrong}." if wrong else "", f"Missed: {missing}." if missing else ""]
    return " ".join(part for part in parts if part)


def verification_lines(said: Verification, yes: str = "Y") -> list[str]:
    """Format the verification of a command in lines; `yes` is what to type for yes."""
    match said:
        case Asked(question=question, heard=heard, confidence=confidence, others=others):
            told = "you typed" if said.typed else "heard"
            lines = [f"Did you say: {question}? Type {yes} to do it, or N for another command."]
            if confidence < 1:
                lines.append(f"  {told} {plain(heard)!r}, {confidence:.0%} sure")
            return lines + [
                f"  {number} instead: {other}" for number, other in enumerate(others, 1)
            ]
        case Offered(heard=heard, questions=questions, typed=typed):
            told = "You typed" if typed else "I heard"
            return [
                f"{told} {plain(heard)!r}. Did you mean one of these? Type its number, or N.",
                *(f"  {number}  {question}" for number, question in enumerate(questions, 1)),
            ]
        case NotUnderstood(heard, suggestions):
            return [f"{not_understood_words(heard, suggestions)} Type help for all commands."]
        case Refused():
            return [refused_words(said)]
        case Rejected(heard):
            return [f"Not done: {plain(heard)}. Give a new command."]
        case _:
            return []


def conflict_lines(activity: Activity, library: Library, conflict: Conflict) -> list[str]:
    """Format a conflict in lines: the situation, and each answer with its steps."""
    lines = [f"Demonstrations disagree: {activity.in_words(conflict.situation)}."]
    for number, (behaviour, steps) in enumerate(conflict.answers.items(), 1):
        words = activity.behaviour_words(behaviour)
        lines.append(f"  {number}. {words}, shown {often(len(steps))}:")
        lines += [
            plain(f"       step {s.number} of {library.name(s.demonstration)}, by {s.teacher}")
            for s in steps[:MOST_STEPS]
        ]
        if len(steps) > MOST_STEPS:
            lines.append(f"       and {counted(len(steps) - MOST_STEPS, 'more step')}")
    return lines


def edit_words(activity: Activity, library: Library, edit: Edit) -> str:
    """Describe the effect of a change of the library."""
    names = ", ".join(library.name(id) for id in edit.ids)
    match edit.done:
        case Deletion():
            return f"{names}: deleted, and no longer learnt from."
        case Restoration():
            return f"{names}: in use again."
        case Merger(made=(one,)):
            return f"{names}: merged into {library.name(one)}."
        case Division(kept=kept, made=(one, two)):
            made = f"{library.name(one)} and {library.name(two)}"
            return f"{names}: split after step {kept} into {made}."
        case Settlement(resolution=said):
            are = "is" if len(said.right) == 1 else "are all"
            right = ", ".join(map(activity.behaviour_words, said.right))
            return f"{activity.in_words(said.situation)}: {right} {are} right."


def lesson_words(activity: Activity, lesson: Lesson) -> str:
    """Describe the lesson of an answer: situation, behaviour, teacher, and what Tangy keeps."""
    made = lesson.demonstration
    step = made.steps[-1]
    where = activity.in_words(step.state.situation)
    learnt = f"Learnt from {made.teacher}: {where} -> {activity.behaviour_words(step.behaviour)}."
    return f"{learnt} {kept_words(lesson.policy.name)}"


def kept_words(policy: str) -> str:
    """Tell that an answer became a demonstration, and which policy Tangy plays by now."""
    return f"Tangy keeps this as a demonstration, and plays by {policy!r} from now on."


ALL_RIGHT = ("all right", "all is right", "that is all right", "all is well", "ok")
"""Answers that accept something unexpected as normal."""


def once_words(instead: str) -> str:
    """Tell that an answer about a fault was carried out, but not learnt."""
    return (
        "Done this once: Tangy does not learn it. Next time, it again does what it was shown here: "
        f"{instead}."
    )
