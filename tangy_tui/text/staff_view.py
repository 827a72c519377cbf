"""Words of the panel with the state of a game for staff."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import assert_never

from tangy_profiles.activity import Activity
from tangy_profiles.behaviour import Behaviour
from tangy_profiles.game_rules import Patterns
from tangy_profiles.state import ActivityState
from tangy_tui.app.claim_controls import ClaimNow
from tangy_tui.app.game_commands import Autonomy
from tangy_tui.app.staff_view import PersonNow, StaffView
from tangy_tui.learning.policy import Decision
from tangy_tui.text.control import WAITS_FOR_YOU, autonomy_words
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.situations import addressed_step, reason_of

STEP_SECONDS = 10
"""Waits of less than a minute are told in steps of so many s."""

NOTHING_CALLED = "nothing called yet"
PAUSED = "Paused."
PAUSES_THEN = "Tangy finishes this, then the game is paused."
TIME_FIRST = ", once everybody has had time"
"""Why Tangy does not call the next number yet."""
TANGY_WAITS = f"Tangy {WAITS_FOR_YOU}."
YOU_SAY = "Tangy finishes this first. Then you say what it does."
CLAIM_FIRST = "first because of the claim"
"""Why Tangy goes to a person before those who have waited longer."""
FIRST_BY_CLAIM = "first: a claim"
"""The same, shorter."""
VISIT_DUE = "visit is due"
"""Tangy goes to a person who has not asked."""
OVER = "The game is over."
BEGINS, NEXT_BEGINS = "The game begins.", "The next game begins."
BEGINS_NOW = "a game begins"
"""The stage of such a game on the status line."""


def lasting_words(seconds: float) -> str:
    """Write how long somebody has waited (s), as coarse as staff need it.

    Seconds of 24 people would change the screen all the time.
    """
    whole = max(0, int(seconds))
    return f"{whole // 60} min" if whole >= 60 else f"{whole - whole % STEP_SECONDS} s"


def pace_words(view: StaffView) -> str:
    """Tell the pace of calls."""
    return f"a call every {view.pace:g} s" if view.pace else ""


SEVERAL_WINNERS = "several winners"
"""Short for: everybody who has the pattern at the same call wins."""
SEVERAL_WIN = "Everybody who has the pattern at the same call wins."
HAS_WON = "has won"


def played_words(patterns: Patterns | None) -> str:
    """Name the pattern to play for, and those that follow."""
    return "" if patterns is None else labels_words([one.label for one in patterns.chosen])


def played_facts(patterns: Patterns) -> str | tuple[str, ...]:
    """Tell the same, and in fewer words for less room."""
    words, chosen = played_words(patterns), patterns.chosen
    if len(chosen) < 2:
        return words
    return words, f"for {chosen[0].label}, then {len(chosen) - 1} more"


def winners_facts(names: Sequence[str]) -> str | tuple[str, ...]:
    """Tell who has won in this game, or how many if there is no room for their names."""
    return (f"won: {listed(names)}", f"{len(names)} won") if names else ""


def won_words(names: Sequence[str]) -> str:
    """Tell who has won in this game, in a sentence; "" if nobody has."""
    return f"{listed(names)} {HAS_WON if len(names) == 1 else 'have won'}." if names else ""


def labels_words(labels: Sequence[str]) -> str:
    """Name the pattern to play for, and those that follow, by their labels."""
    return f"for {', then '.join(labels)}" if labels else ""


def tangy_words(level: Autonomy, battery: float | None) -> str:
    """Tell the level of autonomy, and the charge of the battery (share from 0 to 1)."""
    charge = "" if battery is None else f", battery {battery:.0%}"
    return f"Tangy {autonomy_words(level)}{charge}"


def next_words(
    activity: Activity,
    decision: Decision,
    state: ActivityState,
    name: Callable[[str], str],
    calls_first: int = 0,
    *,
    then: str = "",
    claims: Collection[str] = (),
    waits: bool = False,
) -> str:
    """Tell Tangy's next step, and why.

    Args:
        activity: the activity played.
        decision: the next decision.
        state: the state in which it is made.
        name: returns a person's name for an id.
        calls_first: the calls that come before people who asked.
        then: the name of the person to whom Tangy goes after these calls.
        claims: the people whose cards win by a claim.
        waits: whether Tangy waits for the time of the next call.
    """
    behaviour = activity.behaviours.get(decision.behaviour)
    why, clause = ("", False) if calls_first else reason_of(activity, state, name)
    done, whom = "Tangy asks you", ""
    if behaviour is not None and decision.sure:
        done = behaviour.question
        whom = name(state.attended) if behaviour.attends and state.attended else ""
    if whom and state.attended in claims:
        why, clause = CLAIM_FIRST, False
    step = addressed_step(done, whom, "" if clause else why)
    because = f", because {why}" if clause else ""
    if waits and not calls_first:
        because = TIME_FIRST
    calls = f" {calls_first_words(calls_first, then)}" if calls_first else ""
    return f"Next: {step}{because}.{calls}"


def you_say_words(typed: str) -> str:
    """Tell that staff say what Tangy does next, or what they have typed already."""
    return f"Tangy finishes this first. Then you say: {typed}" if typed else YOU_SAY


def settled_words(
    claim: ClaimNow | None, pattern: str, name: Callable[[str], str]
) -> tuple[str, str]:
    """Tell the next step if it is settled, whatever Tangy would decide, and about whom it is.

    Both are "" if it is not. The panel and the answer to why tell the same step.

    Args:
        claim: the last claim, while it is news.
        pattern: the label of the pattern for which the game goes on after a win; "" for none.
        name: returns a person's name for an id.
    """
    # Not `claim.goes`: that begins only when Tangy has finished its present step.
    if claim is not None and claim.kind == "claim right" and claim.person:
        return f"Next: go to {name(claim.person)} ({CLAIM_FIRST}).", claim.person
    return f"Somebody has won. Next: the game goes on for {pattern}." if pattern else "", ""


def obeys_words(behaviour: Behaviour, whom: str) -> str:
    """Tell the step that staff chose, while Tangy carries it out."""
    return f"As you said: {addressed_step(behaviour.question, whom)}."


def calls_first_words(calls: int, then: str) -> str:
    """Tell how many numbers Tangy calls before it goes to the first who asked, and why."""
    return f"{counted(calls, 'number')} first, then {then}, as everybody waits for the next one."


def looks_words(name: str, what: str) -> str:
    """Tell that Tangy reads a person's card, or what they handle; the next step depends on it."""
    return f"Tangy looks at the {what} ({name})."


