"""Words for remarks on a step: what may have been overlooked, and the answers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, assert_never

from tangy_tui.learning.remarks import answers_to
from tangy_tui.learning.teaching_events import (
    Contradicted,
    EndedEarly,
    NewWording,
    NothingChanged,
    Overlooked,
    Remark,
    RemarkAnswer,
    Settled,
    WrongPerson,
)
from tangy_tui.text.coach import host_sentence
from tangy_tui.text.numbers import listed

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_tui.learning.teaching_session import TeachingSession

Name = Callable[[str], str]

CHANGED_NOTHING = "That changed nothing, so Tangy would do it again and again."
LED_BACK = "That led back to an earlier moment, so Tangy would go in circles."

ANSWER_BY_LINE = "Type a number, or just go on: Tangy asks you once more before it learns."
OR_GO_ON = "Type a number, or just go on: Tangy reminds you once before it learns."
OR_NO = "Type 1 or no, or just go on."
WHICH_ANSWER = "Yes could mean several answers here. Type a number, or no to decide later:"
NUMBER_OR_ESC = "Press the number of an answer, or Esc."
SAY_A_NUMBER = "Please say the number of an answer, or no."
AS_SHOWN = "Tangy takes it as you showed it."
LEFT_OPEN = "You left open what Tangy asked here. It learns it as you showed it:"
LATER = "decide later"
LEARN_LATER = "Decide later, and let Tangy learn"
GO_ON = "go on"
NOT_ALWAYS = "no, and do not ask again"


def remark_words(remark: Remark, activity: Activity, name: Name, game: str = "") -> str:
    """Tell what may have been overlooked.

    Args:
        remark: the remark.
        activity: the activity taught.
        name: returns a person's name for an id.
        game: the present demonstration.
    """
    done = activity.behaviour(remark.step.behaviour).question
    match remark:
        case Contradicted(earlier=earlier, own=own):
            other = activity.behaviour(earlier.step.behaviour).question
            elsewhere = "" if earlier.demonstration == game else " of another game"
            who = "you" if own else earlier.teacher
            return (
                f"This time you showed: {done}. In the same situation {who} showed: {other} "
                f"(step {earlier.number}{elsewhere}). What should Tangy learn?"
            )
        case Overlooked(step=step, due=due):
            where = activity.in_words(step.state.situation)
            better = "" if due is None else f" A host might {activity.behaviour(due).question}."
            return f"Something may be overlooked here: {where}.{better} You showed: {done}."
        case WrongPerson(step=step, waiting=waiting):
            to = name(step.target or "")
            others = "Nobody did." if waiting is None else f"{name(waiting)} is waiting."
            return f"{to} did not ask for help. {others}"
        case EndedEarly(lacks=lacks):
            return ended_early(activity, lacks)
        case NothingChanged(step=step, back=back):
            what = LED_BACK if back else CHANGED_NOTHING
            return f"{what} {_sentence(host_sentence(activity, step.after, name))}"
        case NewWording(words=words):
            return f"You said “{words}”, which Tangy did not know. Does it mean: {done}?"
        case _:
            assert_never(remark)


def _sentence(words: str) -> str:
    """Begin with a capital letter."""
    return words[:1].upper() + words[1:]


def ended_early(activity: Activity, lacks: str) -> str:
    """Tell that a game ended while a behaviour was still to come."""
    return f"The game ended early: “{activity.behaviour(lacks).question}” was still to come."


def answer_words(remark: Remark, activity: Activity) -> tuple[str, ...]:
    """Tell what each answer means, in the order of their numbers."""
    return tuple(_answer(remark, answer, activity) for answer in answers_to(remark))


def _answer(remark: Remark, answer: RemarkAnswer, activity: Activity) -> str:
    done = activity.behaviour(remark.step.behaviour).question
    match answer:
        case "this":
            return (
                f"this step: {done}" if isinstance(remark, Contradicted) else "it is right this way"
            )
        case "earlier" if isinstance(remark, Contradicted):
            return f"the earlier one: {activity.behaviour(remark.earlier.step.behaviour).question}"
        case "both":
            return "both are fine"
        case "undo":
            return "a slip: undo this step"
        case "keep":
            return "yes, always"
        case _:
            return LATER


def sayable_words(answers: Sequence[RemarkAnswer]) -> str:
    """Tell which answers to a remark can be spoken."""
    return "yes or no" if tuple(answers) == ("keep",) else "the number of one, or no"


def later_words(remark: Remark) -> str:
    """Tell the effect of leaving a remark unanswered."""
    if isinstance(remark, NewWording):
        return NOT_ALWAYS
    return LATER if isinstance(remark, Contradicted) else GO_ON


def remark_lines(remark: Remark, activity: Activity, name: Name, game: str = "") -> list[str]:
    """Format a remark in lines, with its answers."""
    numbered = enumerate(answer_words(remark, activity), 1)
    return [
        f"   ! {remark_words(remark, activity, name, game)}",
        *(f"     {number}  {words}" for number, words in numbered),
        f"   {_by_line(remark)}",
    ]


def _by_line(remark: Remark) -> str:
    """Tell how to answer a remark in a line, and what happens without an answer."""
    match remark:
        case NewWording():
            return OR_NO
        case Contradicted():
            return ANSWER_BY_LINE
        case _:
            return OR_GO_ON


def left_open_lines(teaching: TeachingSession) -> list[str]:
    """Repeat the remarks without an answer, once, before Tangy learns."""
    present, lines = teaching.demonstration.id, list[str]()
    for game, remark in teaching.deferred():
        said = remark_words(remark, teaching.activity, teaching.name, game)
        if game == present:
            lines.append(f"Step {remark.number}: {said} {again_words(remark.number)}")
        else:
            lines.append(f"Step {remark.number} of an earlier game: {said}")
    return [LEFT_OPEN, *lines] if lines else []


def again_words(step: int) -> str:
    """Tell how to show a step anew in lines."""
    return f"To show it again, type again {step}."


def which_answer(remark: Remark, activity: Activity) -> list[str]:
    """List the answers to a remark, after a yes that could mean several of them."""
    numbered = enumerate(answer_words(remark, activity), 1)
    return [WHICH_ANSWER, *(f"     {number}  {words}" for number, words in numbered)]


def settled_words(settled: Settled, activity: Activity) -> str:
    """Tell the result of the answer to a remark."""
    if isinstance(settled.remark, NewWording):
        words, done = settled.remark.words, settled.remark.step.behaviour
        kept = f"From now on “{words}” means: {activity.behaviour(done).question}."
        return kept if settled.answer == "keep" else f"Tangy does not keep “{words}”."
    if not settled.right and not isinstance(settled.remark, Contradicted):
        return AS_SHOWN
    if not settled.right:
        return "Left open. Tangy asks again which is right before it learns."
    right = listed((activity.behaviour(b).question for b in settled.right), "and")
    are = "is" if len(settled.right) == 1 else "are both"
    return f"{activity.in_words(settled.remark.step.state.situation)}: {right} {are} right."


def no_own_phrase(phrase: str, teacher: str) -> str:
    """Tell that a teacher has no such phrase to remove."""
    return f"{teacher} has no phrase {phrase!r}. See: tangy activity phrases"
