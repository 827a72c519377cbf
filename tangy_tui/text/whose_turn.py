"""Sentences that tell staff what Tangy does now and why, and when it goes to a person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, assert_never

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.game_world import SIMULATED
from tangy_tui.app.game_moment import game_moment, turn_of
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.text.control import (
    claimed_words,
    noted_words,
    person_wait_words,
    stopped_words,
)
from tangy_tui.text.joining import sets_up_words
from tangy_tui.text.names import turn_words
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.situations import moment_words
from tangy_tui.text.staff_view import (
    OVER,
    STEP_SECONDS,
    lasting_words,
    next_words,
    settled_words,
    welcomes_words,
)
from tangy_tui.text.times import local_now

if TYPE_CHECKING:
    from tangy_profiles.activity import Activity
    from tangy_profiles.state import ActivityState
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.app.game_moment import GameMoment, PersonTurn
    from tangy_tui.app.inquiry_grammar import AsksAbout
    from tangy_tui.app.staff_view import PersonNow
    from tangy_tui.learning.policy import Decision

    Name = Callable[[str], str]

NO_GAME = "No game is running."
IN_DETAIL = "How Tangy decides"
"""The heading of the details for researchers, below the plain sentences."""
WHOSE_TURN = "When does Tangy come?"
"""The title of the answer about people."""
WHO_WAITS = "Who waits for Tangy?"
"""The title of the answer about everybody who waits."""
FACTS_FOLLOW = " \N{MIDDLE DOT} "
"""What stands between a stage and its facts in the words of a situation."""
_CALLS_FIRST = "Tangy calls {} first, because everybody waits for the next one."
MOST_NAMES = 3
"""The most names in a sentence; the others are counted."""


def why_now_lines(control: GameController, name: Name) -> list[str]:
    """Tell what Tangy does now in a controller's game, and why; see `now_lines`."""
    return now_lines(control.supervision.world.activity, game_moment(control), name)


def about_lines(control: GameController, about: AsksAbout, name: Name) -> list[str]:
    """Tell when Tangy goes to the people whom a question names, or why it does not."""
    now = None if control.supervision.world.played_in == SIMULATED else local_now()
    told = list[str]()
    for person in about.people:
        turn = turn_of(control, person)
        left_out = noted_words(StaffNote("not playing", person), name)
        told += [left_out] if turn is None else turn_lines(turn, name, now)
    return list(dict.fromkeys(told))


def waiting_lines(moment: GameMoment, name: Name) -> list[str]:
    """Tell who waits for Tangy, in the order in which it goes to them, and for how long."""
    told = [held_words(moment)]
    if moment.holder in ("idle", "over"):
        return told
    near = moment.with_robot
    if near is not None:
        there = on_its_way(moment) if near.state == "comes" else "Tangy is with"
        told.append(f"{there} {name(near.id)}{because_words(moment, near, name)}.")
    if not moment.waiting:
        told.append("Nobody else waits." if near is not None else "Nobody waits for Tangy.")
        return [one for one in told if one]
    if moment.calls_first:
        told.append(_CALLS_FIRST.format(counted(moment.calls_first, "number")))
    for place, person in enumerate(moment.waiting, 1):
        told.append(f"{place}. {_asked_words(person, moment, name)}")
    return [one for one in told if one]


def now_lines(activity: Activity, moment: GameMoment, name: Name) -> list[str]:
    """Tell what Tangy does now and why, and who waits, in a few plain sentences.

    Args:
        activity: the activity that is played.
        moment: the present moment.
        name: returns a person's name for an id.
    """
    told, about = [held_words(moment), _claim_words(moment, name)], ""
    if moment.holder in ("", "paused", "stopped"):
        step, about = _step_words(activity, moment, name)
        told.append(step)
    if moment.holder not in ("idle", "over"):
        told.append(_waiting_words(moment, about, name))
    return [one for one in told if one]


