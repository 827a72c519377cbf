"""Words for live games: switching a robot on, localising it, and releasing it."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import TYPE_CHECKING

from tangy_profiles.robot import Robot
from tangy_tui.text.endings import ending_words
from tangy_tui.text.numbers import listed

if TYPE_CHECKING:
    from datetime import datetime

    from tangy_tui.monitoring.games import Game

STARTING = "Its devices are being started. It stands still until the game begins."
LEAVES_OFF, KEEPS_GAME = "leave it off", "leave it off, and keep the game for later"
GAME_KEPT = "The game is kept: begin a live game to go on with it."
TRY_AGAIN = "Switch Tangy on again, and go on with the game?"
KEEPS_IF_OFF = "If you leave it off, the game is kept: begin a live game to go on with it."
STOPPED_MEANWHILE = "You stopped it. After you switch it on, it stands until you let it go on."
STOPPED_BEFORE = "Tangy was stopped: it stands still until you let it go on."
WAITS_UNTIL_ON = "Tangy is still being switched on. It does that when it is on."
ON_FIRST = "Tangy is still being switched on, and stands still. Type that again when it is on."
READY, NOW = "Ready: {}.", "Starting now: {} ..."
PARTS = {
    "bench": "simulated devices and people",
    "faces": "pictures of people's faces",
    "program": "the robot's program",
    "senses": "card and face reader",
    "first words": "first reports of the devices",
    "requests": "requests for help",
}
CALLED_OFF = "It is being switched off again."

LOOKS_ROUND = "Tangy does not know where it is: it turns on the spot, then drives to the front."
MAY_MOVE = "Tangy may move again."


SECONDS_TOLD = 5
"""The time until a game goes on is told in steps of so many s."""


def starting_again_words(names: Sequence[str], seconds: float = 0.0) -> str:
    """Tell that the robot is switched on again for new people.

    `seconds` is about how long that takes; 0: unknown.
    """
    joins = f"{listed(names)} {'joins' if len(names) == 1 else 'join'}."
    about = ceil(seconds / SECONDS_TOLD) * SECONDS_TOLD
    soon = f"in about {about} s" if about else "soon"
    return (
        f"{joins} The game goes on {soon}: Tangy's devices are being started again. It stands "
        "still until then."
    )


def part_words(part: str, robot: Robot) -> str:
    """Name the part of a robot that is being started: a device, or another part."""
    device = robot.devices.get(part)
    return PARTS.get(part) or (part if device is None else device.label)


def parts_lines(parts: Sequence[str], done: tuple[int, int] | None, robot: Robot) -> list[str]:
    """Tell the parts that were started, and the part in progress with its fraction."""
    if not parts:
        return []
    *before, now = (part_words(part, robot) for part in dict.fromkeys(parts))
    count = "" if done is None else f" ({done[0]} of {done[1]})"
    return [*([READY.format(", ".join(before))] if before else []), NOW.format(f"{now}{count}")]


def frozen_words(seconds: float) -> str:
    """Tell for how many `seconds` (s) the program in the robot was frozen, and the consequence."""
    return (
        f"The program in the robot was frozen for {seconds:.0f} s. Tangy has stopped what it "
        "was doing, and stands still until you let it go on."
    )


SWITCH_ON_DETAIL = (
    "Make sure that it stands at the front and faces the people, that nobody is close to it, and "
    "that someone is near its stop button. In the game ctrl+x stops it, too."
)


def switch_on_words(robot: str) -> str:
    """Ask before a robot is switched on."""
    return f"Switch {robot} on?"


def played_lines(games: Sequence[Game], since: datetime, report: str) -> list[str]:
    """Tell how the games ended that ended `since` a time, and which command is for the report."""
    over = [game for game in games if game.ended is not None and game.ended >= since]
    lines = [f"Game {game.number}: {ending_words(game).rstrip('.')}." for game in over]
    return [*lines, report_words(report)] if over else []


def report_words(command: str) -> str:
    """Tell the command for the report of a session."""
    return f"For the report of the session, type: {command}"