def welcomes_words(names: Sequence[str]) -> str:
    """Tell that the robot drives to the front, to be set up for new people."""
    return f"Tangy drives to the front, and sets itself up for {listed(names)} there."


def said_words(said: str) -> str:
    """Quote Tangy's last speech."""
    return f"Tangy said: {said}"


def person_words(person: PersonNow) -> str:
    """Describe a person's state, with the relevant times."""
    seen = ""
    if person.unvisited is not None:
        just = person.unvisited < STEP_SECONDS
        seen = "just visited" if just else f"visited {lasting_words(person.unvisited)} ago"
    match person.state:
        case "away":
            return "not here"
        case "visited":
            return f"Tangy is there, {HAS_WON}" if person.has_won else "Tangy is there"
        case "comes":
            return f"Tangy comes, {HAS_WON}" if person.has_won else "Tangy comes"
        case "asks":
            known = person.waits is not None and person.waits >= STEP_SECONDS
            waits = f" {lasting_words(person.waits or 0.0)}" if known else ""
            calls = counted(person.calls_first, "number")
            asked = (
                FIRST_BY_CLAIM if person.claims else "",
                VISIT_DUE if person.unasked else f"asks{waits}",
                f"after {calls}" if person.calls_first else "",
                HAS_WON if person.has_won else "",
                seen,
            )
            return ", ".join(filter(None, asked))
        case "plays":
            won = HAS_WON if person.has_won else ""
            told = seen or ("no visit yet" if person.goes_round and not won else "")
            turn = "has the turn" if person.their_turn else ""
            counts = (f"{name.replace('_', ' ')} {number}" for name, number in person.counts)
            return ", ".join(filter(None, (turn, won, *counts, told)))
        case forgotten:
            assert_never(forgotten)


def more_words(count: int) -> str:
    """Tell how many more people there are than the panel shows, and the key to see them."""
    return f"{count} more: ↓"