def held_words(moment: GameMoment) -> str:
    """Tell what holds the game, and until when; "" if nothing does."""
    match moment.holder:
        case "":
            return ""
        case "idle":
            return NO_GAME
        case "over":
            return OVER
        case "joining":
            return sets_up_words(moment.welcomes)
        case "stopped":
            return f"{stopped_words(moment.about)}. It stands still until you let it go on."
        case "halted":
            fault = f" ({moment.about})" if moment.about else ""
            return f"A fault halts Tangy{fault}. It stands still until all is well again."
        case "driving":
            return "You drive Tangy by hand. It does nothing by itself meanwhile."
        case "taking over":
            return "You say what Tangy does next. It waits for that."
        case "question":
            return f"Tangy waits for your answer. {moment.about}"
        case "proposal":
            return f"Tangy waits for your yes before it does this: {moment.about}."
        case "confirming":
            return "Tangy waits for your answer."
        case "paused" if moment.stepping:
            return "The game is paused. Tangy finishes this, then waits until you let it go on."
        case "paused":
            return "The game is paused. Tangy does nothing until you let it go on."
        case forgotten:
            assert_never(forgotten)


def _claim_words(moment: GameMoment, name: Name) -> str:
    """Tell the result of a claim that the group has not been told yet; "" if there is none."""
    if (claim := moment.claim) is None or claim.told is not None:
        return ""
    return claimed_words(claim, name, moment.calling)


def _step_words(activity: Activity, moment: GameMoment, name: Name) -> tuple[str, str]:
    """Tell the present or next step, and why; also return the id of the person it is about."""
    decision, state, near = moment.decision, moment.state, moment.with_robot
    if decision is None or state is None:
        return "", ""
    if moment.welcomes:
        return welcomes_words(moment.welcomes), ""
    if moment.waits_for is not None:
        return person_wait_words(moment.waits_for, name), moment.waits_for.person
    if moment.looking:
        looks = f"Tangy looks at {name(moment.looking)}'s {activity.object}."
        return f"{looks} What it does next depends on that.", moment.looking
    if near is not None and near.state == "comes":
        return f"{on_its_way(moment)} {name(near.id)}{because_words(moment, near, name)}.", near.id
    settled, goes_to = settled_words(moment.claim, moment.plays_on, name)
    if goes_to:
        return f"Tangy goes to {name(goes_to)} next, because of the claim.", goes_to
    if settled:
        return settled, ""
    behaviour = activity.behaviours.get(decision.behaviour)
    if not decision.sure or behaviour is None:
        return "Nobody has shown Tangy what to do next, so it will ask you.", ""
    if behaviour.calls and moment.calling and moment.waiting:
        return f"Tangy is calling {moment.calling}.", ""
    following = _next_words(activity, decision, state, name)
    if moment.turns:
        return f"{turn_words(name(moment.turns[0]))}. {following}", ""
    if near is not None and near.turn and not behaviour.visits:
        there = f"Tangy is with {name(near.id)}{because_words(moment, near, name)}."
        return f"{there} {following}", near.id
    if moment.won:
        return f"Somebody has won. {following}", ""
    if behaviour.visits and moment.waiting:
        first = moment.waiting[0]
        return f"Tangy goes to {name(first.id)} next{because_words(moment, first, name)}.", first.id
    if moment.calls_first and (behaviour.calls or behaviour.returns):
        calls = counted(moment.calls_first, "number")
        returns = "goes back to the front and " if behaviour.returns else ""
        first_calls = f"Tangy {returns}calls {calls} before its next visit"
        return f"{first_calls}, because everybody waits for the next one.", ""
    if behaviour.returns:
        return "Tangy goes back to the front, because nobody asks any more.", ""
    if behaviour.calls and not moment.waiting:
        looks = f" It first gives everybody time to look at the {activity.object}."
        called = "Tangy calls the next number, because nobody asks for help."
        return called + (looks if moment.rests else ""), ""
    return following, (state.attended or "") if behaviour.attends else ""


def _next_words(activity: Activity, decision: Decision, state: ActivityState, name: Name) -> str:
    """Tell the next step and why; of a game declared by facts, without the facts in detail."""
    if not isinstance(activity, DeclaredActivity):
        return next_words(activity, decision, state, name)
    why = moment_words(activity, state, name).partition(FACTS_FOLLOW)[0]
    done = activity.behaviour_words(decision.behaviour)
    return f"{why[:1].upper()}{why[1:]}. Next: {done}." if why else f"Next: {done}."


