"""A demonstration in lines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.reading import nearest
from tangy_tui.learning.early_ends import missed_end
from tangy_tui.learning.teaching_events import (
    Announced,
    Begun,
    Executed,
    Finished,
    NoRule,
    Remark,
    RuleChoice,
    Ruled,
    RuleUndone,
    Settled,
    StepUndone,
    TeachingEvent,
)
from tangy_tui.learning.verification import Asked, NotUnderstood, Offered, Refused, Rejected
from tangy_tui.text.coach import GUIDED, arranged_words
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.remarks import ended_early, remark_lines, settled_words
from tangy_tui.text.situations import step_words, verification_lines

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.demonstration import Step
    from tangy_tui.learning.teaching_session import TeachingSession


def teaching_lines(event: TeachingEvent, teaching: TeachingSession, yes: str = "Y") -> list[str]:
    """Format one event of a teaching session in lines; `yes` is what to type for yes."""
    if isinstance(event, Remark):
        return remark_lines(event, teaching.activity, teaching.name, teaching.demonstration.id)
    match event:
        case Asked() | Offered() | NotUnderstood() | Refused() | Rejected():
            return verification_lines(event, yes)
        case Executed(number, step, _, outcome, speech, _):
            words = step_words(teaching.activity, step, teaching.name, outcome.numbers)
            return [
                f"{number}. {words}",
                f"   Tangy says: {speech}",
            ]
        case Settled():
            return [settled_words(event, teaching.activity)]
        case Announced(arranged):
            return [f"   {arranged_words(teaching.activity, arranged, teaching.name)}"]
        case Ruled() | RuleUndone() | NoRule():
            return [rule_words(event, teaching.activity)]
        case StepUndone(number, step):
            done = teaching.activity.behaviour_words(step.behaviour)
            return [f"Step {number} is undone: {done}."]
        case Begun(demonstration, resumed):
            if resumed:
                return [
                    f"Going on with {teaching.teacher}'s demonstration of "
                    f"{counted(len(demonstration.steps), 'step')} (game {demonstration.seed})."
                ]
            begun = f"A new demonstration by {teaching.teacher} (game {demonstration.seed})."
            return [begun, GUIDED] if demonstration.guided else [begun]
        case Finished():
            return [complete_words(teaching)]


def now_words(words: str) -> str:
    """Begin the line that tells what is going on."""
    return f"Now: {words}"


CHOOSE_STEP, CANCEL = "Choose a step", "Cancel"
LEAVE = "Leave; your steps are kept"
"""Actions of keys while teaching."""

NO_STEPS = "No steps yet."
TYPE_HERE = "type a command (its first letters are enough), or ? for help"
SAY_OR_TYPE = "Say or type"
STOPPED = "STOP: the simulated robot stands still."
WHICH_STEP = "Choose the step first: up and down, or type again 7."
BY_KEY = (
    "To talk, press {talk}, speak, and press {talk} again; after 6 seconds it ends by itself. The "
    "microphone line shows what Tangy hears, or what is wrong if it hears nothing. Say stop, and "
    "the robot stops."
)
HANDS_FREE = (
    "Just say what Tangy should do: the microphone is open, except while Tangy speaks. Say stop, "
    "and the robot stops."
)


def begin_words(*, heard: bool) -> str:
    """Tell how to start a demonstration; `heard` if commands can be spoken."""
    return f"No steps yet. {SAY_OR_TYPE if heard else 'Type'} what Tangy should do first."


def sayable_words(phrases: Iterable[str]) -> str:
    """List commands that can be spoken."""
    return f"You can say: {', '.join(phrases)}."


def again_words(first: int, last: int) -> tuple[str, str]:
    """Ask whether to go back before a step, and tell the effect on later steps."""
    gone, back = f"Steps {first} to {last} are", "them back one by one"
    if first == last:
        gone, back = f"Step {first} is", "it back"
    return (
        f"Go back before step {first} and show it again?",
        f"{gone} taken back; {{redo}} brings {back} until you show another.",
    )


DISCARD, KEEP = "discard it", "go on with it"
GO_BACK, GO_ON = "go back", "go on here"
RULES = "To make the last step a rule, type one of these:"


def discard_words(steps: int) -> tuple[str, str]:
    """Ask before a game is discarded, and explain the effect."""
    return (
        "Discard this game?",
        f"Tangy does not learn from its {counted(steps, 'step')}. The library keeps it, and can "
        "bring it back.",
    )


AFTERWARDS = ("next", "learn", "play")
"""Commands to continue with after a game."""
OVER = "The game is over. Press {next} for another game, or {learn} to let Tangy learn."


def new_words(situation: str) -> str:
    """Tell that a situation was not shown before."""
    return f"New to Tangy: {situation}."


def undone_words(undone: Sequence[StepUndone], activity: Activity) -> str:
    """Tell which steps were undone (the last one first), and how to redo them."""
    last, first = undone[0], undone[-1]
    if last is first:
        done = activity.behaviour_words(last.step.behaviour)
        return f"Step {last.number} is undone: {done}. {{redo}} brings it back."
    return f"Steps {first.number} to {last.number} are undone. {{redo}} brings them back."


def beginning_words(teaching: TeachingSession, *, resumed: bool) -> str:
    """Tell which game begins, or that one is resumed."""
    shown = teaching.demonstration
    if resumed:
        return f"Going on where you left off, after {counted(len(shown.steps), 'step')}."
    if shown.origin == "again":
        return f"Show it again from step {len(shown.steps) + 1}; the steps before it stay."
    title = teaching.activity.title
    if shown.guided:
        return GUIDED
    return f"A new game of {title}, demonstrated by {teaching.teacher}."


def left_words(steps: int) -> str:
    """Tell how many steps of an unfinished game are stored, and how to continue."""
    return f"Tangy keeps {counted(steps, 'step')} of this game. Teach goes on from there."


def complete_words(teaching: TeachingSession) -> str:
    """Tell that a demonstration is complete, or that its teacher ended it early."""
    shown, activity = teaching.demonstration, teaching.activity
    steps = counted(len(shown.steps), "step")
    if ending := missed_end(activity, shown):
        return f"{ended_early(activity, ending)} Tangy learns from its {steps}."
    return f"The game is complete: {steps}."


def rule_words(event: Ruled | RuleUndone | NoRule, activity: Activity) -> str:
    """Tell that a step became a rule, that the rule was undone, or why there is none."""
    if isinstance(event, NoRule):
        return _no_rule(event)
    rule = event if isinstance(event, Ruled) else event.rule
    same = f"{activity.behaviour_words(rule.step.behaviour)}{_whatever(rule.facts, activity)}"
    covers = counted(len(rule.covers), "more situation")
    if isinstance(event, Ruled):
        return (
            f"   Step {rule.number} is now a rule: {same}. It covers {covers}. What is still to "
            "show names them all the same: show one if something else is right there."
        )
    return f"The rule of step {rule.number} is taken back: {same}. The step stays."


def ruled_step(step: str, facts: Sequence[str], activity: Activity) -> str:
    """Format a step that is a rule: its words, and the facts that make no difference."""
    return f"{step} · rule{_whatever(facts, activity)}"


RULE, NO_RULE = "make it a rule", "keep the step only"
MOST_COVERED = 6
"""The most situations that the question about a rule names."""


def rule_words_asked(rule: Ruled, activity: Activity) -> tuple[str, str]:
    """Ask before a step becomes a rule, and name the situations it covers."""
    named = [activity.in_words(situation) for situation in rule.covers]
    if (more := len(named) - MOST_COVERED) > 0:
        named[MOST_COVERED:] = [f"{more} more"]
    behaviour = activity.behaviour_words(rule.step.behaviour)
    return (
        f"Always {behaviour}{_whatever(rule.facts, activity)}?",
        f"Tangy then does the same in: {'; '.join(named)}.",
    )


def _whatever(facts: Sequence[str], activity: Activity) -> str:
    """Say which facts make no difference, in the activity's words; "" if it has none."""
    known = activity.declaration.facts if isinstance(activity, DeclaredActivity) else {}
    words = [known[fact].words for fact in facts if fact in known]
    told = [f"whether {listed(values, 'or')}" for values in words if values]
    return f", no matter {listed(told)}" if told else ""


def rule_question(step: Step, activity: Activity) -> str:
    """Ask which facts make no difference to a step, so that it becomes a rule."""
    return f"{activity.behaviour_words(step.behaviour)}: the same whatever ..."


def whatever_words(choice: RuleChoice) -> str:
    """Name the facts that a rule ignores, as the rest of a sentence."""
    return f"the value of {listed(choice.facts, 'or')}"


def covers_words(covers: int) -> str:
    """Tell how many situations without a demonstration a rule covers."""
    return f"covers {counted(covers, 'more situation')}"


def rule_lines(choices: Sequence[RuleChoice]) -> list[str]:
    """List what can be typed to make the last step a rule."""
    return [
        RULES,
        *(
            f"  the same whatever {whatever_words(one)} ({covers_words(one.covers)})"
            for one in choices
        ),
    ]


def _no_rule(event: NoRule) -> str:
    match event.why:
        case "no step":
            return "Show a step first: a rule is about the last one."
        case "no facts":
            return "This step depends on nothing that changes, so you cannot make it a rule."
        case "all shown":
            return "Every situation that this covers has been shown already."
        case "not gone by":
            return f"{event.fact!r} does not count here. {nearest(event.fact, event.known)}"
