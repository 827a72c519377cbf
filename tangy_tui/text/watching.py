"""Words for a second console that watches another program's game."""

from __future__ import annotations

from datetime import datetime

from tangy_profiles.activity import Activity
from tangy_profiles.game_world import BENCH, LIVE
from tangy_tui.app.game_commands import Phase
from tangy_tui.app.game_view import GameView
from tangy_tui.text.faults import status_words
from tangy_tui.text.planned_time import Fact, time_facts, time_words
from tangy_tui.text.situations import OVER_NOW, Name
from tangy_tui.text.staff_view import (
    SEVERAL_WINNERS,
    labels_words,
    lasting_words,
    tangy_words,
)
from tangy_tui.text.times import local_now
from tangy_tui.text.worlds import WORLDS

PHASES: dict[Phase, str] = {
    "idle": "no game",
    "running": "running",
    "paused": "paused",
    "stopped": "STOPPED",
    "asking": "Tangy asks staff",
    "halted": "HALTED",
    "staff": "staff lead Tangy",
    "joining": "somebody new joins",
}

LAST_CALLS = 5
ONLOOKER = "a colleague"
"""Stands for an onlooker who gave no name, if there is no login name either."""

READ_ONLY = "You are watching. Your keys do not change the game; only STOP stops the robot."
NOBODY = "No Tangy runs here. This screen shows a game as soon as one begins."
NO_GAME = "Tangy is open here, and shows no game now."
GONE = "The program that ran the game has ended."
CLOSED = "That Tangy was closed."
"""The same, if it had no game."""
NOTHING_TO_STOP = "There is no game to stop: no Tangy shows one here."
RUNNING_HERE = "Tangy is already open in another window, so here you only watch."
ASKED_TO_STOP = "STOP was sent."
STOPPED_HERE = "You stopped the robot. It goes on when staff say so where the game runs."
HELP = (
    "You see another console's game, as it is shown there. Your keys do not change it. "
    "STOP works here as well: it stops the robot at once, and the log says that it was you."
)


def busy_words(view: GameView, folder: str) -> str:
    """Tell whose game keeps a command from writing to a data folder, and what to do."""
    return (
        f"{view.driver} runs a game ({WORLDS[view.world]}) with the data in {folder}. Try again "
        "when it is over and that Tangy is closed, or choose another folder with --data."
    )


def stopped_by_guest(guest: str, driver: str) -> str:
    """Tell that an onlooker stopped the robot, who may have the driver's name."""
    if guest == driver:
        return "The robot was stopped from another console."
    return f"{guest[:1].upper()}{guest[1:]} stopped the robot from another console."


def driver_words(view: GameView) -> str:
    """Tell who controls the game, and where it is played."""
    return f"{view.driver} runs the game, {WORLDS[view.world]}"


def world_and_driver(view: GameView) -> str:
    """Tell the same in short, the world first: it matters most if there is little room."""
    return f"{WORLDS[view.world]}, run by {view.driver}"


def robot_words(view: GameView) -> str:
    """Tell the state of the robot as the console that runs the game does: a STOP comes first."""
    halted = view.robot == "HALTED"
    if view.phase in ("idle", "joining"):  # what a device does after the game concerns nobody
        return f"WARN: {view.cause}, not cleared" if halted else "OK"
    words = status_words((view.robot, view.cause))
    if view.phase == "stopped":
        return f"{PHASES['stopped']}, {words}" if halted else PHASES["stopped"]
    return words


def stage_words(view: GameView) -> str:
    """Tell why Tangy does nothing now; "" while it plays, or if the robot's state tells it."""
    if view.phase == "idle":
        return OVER_NOW
    return PHASES[view.phase] if view.phase in ("paused", "asking", "staff", "joining") else ""


def phase_line(view: GameView) -> str:
    """Tell that the game has another phase now, or the robot another state."""
    stage, robot = stage_words(view), robot_words(view)
    parts = [stage or PHASES["running"]] if view.phase not in ("stopped", "halted") else []
    if robot != "OK":
        parts.append(robot)
    return f"-- {driver_words(view)}: {', '.join(parts)}"


def waiting_words(view: GameView, name: Name) -> str:
    """Tell who waits for help, and for how long; "" if nobody does."""
    waits = {one.id: one.waits for one in view.people if one.waits is not None}
    told = [
        f"{name(one)} {lasting_words(waits[one])}" if one in waits else name(one)
        for one in view.scene.requests
    ]
    return f"Waiting for help: {', '.join(told)}" if told else ""


def called_words(view: GameView, activity: Activity | None) -> str:
    """Tell the number of calls, and the last ones; "" if there were none."""
    called = view.scene.called
    if not called:
        return ""
    label = str if activity is None else activity.deck.label
    newest = ", ".join(map(label, called[: -LAST_CALLS - 1 : -1]))
    return f"Called so far: {len(called)}; newest first: {newest}."


def view_lines(view: GameView | None, activity: Activity | None, name: Name) -> list[str]:
    """Describe the state of a game in lines."""
    if view is None:
        return [NO_GAME]
    phase = stage_words(view) or PHASES[view.phase]
    where = f"Game {view.number}: {phase}, robot {robot_words(view)}."
    return [f"{driver_words(view)}. {where}", *now_lines(view, activity, name)]


def now_lines(view: GameView, activity: Activity | None, name: Name) -> list[str]:
    """Describe the time, who waits for help, the calls, and what staff have chosen."""
    waits, called = waiting_words(view, name), called_words(view, activity)
    stopped = view.phase == "stopped"
    time = time_words(view.seconds, _ends(view), view.paused, _now(view), stopped=stopped)
    told = f"{time}{f'. {waits}' if waits else ''}."
    chosen = ", ".join(filter(None, reversed(_chosen(view))))
    return [*filter(None, (told, called)), f"{chosen}."]


def _now(view: GameView) -> datetime | None:
    """Return the local time of day, if the time of the game is that of the home."""
    return local_now() if view.world in (BENCH, LIVE) else None


def _ends(view: GameView) -> datetime | None:
    """Return when the planned time of the session is over; None: no limit."""
    return datetime.fromisoformat(view.ends) if view.ends else None


def facts(view: GameView) -> list[Fact]:
    """Return the facts beside the call."""
    called = len(view.scene.called)
    return [
        time_facts(
            view.seconds, _ends(view), view.paused, _now(view), stopped=view.phase == "stopped"
        ),
        f"{called} called" if called else "",
        *_chosen(view),
    ]


def _chosen(view: GameView) -> list[str]:
    """Tell what staff have chosen: the pace, the patterns, and how much Tangy does by itself."""
    pace = f"a call every {view.pace:g} s" if view.pace else ""
    several = SEVERAL_WINNERS if view.several else ""
    tangy = tangy_words(view.autonomy, view.battery)
    return [pace, labels_words(view.patterns), several, tangy]
