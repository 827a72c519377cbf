"""The keys of the live screen, with their names and help."""

from __future__ import annotations

from textual.binding import BindingType

from tangy_tui.app.game_commands import Autonomy
from tangy_tui.text.control import TAKE_CALL_BACK
from tangy_tui.ui.keys import Key, bind
from tangy_tui.ui.screens import play_keys

NOT_LIVE = ("one_step", "skip")
"""Actions of simulated games that are not available with a robot among people."""

DIAL: dict[Autonomy, str] = {
    "alone": "alone",
    "unsure": "asks when unsure",
    "each": "asks each time",
}
"""The levels of autonomy on the status line; a key cycles through them."""

HELP = (
    "A game among people. The room shows where Tangy believes it is ([• •]), the way it means to "
    "go (·), where else it may be (∴) and what it sees in its way that the plan of the room has "
    "not (*). {stop} stops the robot at once, wherever you are; {pause} lets it go on, and pauses "
    "the game after what it is doing. 7 shows its devices, what its cameras see and the last card "
    "that it read; {why} tells why.\n"
    "{autonomy} turns the dial of how much Tangy does by itself: all of it, or it asks you before "
    "it does what it is less sure of, or before everything. {take_over} takes over: you say what "
    "it does next, and Esc lets it go on by itself after all. {drive} drives it with the arrow "
    "keys. {call_again} calls the last number again, {undo} takes it back, {ask_for} asks for "
    "help for a person who cannot, {whose_card} says whose card is whose; in an activity without "
    "cards {tell} tells Tangy what a person answers or does, and how a card is if the robot has no "
    "camera. {faster} and {slower} "
    "change the pace, {claim} checks whether a card wins, {presence} notes who has come or left, "
    "{command} takes all of these and more in words, and {inside} shows how Tangy decides. "
    "{inject} simulates a fault, on the bench. With a microphone, saying stop or stop the robot "
    "stops it at once, and with push-to-talk {talk} lets you talk. Esc ends the game."
)

BINDINGS: list[BindingType] = [
    *bind("autonomy"),
    *bind("take_over"),
    *bind("drive"),
    *bind("call_again"),
    *bind("undo", "void_call", name=TAKE_CALL_BACK),
    *bind("ask_for"),
    *bind("whose_card"),
    *bind("tell"),
    *play_keys.BINDINGS,
]


CARDS_ONLY, FACTS_ONLY = ("call_again", "void_call", "whose_card"), ("tell",)
"""Actions only for activities with cards, and only for declared activities."""


def keys(
    *, going: bool, over: bool = False, cards: bool = True, tells: bool = False
) -> tuple[str | Key, ...]:
    """Return the keys and their names while the game runs, is paused, or is over."""
    if over:
        return play_keys.keys(going=going, over=True)
    return (
        "pause" if going else "pause:go on", "stop",
        *(("tell",) if tells or not cards else ()),
        *(("claim", "slower", "faster") if cards else ()), "autonomy",
        *(("undo:call back",) if cards else ()), "command", *(("presence",) if cards else ()),
        *(("call_again",) if cards else ()), "ask_for", "take_over", "drive", "why", "inside",
        ("1-7", "show"), "back:end", "help",
    )  # fmt: skip
