"""A game, told line by line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from tangy_profiles.beliefs import Beta, probability_best
from tangy_profiles.demonstration import Demonstration
from tangy_profiles.game_records import CallMade
from tangy_profiles.planned_game import as_planned
from tangy_tui.interaction.game_events import (
    Acted,
    BeliefUpdated,
    DoneOnce,
    GameBegun,
    GameChanged,
    GameEnded,
    ResumedGame,
    Taught,
    Unsure,
)
from tangy_tui.learning.explanation import explain
from tangy_tui.monitoring.fault import Diagnosed, Moved
from tangy_tui.text.changes import changed_lines
from tangy_tui.text.decisions import HOW_SURE, why_words
from tangy_tui.text.endings import ENDED_EARLY
from tangy_tui.text.faults import fault_lines
from tangy_tui.text.learnt import replay_words
from tangy_tui.text.numbers import counted, listed, of_times, often, ordinal
from tangy_tui.text.planned_time import clock_words
from tangy_tui.text.situations import Name, kept_words, once_words
from tangy_tui.text.staff_view import won_words
from tangy_tui.text.steps import step_sentence, unfinished_words

if TYPE_CHECKING:
    from tangy_profiles.state import Response
    from tangy_tui.monitoring.supervision import Event, Supervision

Demonstrations = Callable[[], Sequence[Demonstration]]

SHOWS = {
    "room": "Show the room",
    "transcript": "Show the steps",
    "policy": "Show the policy",
    "posteriors": "Show what works with whom",
    "log": "Show the log",
    "faults": "Show the faults of this game",
}
SENSORS = "Show the sensors, and what cameras see"
"""The names of the number keys' actions."""


def game_lines(
    event: Event,
    supervision: Supervision,
    name: Name,
    teacher: str = "",
    *,
    goes_on: bool = False,
    stopped: bool = False,
    ends: bool = False,
    played: float = 0.0,
) -> list[str]:
    """Describe one event of a game in lines.

    Args:
        event: the event.
        supervision: runs the game.
        name: returns a person's name for an id.
        teacher: who answered Tangy's question.
        goes_on: whether a resumed game continues at once.
        stopped: whether the robot is stopped.
        ends: whether staff have ended the game.
        played: the time played (s), for a game that is resumed.
    """
    activity, planned = supervision.world.activity, as_planned(supervision.world)
    calls = 0 if planned is None else len(planned.called_now)
    match event:
        case GameBegun(game):
            return [begun_words(supervision.game.log.number(game))]
        case ResumedGame(game):
            number = supervision.game.log.number(game)
            return [resumed_words(number, calls, played, "" if goes_on else TYPE_GO_ON)]
        case Acted(number, state, _, choice, action, outcome, _, speech):
            step = step_sentence(
                activity, state, action.behaviour.name, action.target, name,
                strategy=choice.strategy if choice else "", teacher=teacher,
            )  # fmt: skip
            unfinished = unfinished_words(stopped=stopped, ended=ends)
            said = says_line(speech) if outcome.completed else unfinished
            counts = action.behaviour.calls and outcome.completed and calls
            told = f" This is the {ordinal(calls)} number." if counts else ""
            return [f"{number}. {step}{told}", f"   {said}"]
        case Diagnosed() | Moved():
            return fault_lines(event)
        case BeliefUpdated(response, belief):
            what = "would rather not just now"
            if response.followed:
                what = "did what Tangy asked, but too late to count"
            if response.complied:
                what = "did it"
            profile = supervision.persuasion.beliefs[response.person]
            best = max(profile, key=lambda strategy: profile[strategy].mean)
            worked = f" Best so far: {best}." if profile[best].complied else ""
            so_far = worked_words(response.strategy, belief)
            return [f"   {name(response.person)} {what}. {so_far}{worked}"]
        case Unsure(_, _, reason):
            return [f"Tangy asks. {reason} What should it do?"]
        case Taught(teacher, lesson):
            return [
                f"   Tangy has learnt that from {teacher}. {kept_words(lesson.policy.name)}",
                f"   {replay_words(activity, lesson.replay)}",
            ]
        case DoneOnce(_, instead):
            return [f"   {once_words(activity.behaviour_words(instead))}"]
        case CallMade():
            return []  # the prompt tells it
        case GameChanged():
            return changed_lines(event, activity, name)
        case GameEnded():
            won = "" if planned is None else won_words([name(one) for one in planned.has_won])
            return [*filter(None, (ended_words(event, calls), won))]


def says_line(speech: str) -> str:
    """Tell what Tangy says."""
    return f"Tangy says: {speech}"


def ended_words(ended: GameEnded, calls: int | None = None) -> str:
    """Tell how a game ended, and why if it stopped or ended early.

    For staff, `calls` is how many numbers were called; None: tell the steps, for technicians.
    """
    far = counted(ended.steps, "step") if calls is None else counted(calls, "call") if calls else ""
    after = f" after {far}" if far else ""
    if ended.stopped is not None:
        return f"The game stopped{after}. {ended.stopped}"
    return f"The game is over{after}. {early_words(ended)}".rstrip()


def early_words(ended: GameEnded) -> str:
    """Tell what was still to come when a game ended; "" if nothing was."""
    left, told = ended.rounds_left, []
    if ended.due:
        told.append(f"It {ENDED_EARLY.format(due=ended.due)}.")
    if left:
        told.append(f"{counted(left, 'round')} {'was' if left == 1 else 'were'} left.")
    return " ".join(told)


def paused_lines(count: int, seconds: float) -> list[str]:
    """Tell how often the robot waited for late data, and for how many s, if it did."""
    told = f"The robot waited for late data {often(count)}, for {seconds:.1f} s in all."
    return [told] if count else []


