"""The keys of the playing screen: what they are called, and what is said of them."""

from __future__ import annotations

from textual.binding import Binding, BindingType

SPEEDS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
"""Times life; at 1 a game takes the half hour that it takes among people."""


def keys(*, going: bool, over: bool = False) -> tuple[tuple[str, str], ...]:
    """Return the keys and what they do while the game goes on, stands still, or is over."""
    if over:
        return (
            ("g", "plays again"), ("w", "why"), ("1-7", "show"), ("esc", "back"), ("?", "help"),
        )  # fmt: skip
    return (
        ("p", "pause" if going else "go on"), ("n", "step"), ("<>", "speed"), ("e", "end"),
        ("w", "why"), ("1-7", "show"), ("f", "fault"), ("g", "game"), ("esc", "back"),
        ("?", "help"),
    )  # fmt: skip


def faster(speed: float, by: int) -> float:
    """Return the speed (times life) `by` places from the nearest one that there is."""
    nearest = min(range(len(SPEEDS)), key=lambda i: abs(SPEEDS[i] - speed))
    return SPEEDS[min(len(SPEEDS) - 1, max(0, nearest + by))]


HELP = (
    "Tangy plays by what it has learnt. p pauses and goes on, n does one step, < and > change "
    "the speed, e skips to the end of the game, g begins another. w tells why: of the step "
    "that is chosen, or of the last one. Where there is no room for all panels, 1 to 6 choose "
    "one. Where Tangy is not sure it does nothing but ask: type what it should do, and y has "
    "it done; it learns that from you, and the game goes on. While it asks, esc leaves the "
    "line, so that keys are keys again, : leads back to it, and a second esc gives the game "
    "up, if you mean it. Where something happened that was not to be expected, r (or typing: all "
    "right) says that it is all right. When something goes wrong, a line under the first one says "
    "what, what Tangy does about it and what it asks for; a says that you have seen it and takes "
    "the line away, 6 shows all faults of this "
    "game, and Enter there what to do. 7 shows how all devices are, what cameras see and the last "
    "card that was read. When it is critical Tangy stands still until you clear it. "
    "f brings about a fault in the simulated room. v lets Tangy speak, or be quiet: as fast as "
    "in life (x1) every line is heard to its end, and in a faster game the next one cuts it. With "
    "a microphone, t talks where Tangy asks, and stop, said while Tangy does not speak, stops the "
    "robot (ctrl+x always does)."
)

BINDINGS: list[BindingType] = [
    Binding("p", "pause", "Pause or go on"),
    Binding("t", "talk", "Talk to Tangy, or end what you say"),
    Binding("n", "one_step", "One step"),
    Binding("greater_than_sign,full_stop", "speed(1)", "Faster", key_display=">"),
    Binding("less_than_sign,comma", "speed(-1)", "Slower", key_display="<"),
    Binding("e", "skip", "Skip to the end of the game"),
    Binding("g", "again", "Another game"),
    Binding("w", "why", "Why this"),
    Binding("1", "panel('room')", "Show the room"),
    Binding("2", "panel('transcript')", "Show the steps"),
    Binding("3", "panel('policy')", "Show the policy"),
    Binding("4", "panel('posteriors')", "Show the posteriors"),
    Binding("5", "panel('log')", "Show the log"),
    Binding("6", "panel('faults')", "Show the faults of this game"),
    Binding("7", "sensors", "Show the sensors, and what cameras see"),
    Binding("a", "acknowledge", "I have seen the fault"),
    Binding("r", "accept", "What Tangy asks about is all right"),
    Binding("f", "inject", "Bring about a fault (in simulation)"),
    Binding("escape", "leave", "Leave, or give up what Tangy asks"),
]
