"""The keys of the teaching screen, and its help."""

from __future__ import annotations

from textual.binding import Binding, BindingType

from tangy_tui.text.teaching import CANCEL, CHOOSE_STEP, LEAVE
from tangy_tui.text.tour import SKIP_TOUR, TOUR_ON
from tangy_tui.ui.keys import bind
from tangy_tui.ui.panels import HOME

KEYS = ("undo", "redo", "why", "learn", "shown", "next", "again", "library", HOME, "help")
HEARING_KEYS = ("talk", "undo", "redo", "why", "learn", "next", "listen", HOME, "help")
"""The same with a microphone."""

RULE_KEYS = (
    *("undo", "why", "rule", "shown", "learn", "next"),
    *("redo", "again", "library", HOME, "help"),
)
RULE_HEARING_KEYS = (
    *("talk", "undo", "why", "rule", "shown", "learn", "next"),
    *("redo", "listen", HOME, "help"),
)
"""The same for an activity whose steps can become rules."""

TOUR_KEYS = ("undo", "redo", "back:skip the tour", "help")
TOUR_GOES_ON = "open:go on"
"""The same during the tour."""

NOT_WATCHING = ("undo", "redo", "again", "next", "discard", "perform", "rule")
"""Actions of the teacher only."""

WATCHING = (("up down", "a step"), "why", "shown", "back:leave", "help")
"""The keys for onlookers of a scripted teacher."""

HELP = (
    "You are the teacher. Look at the room, decide what Tangy should do, and type it. Tangy "
    "asks whether it understood; press {yes} and it is done. People press a button when they "
    "want help (?1, ?2, ... is whose turn it is): go to them, and the line Now says what "
    "Tangy sees there. Letters always go to the command line. Leave whenever you like: what you "
    "confirmed is kept. What keys do can be typed, too, in the words beside them; and: "
    "discard the game, start over, finish the demonstration, again 7."
)

BINDINGS: list[BindingType] = [
    *bind("talk"),
    *bind("undo"),
    *bind("redo"),
    *bind("why"),
    *bind("learn", "perform('learn')"),
    *bind("library", "perform('library')"),
    *bind("next"),
    *bind("guided", "perform('guided')"),
    *bind("again"),
    *bind("rule"),
    *bind("shown", "coverage"),
    *bind("listen", "app.listen"),
    *bind("name", "perform('name')"),
    Binding("up", "choose(-1)", CHOOSE_STEP, show=False, id="up"),
    Binding("down", "choose(1)", CHOOSE_STEP, show=False, id="down"),
    *bind("back", "leave", name=LEAVE),
    Binding("escape", "think_no_more", CANCEL, show=False, priority=True, id="back"),
    Binding("escape", "tour('skip')", SKIP_TOUR, show=False, priority=True, id="back"),
    Binding("enter", "tour('on')", TOUR_ON, show=False, priority=True, id="open"),
]
