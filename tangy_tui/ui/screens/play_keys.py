"""The keys of the playing screen: what they are called, and what is said of them."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.text.games import SENSORS, SHOWS
from tangy_tui.ui.keys import Key, bind

SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Times life; at 1 a game takes the half hour that it takes among people."""


def keys(*, going: bool, over: bool = False) -> tuple[str | Key, ...]:
    """Return the keys and what they do while the game goes on, stands still, or is over."""
    if over:
        return ("next:play again", "why", ("1-7", "show"), "filter", "back", "help")
    return (
        "pause" if going else "pause:go on", "step", "slower", "faster", "why", ("1-7", "show"),
        "filter", "inject", "next:game", "skip", "back", "help",
    )  # fmt: skip


def faster(speed: float, by: int) -> float:
    """Return the speed (times life) `by` places from the nearest one that there is."""
    nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - speed))
    return SPEEDS[min(len(SPEEDS) - 1, max(0, nearest + by))]


HELP = (
    "Tangy plays by what it has learnt. {pause} pauses and goes on, {step} does one step, "
    "{slower} and {faster} change the speed, {skip} skips to the end of the game, {next} begins "
    "another. {why} tells why: of the step that is chosen, or of the last one. {inside} changes "
    "between how Tangy decides and what staff need: the last call, the clock, and everybody. "
    "Where there is no room for all panels, 1 to 6 choose one. Where Tangy is not sure it does "
    "nothing but ask: type what it should do, and a yes has it done; it learns that from you, and "
    "the game goes on. While it asks, esc leaves the line, so that keys are keys again, {command} "
    "leads back to it, and a second esc gives the game up, if you mean it. Where something "
    "unexpected happened, {accept} (or typing: all right) says that it is all right. When "
    "something goes wrong, a line under the first one says what, what Tangy does about it and "
    "what it asks for; {acknowledge} says that you have seen it and takes the line away, 6 shows "
    "all faults of this game, and Enter there what to do. 7 shows how all devices are, what "
    "cameras see and the last card that was read. When it is critical Tangy stands still until "
    "you clear it. {inject} brings about a fault in the simulated room. {voice} lets Tangy speak, "
    "or be quiet: as fast as in life (x1) every line is heard to its end, and in a faster game "
    "the next one cuts it. With a microphone, {talk} talks where Tangy asks, and stop, said while "
    "Tangy does not speak, stops the robot ({stop} always does)."
)

PANELS = ("room", "transcript", "policy", "posteriors", "log", "faults")
"""What the numbers show, from 1 on."""

BINDINGS: list[BindingType] = [
    *bind("pause"),
    *bind("talk"),
    *bind("step", "one_step"),
    *bind("faster", "speed(1)"),
    *bind("slower", "speed(-1)"),
    *bind("skip"),
    *bind("next", "again"),
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