def on_its_way(moment: GameMoment) -> str:
    """Begin to tell to whom Tangy drives, or drove when something stopped it."""
    return f"Tangy {'was' if moment.holder in ('stopped', 'halted') else 'is'} on its way to"


def because_words(moment: GameMoment, person: PersonNow, name: Name) -> str:
    """Tell why Tangy goes to a person now, as the end of a sentence."""
    if person.claims:
        return ", because of the claim"
    if not person.turn:
        return ""
    who, visits = name(person.id), moment.visits if person.id in moment.visiting else ""
    if visits == "all called":
        return ", because all numbers have been called and Tangy looks at each card"
    if visits == "unvisited":
        long = counted(moment.unvisited, "number") if moment.unvisited else "long"
        return f", because {who} has had no visit for {long}"
    others = [one for one in moment.people if one.turn and one.id != person.id]
    longest = all((one.waits or 0) <= (person.waits or 0) for one in others)
    if not others and person.id in moment.by_staff:
        return f", because you asked for {who}"
    if not others:
        return f", because {who} asked for help"
    return f", because {who} {'has waited longest' if longest else 'comes first'}"


def _waiting_words(moment: GameMoment, about: str, name: Name) -> str:
    """Tell who else waits, in the order in which Tangy goes to them; `about` was told already."""
    near = moment.with_robot
    waiting = [one for one in moment.waiting if one.id != about]
    if not about and near is not None and near.turn:
        waiting.insert(0, near)
    if not waiting:
        return "Nobody else waits." if about else ""
    told = _names([f"{name(one.id)}{_wait(one)}" for one in waiting])
    too = ", too" if about else ""
    several = len(waiting) > 1
    return f"{told} {'wait' if several else 'waits'}{too}{', in this order' if several else ''}."


def _wait(person: PersonNow) -> str:
    known = person.waits is not None and person.waits >= STEP_SECONDS
    return f" ({lasting_words(person.waits or 0.0)})" if known else ""


def turn_lines(turn: PersonTurn, name: Name, now: datetime | None) -> list[str]:
    """Tell when Tangy goes to a person, or why it does not, in a few plain sentences.

    Args:
        turn: when it goes there.
        name: returns a person's name for an id.
        now: the local time of day; None: the time of the game is simulated.
    """
    person, moment, who = turn.person, turn.moment, name(turn.person.id)
    if moment.holder in ("idle", "over"):
        return [held_words(moment)]
    if person.state == "away":
        return [
            f"{who} is not here, as far as Tangy knows, so it does not go there.",
            f"If {who} is back, type: here {who}.",
        ]
    told = [held_words(moment), _claim_words(moment, name)]
    if not person.goes_round:
        asked = _asked_words(person, moment, name) if person.turn else ""
        return [*filter(None, [*told, asked]), _turn_words(turn, name)]
    match person.state:
        case "visited":
            told.append(f"Tangy is with {who} now{because_words(moment, person, name)}.")
        case "comes":
            told.append(f"{on_its_way(moment)} {who}{because_words(moment, person, name)}.")
        case "asks":
            told += [*_asked_lines(turn, name), _visit_words(person, who, now)]
        case "plays":
            told += [*_not_asked_lines(turn, who), _visit_words(person, who, now)]
            if turn.can_ask and turn.sign != "no sensor":
                told.append(f"If {who} needs help, type: help {who}.")
        case forgotten:
            assert_never(forgotten)
    return [one for one in told if one]


