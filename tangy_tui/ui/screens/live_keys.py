"""The keys of the live screen: what they are called, and what is said of them."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.app.game_commands import Autonomy
from tangy_tui.ui.screens import play_keys

NOT_LIVE = ("one_step", "speed", "skip")
"""What can be done in a simulated game, and not to a robot among people."""

DIAL: dict[Autonomy, str] = {
    "alone": "alone",
    "unsure": "asks when unsure",
    "each": "asks each time",
}
"""How much the robot does of itself, as the status line has it; a key turns the dial."""

HELP = (
    "A game among people. The room shows where Tangy believes to be ([• •]), the way it means to "
    "go (·), where else it may be (∴) and what it sees in its way that the plan of the room has "
    "not (*). ctrl+x stops the robot at once, wherever you are; p lets it go on, and pauses the "
    "game after what it is doing. 7 shows its devices, what its cameras see and the last card "
    "that it read; w tells why.\n"
    "i turns the dial of how much Tangy does of itself: all of it, or it asks you before it does "
    "what it is less sure of, or before everything. o takes over: you say what it does next, and "
    "Esc lets it go on by itself after all. d drives it by the arrow keys. c calls the last "
    "number again, x takes it back, h asks for help for somebody who cannot, b says whose card is "
    "whose. l says that what "
    "somebody did last was done otherwise than was seen. f brings a fault about, on the bench. "
    "With a microphone, stop and stop the robot stop it at once when they are said, and t talks "
    "where a key is pushed to talk. Esc ends the game."
)

BINDINGS: list[BindingType] = [
    Binding("i", "autonomy", "How much Tangy does of itself"),
    Binding("o", "take_over", "Say what Tangy does next"),
    Binding("d", "drive", "Drive it by the arrow keys"),
    Binding("c", "call_again", "Call the last number again"),
    Binding("x", "void_call", "Take the last call back"),
    Binding("h", "ask_for", "Ask for help for somebody"),
    Binding("b", "whose_card", "Say whose card is whose"),
    *play_keys.BINDINGS,
]


def keys(*, going: bool, over: bool = False) -> tuple[tuple[str, str], ...]:
    """Return the keys and what they do while the game goes on, stands still, or is over."""
    if over:
        return play_keys.keys(going=going, over=True)
    return (
        ("p", "pause" if going else "go on"), ("^x", "STOP"), ("c", "call again"),
        ("h", "ask for"), ("o", "take over"), ("d", "drive"), ("i", "autonomy"), ("w", "why"),
        ("1-7", "show"), ("esc", "end"), ("?", "help"),
    )  # fmt: skip