NEVER_ASKED = "Tangy does not know yet what works with {people}: it has asked them for nothing."
NOBODY_ASKED = "Tangy has not asked anybody for anything yet, so it does not know what works."


def belief_lines(supervision: Supervision, name: Name) -> list[str]:
    """Format each person's posteriors as a line, and name the people whom Tangy has not asked.

    No lines if the activity asks people for nothing.
    """
    lines, never = list[str](), list[str]()
    behaviours = supervision.world.activity.behaviours.values()
    if not any(behaviour.persuades for behaviour in behaviours):
        return lines
    for person, profile in supervision.persuasion.beliefs.items():
        best = probability_best(profile)
        parts = [
            f"{strategy} worked {of_times(belief.complied, belief.trials)} "
            f"({best[strategy]:.0%} likely to be the best way)"
            for strategy, belief in profile.items()
            if belief.trials
        ]
        if parts:
            lines.append(f"{name(person)}: {', '.join(parts)}")
        else:
            never.append(name(person))
    if never and not lines:
        return [NOBODY_ASKED]
    if never:
        lines.append(NEVER_ASKED.format(people=listed(never)))
    return lines


def why_lines(supervision: Supervision, demonstrations: Demonstrations | None) -> list[str]:
    """Explain why Tangy asks, or its present decision; without demonstrations, only the votes."""
    question, world = supervision.question, supervision.world
    situation = world.observe().situation if question is None else question.state.situation
    if demonstrations is not None:
        return why_words(world.activity, explain(supervision.policy, demonstrations(), situation))
    decision = supervision.policy.decide(situation) if question is None else question.decision
    votes = ", ".join(f"{behaviour} {share:.0%}" for behaviour, share in decision.votes)
    reason = world.activity.in_words(situation) if question is None else question.reason
    return [reason, f"{HOW_SURE}: {votes}."]


SKIP = "Play the rest of the game at once?"
SKIP_DETAIL = "Then you see the last step, and what Tangy has learnt of the people."
ANOTHER = "Play another game?"
ANOTHER_DETAIL = "It begins as soon as this one is over. To end this one, type: end."
SEEN = "Have you seen this fault?"
LEAVE = "Leave in the middle of the game?"
LEAVE_DETAIL = "The game ends here, and the log says so. Tangy keeps what it has learnt. {report}"
REPORT_AT_HOME = "For its report, choose Reports at home."
REPORT_AT_END = "For its report, leave: Tangy then shows the command to type."
REPORT_AFTER_LEAVING = "After that Tangy shows the command for its report."
STOPPED = "The game stopped"
LEADS_HOME = "Esc leads home, where you can teach; {next} plays another game."
DOES_WHAT_YOU_SAID = "does what you said"
GOES_ON, PLAYS_AGAIN = "{pause} goes on", "{next} plays again"
TRIES_AGAIN = "{pause} tries again; esc leads home."
NONE_YET = "No game was played yet: begin with `tangy play`."
NOTHING_DECIDED = "Nothing has been decided yet."
NO_UNSEEN_FAULT = "No fault that nobody has seen."
ANSWER_FIRST = "Tangy asks about this fault: answer its question."


def halted_words(reason: str) -> str:
    """Tell why a game is paused, and how to retry."""
    return f"{reason} {{pause}} tries again."


def stopped_words(reason: str, then: str) -> str:
    """Tell why a game stopped, and what can be done then."""
    return f"{reason}\n{then}"


def response_words(response: Response, belief: Beta, name: Name) -> str:
    """Tell a person's response, and how often the strategy has worked."""
    what = "did it" if response.complied else "did it a little late"
    return f"{name(response.person)} {what}. {worked_words(response.strategy, belief)}"


def worked_words(strategy: str, belief: Beta) -> str:
    """Tell how often a way of asking has worked with a person."""
    if belief.trials == 1:
        return f"Tangy asked with {strategy} for the first time."
    return f"With {strategy} it has worked {of_times(belief.complied, belief.trials)} so far."


def begun_words(number: int) -> str:
    """Tell that a game begins."""
    return f"Game {number} begins."


TYPE_GO_ON, PRESS_GO_ON = "Type: go on", "{pause} goes on."
"""How staff let a paused game go on."""


def resumed_words(number: int, calls: int, played: float, then: str) -> str:
    """Tell that an interrupted game is resumed, how far it had come, and that it is paused.

    `played` is the time played, in s; `then` tells how it goes on, "" if it goes on at once.
    """
    far = f"{counted(calls, 'number')} called, " if calls else ""
    paused = f" It is paused. {then}" if then else ""
    return f"Game {number} is back where it was: {far}{clock_words(played)} played.{paused}"


def earlier_steps_words(steps: int) -> str:
    """Tell where to read the steps before an interruption."""
    if not steps:
        return "No steps yet."
    return f"{counted(steps, 'earlier step')}: see `tangy log show last`."


def over_words(ended: GameEnded, calls: int) -> str:
    """Tell that a game is over, and which key starts another."""
    told = ended_words(ended, calls).replace("{", "{{").replace("}", "}}")
    return f"{told} {{next}} plays another."


def following_words(games: int) -> str:
    """Tell how many more games begin after the present one, and when."""
    follow = "Another game begins" if games == 1 else f"{games} more games begin"
    return f"{follow} when this one is over."


def dropped_words(games: int) -> str:
    """Tell that the games that were to follow are dropped if staff leave; "" if none was."""
    if games < 1:
        return ""
    one = games == 1
    which = (
        "The game that was to follow is" if one else f"The {games} games that were to follow are"
    )
    return f"{which} dropped. To play {'it' if one else 'them'}: go on, and type: end."
