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
    "go (·), where else it may be (∴), and what it sees in its way that the plan of the room has "
    "not (*). {stop} stops the robot at once, wherever you are, and {pause} lets it go on. Saying "
    "stop the robot does the same, if there is a microphone. What cannot be undone asks first. "
    "{command} takes commands in words, also those that have no key. {messages} shows the last "
    "messages again."
)

LETTERS_FOLLOW = {
    **play_keys.LETTERS_FOLLOW,
    **{id: id for id in ("take_over", "ask_for", "whose_card", "tell")},
}

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


CARDS_ONLY, FACTS_ONLY = ("call_again", "void_call", "whose_card", "speed"), ("tell",)
"""Actions only for activities with cards, and only for declared activities."""


def keys(
    *,
    going: bool,
    over: bool = False,
    cards: bool = True,
    claims: bool = True,
    tells: bool = False,
    now: bool = True,
    joining: bool = False,
) -> tuple[str | Key, ...]:
    """Return the keys and their names while the game runs, is paused, or is over.

    `now`: the panel *Now* is visible; from others, Esc leads back to it. `joining`: the robot is
    set up for a new person.
    """
    if joining:
        return ("stop", "presence", "messages", ("1-7", "show"), "palette", "help")
    if over:
        return play_keys.keys(going=going, over=True)
    return (
        "pause" if going else "pause:go on", "stop",
        *(("tell",) if tells or not cards else ()),
        *(("claim",) if claims else ()), "why", "command",
        *(("slower", "faster") if cards else ()), "autonomy",
        *(("undo:take back",) if cards else ()), *(("presence",) if cards else ()), "messages",
        *(("call_again",) if cards else ()), "ask_for", "take_over", "drive", "inside",
        ("1-7", "show"), "back:leave" if now else "back", "help",
    )  # fmt: skip
