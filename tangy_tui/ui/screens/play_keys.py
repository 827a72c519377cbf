"""The keys of the playing screen, with their names and help."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.text.games import SENSORS, SHOWS
from tangy_tui.ui.keys import Key, bind

SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Ratios to real time; at 1 a game takes half an hour, as among people."""


def keys(*, going: bool, over: bool = False) -> tuple[str | Key, ...]:
    """Return the keys and their names while the game runs, is paused, or is over."""
    if over:
        return ("next:play again", "why", ("1-7", "show"), "filter", "back", "help")
    return (
        "pause" if going else "pause:go on", "step", "slower", "faster", "why", ("1-7", "show"),
        "filter", "inject", "next:game", "skip", "back:leave", "help",
    )  # fmt: skip


def faster(speed: float, by: int) -> float:
    """Return the speed (ratio to real time) `by` places from the nearest available one."""
    nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - speed))
    return SPEEDS[min(len(SPEEDS) - 1, max(0, nearest + by))]


HELP = (
    "Tangy plays with what it has learnt. {pause} pauses and goes on, {step} does one step, "
    "{slower} and {faster} change the speed, {skip} skips to the end of the game, {next} begins "
    "another. {why} gives the reason for the chosen step, or for the last one. {inside} switches "
    "between how Tangy decides and what staff need: the last call, the clock, and everybody. "
    "On a small screen, 1 to 6 choose the panel. If Tangy is not sure, it only asks: type what it "
    "should do, and say yes; Tangy does it, learns it from you, and the game goes on. While it "
    "asks, esc leaves the line so that keys work again, {command} goes back to it, and a second "
    "esc gives the game up, after a question. After something unexpected, {accept} (or typing: "
    "all right) says that all is well. When something goes wrong, the second line says what, what "
    "Tangy does about it and what it asks for; {acknowledge} says that you have seen it and hides "
    "the line, 6 lists all faults of this game, and Enter there shows what to do. 7 shows the "
    "state of all devices, what cameras see and the last card that was read. After a critical "
    "fault Tangy stands still until you clear it. {inject} simulates a fault in the simulated "
    "room. {voice} turns Tangy's voice on or off: at life speed (x1) it finishes every line, in a "
    "faster game the next line cuts it short. With a microphone, {talk} lets you talk when Tangy "
    "asks; saying stop while Tangy is quiet stops the robot ({stop} always does)."
)

PANELS = ("room", "transcript", "policy", "posteriors", "log", "faults")
"""The panels of the number keys, from 1."""

LETTERS_FOLLOW = {"inject": "inject", "claim": "claim", "presence": "presence", "command": "type"}
"""See `TangyScreen.LETTERS_FOLLOW`."""

BINDINGS: list[BindingType] = [
    *bind("pause"),
    *bind("talk"),
    *bind("step", "one_step"),
    *bind("faster", "speed(1)"),
    *bind("slower", "speed(-1)"),
    *bind("skip"),
    *bind("next"),
    *bind("why"),
    *bind("inside"),
    *bind("claim"),
    *bind("presence"),
    *bind("command", "type"),
    *(
        Binding(str(number), f"panel('{panel}')", SHOWS[panel], id="number")
        for number, panel in enumerate(PANELS, 1)
    ),
    Binding("7", "sensors", SENSORS, id="number"),
    *bind("acknowledge"),
    *bind("accept"),
    *bind("inject"),
    *bind("back", "leave"),
]
