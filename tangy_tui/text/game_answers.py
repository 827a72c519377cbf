"""Answers about the game, its calls, its people and Tangy, and to thanks and the like."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from tangy_profiles.game_world import SIMULATED
from tangy_profiles.planned_game import as_planned
from tangy_tui.app.game_moment import game_moment
from tangy_tui.app.game_questions import AsksGame
from tangy_tui.app.readiness import LEAST_BATTERY, battery_of
from tangy_tui.text.faults import advice_lines
from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.planned_time import time_lines
from tangy_tui.text.staff_lines import NOTHING_WRONG
from tangy_tui.text.times import local_now
from tangy_tui.text.whose_turn import (
    NO_GAME,
    held_words,
    now_lines,
)

if TYPE_CHECKING:
    from tangy_profiles.planned_game import PlannedGame
    from tangy_tui.app.game_controller import GameController
    from tangy_tui.text.situations import Name

NOTHING_TO_DO = "You do not have to do anything."
NOTHING_CALLED = "Nothing has been called yet in this game."
CALLS_NOTHING = "In this activity Tangy calls nothing."
NO_BATTERY = (
    "Tangy does not know how full the battery is: no device of this robot tells its charge."
)
HOW_TO_END = "To end the game, type: end. Tangy asks you before it ends it."
HEARS = (
    "Tangy reads every line that you type here, and answers it. To see what it told you, type: "
    "messages."
)
WELCOME = "You are welcome."
VOICE = (
    "Tangy cannot change how loud its voice is. Turn the loudspeaker of the robot up or down.",
    "To hear the last call again, type: call again.",
)
GOES_TO_SEATS = "Tangy goes only to people who play, at their seats."
COMES_TO = "If {} needs help, type: help {}."
DRIVE_IT = "To move Tangy yourself, type: drive forward."
NO_CLAIM = (
    "You do not have to take a claim back.",
    "If the card does not win, Tangy tells the group so, and the game goes on.",
)
NEXT_LATER = "This game still runs. To end it, type: end. After that you can begin another one."
OVER = "This game is over."
WHAT_YOU_ASKED = "What you asked"
"""The title of these answers."""


def to_do_lines(control: GameController, name: Name) -> list[str]:
    """Tell staff what to do; if there is nothing, tell so, and what Tangy does."""
    if advice := advice_lines(control.supervision):
        return advice
    moment = game_moment(control)
    now = now_lines(control.supervision.world.activity, moment, name)
    if moment.holder in ("", "joining"):
        return [f"{NOTHING_WRONG} {NOTHING_TO_DO}", *now]
    return now if moment.holder == "stopped" else [NOTHING_WRONG, *now]


def game_answer_lines(asked: AsksGame, control: GameController, name: Name) -> list[str]:
    """Answer a question about the present game; `name` returns a person's name for an id."""
    match asked.topic:
        case "last call" | "calls" | "called":
            game = as_planned(control.supervision.world)
            return [CALLS_NOTHING] if game is None else _calls_lines(game, asked)
        case "where":
            return _where_lines(control, name)
        case "playing":
            return _playing_lines(control, name)
        case "unvisited":
            return _unvisited_lines(control, name)
        case "battery":
            share = battery_of(control.supervision.world)
            return [NO_BATTERY if share is None else _battery_words(share)]
        case "clock":
            simulated = control.supervision.world.played_in == SIMULATED
            return [f"It is {local_now():%H:%M}.", *([] if simulated else time_lines(control))]
        case "todo":
            return to_do_lines(control, name)
        case "end":
            return [HOW_TO_END]
        case "heard":
            return [HEARS]
        case "thanks":
            return [WELCOME]
        case "louder":
            return [*VOICE] if as_planned(control.supervision.world) else [VOICE[0]]
        case "come here":
            somebody = name(next(iter(control.supervision.world.people), "NAME"))
            drive = [DRIVE_IT] if control.robot.there else []
            return [GOES_TO_SEATS, COMES_TO.format(somebody, somebody), *drive]
        case "no claim":
            return [*NO_CLAIM]
        case "new game":
            return [OVER if control.supervision.over else NEXT_LATER]
        case forgotten:
            assert_never(forgotten)


def _battery_words(share: float) -> str:
    low = "" if share >= LEAST_BATTERY else " Charge it soon."
    return f"The battery is {share:.0%} full.{low}"


def _calls_lines(game: PlannedGame, asked: AsksGame) -> list[str]:
    """Tell what was called: the last one, all, or whether one was."""
    label, called = game.activity.deck.label, game.called_now
    now = [label(number) for number in game.calling if number not in called]
    calling = [f"Tangy is just calling {listed(now)}."] if now else []
    if asked.topic == "called":
        return _called_lines(game, asked.about)
    if not called:
        return calling or [NOTHING_CALLED]
    last = f"The last call was {label(called[-1])}. It was call {len(called)}."
    if asked.topic == "last call":
        return [last, *calling]
    told = ", ".join(map(label, sorted(called)))
    return [f"{counted(len(called), 'call')} so far: {told}.", last, *calling]


def _called_lines(game: PlannedGame, wanted: str) -> list[str]:
    """Tell whether a call, by label or number, was called, and when."""
    label = game.activity.deck.label
    known = {label(number): number for number in game.activity.deck.numbers}
    plain = wanted.replace("-", "")
    found = [n for one, n in known.items() if plain in (one.replace("-", "").upper(), str(n))]
    if not found:
        return [f"There is no {wanted} in this game."]
    number = found[0]
    if number in game.called_now:
        at, since = game.called_now.index(number) + 1, len(game.called_now)
        ago = "the last one" if at == since else f"{counted(since - at, 'call')} ago"
        return [f"Yes: Tangy called {label(number)}. It was call {at}, {ago}."]
    if number in game.calling:
        return [f"Tangy is just calling {label(number)}."]
    return [f"No: Tangy has not called {label(number)} yet."]


def _where_lines(control: GameController, name: Name) -> list[str]:
    """Tell where Tangy is, and what it does now."""
    moment = game_moment(control)
    if moment.holder in ("idle", "over"):
        return [held_words(moment) or NO_GAME]
    near, scene = moment.with_robot, control.supervision.world.scene()
    there = "Tangy is at the front." if scene.place not in {one.id for one in moment.people} else ""
    if near is not None:
        there = f"Tangy is with {name(near.id)}." if near.state == "visited" else ""
    now = now_lines(control.supervision.world.activity, moment, name)
    known = any(one.startswith(there.rstrip(".")) for one in now) if there else True
    return now if known else [there, *now]


def _playing_lines(control: GameController, name: Name) -> list[str]:
    """Tell how many people play, who they are, and who is away."""
    people = control.view().people
    here = [name(one.id) for one in people if one.state != "away"]
    away = [name(one.id) for one in people if one.state == "away"]
    play = f"{counted(len(here), 'person plays', 'people play')}: {listed(here)}."
    gone = f"Not here: {listed(away)}." if away else ""
    return [one for one in (play, gone) if one]


def _unvisited_lines(control: GameController, name: Name) -> list[str]:
    """Tell whom Tangy has not visited in this game."""
    here = [one for one in control.view().people if one.state != "away"]
    never = [one for one in here if one.unvisited is None and one.state != "visited"]
    if not never:
        return ["Tangy has visited everybody who is here."]
    if len(never) == len(here):
        return ["Tangy has visited nobody yet in this game.", _asks_words()]
    names = listed([name(one.id) for one in never], "or")
    return [f"Tangy has not visited {names} yet.", _asks_words()]


def _asks_words() -> str:
    return "It goes to people who ask for help. To ask for somebody, type: help NAME."