def _asked_lines(turn: PersonTurn, name: Name) -> list[str]:
    """Tell what comes before a person who asks."""
    person, moment, who = turn.person, turn.moment, name(turn.person.id)
    near, before = moment.with_robot, turn.before
    told = [_asked_words(person, moment, name)]
    if near is not None:
        there = "Tangy is with" if near.state == "visited" else on_its_way(moment)
        told.append(f"{there} {name(near.id)}{_claim(near)}.")
    if moment.won:
        told.append("Somebody has won, so nobody else gets a visit for now.")
        return told
    if moment.calls_first:
        told.append(_CALLS_FIRST.format(counted(moment.calls_first, "number")))
    claims = [name(one.id) for one in before if one.claims]
    names = _names([name(one.id) for one in before])
    if claims:
        told.append(f"{listed(claims)} {'comes' if len(claims) == 1 else 'come'} first: a claim.")
    if before:
        goes = f"Before {who}, Tangy goes to {names}"
        longer = all((one.waits or 0.0) > (person.waits or 0.0) for one in before)
        they = "they have" if len(before) > 1 else f"{names} has"
        why = f": {they} waited longer" if longer and not claims else ""
        told.append(f"{goes}{', in this order' if len(before) > 1 else ''}{why}.")
        if moment.calls_between and not moment.calls_first:
            told.append("In between it may call some numbers.")
    else:
        then = "After that, " if near or moment.calls_first else ""
        told.append(f"{then}{who} is next{_claim(person)}.")
    return told


def _asked_words(person: PersonNow, moment: GameMoment, name: Name) -> str:
    """Tell for how long a person has waited, and whether that is because of a request."""
    who, waits = name(person.id), person.waits or 0.0
    if person.id in moment.visiting:
        in_turn = " in turn" if moment.visits == "unvisited" else ""
        return f"Tangy visits {who}{in_turn}{because_words(moment, person, name)}."
    if waits < STEP_SECONDS:
        return (
            f"{who} waits for Tangy." if person.id in moment.by_staff else f"{who} has just asked."
        )
    if person.id in moment.by_staff:
        return f"{who} has waited for {lasting_words(waits)}."
    return f"{who} asked {lasting_words(waits)} ago."


def _claim(person: PersonNow) -> str:
    return ", because of a claim" if person.claims else ""


def _names(names: Sequence[str]) -> str:
    more = len(names) - MOST_NAMES
    few = [*names[:MOST_NAMES], f"{more} more"] if more > 1 else names
    return listed(few)


def _not_asked_lines(turn: PersonTurn, who: str) -> list[str]:
    """Tell why Tangy does not go to a person who has not asked."""
    moment = turn.moment
    match turn.sign:
        case "":
            told = [f"{who} has not asked for help."]
        case "no sensor":
            told = [f"Tangy cannot see who asks for help. Type: help {who}."]
        case "silent":
            told = ["Tangy cannot see now who asks for help: its sensor for that does not report."]
        case "set aside":
            told = [
                f"{who}'s sign is up, but Tangy was there already. It counts again after it has "
                "been down."
            ]
        case forgotten:
            assert_never(forgotten)
    if moment.won:
        told.append("Somebody has won, so nobody else gets a visit for now.")
    elif moment.unvisited:
        limit = counted(moment.unvisited, "number")
        told.append(
            f"After {limit} without a visit, Tangy goes to people as if they had asked. "
            f"{who} has had {turn.unvisited}."
        )
    return told


def _visit_words(person: PersonNow, who: str, now: datetime | None) -> str:
    """Tell when Tangy was with a person."""
    ago = person.unvisited
    if ago is None:
        return f"Tangy has not been with {who} in this game."
    if ago < STEP_SECONDS:
        return f"Tangy has just been with {who}."
    if now is None:
        return f"Tangy was with {who} {lasting_words(ago)} ago."
    return f"Tangy was with {who} at {now - timedelta(seconds=ago):%H:%M}."


def _turn_words(turn: PersonTurn, name: Name) -> str:
    """Tell whose turn comes when, in a game in which Tangy visits nobody."""
    who, turns = name(turn.person.id), turn.moment.turns
    if turn.person.id not in turns:
        return "In this activity Tangy goes to nobody, and nobody has a turn."
    place = turns.index(turn.person.id)
    if place == 0:
        return f"{turn_words(who)} now."
    between = _names([name(one) for one in turns[1:place]])
    first = f"{turn_words(name(turns[0]))} now."
    return f"{first} {f'After that {between}, then' if between else 'Then comes'} {who}."
