"""The keys of the teaching screen, and what its help says of them."""

from __future__ import annotations

from textual.binding import Binding, BindingType

KEYS = "f2 undo  f3 redo  f4 why  f5 learn  f7 next  f8 seen  f9 again  esc home"
HEARING_KEYS = "t talk  f2 undo  f3 redo  f4 why  f5 learn  f7 next  f8 seen  esc home"
"""The same where there is a key to push to talk."""

WATCHING = "up down a step  f4 why  f8 seen  ? help  esc leave"
"""The keys that a scripted teacher leaves to who watches."""

HELP = (
    "You are the teacher. Look at the room, decide what Tangy should do, and type it. Tangy "
    "asks whether it understood; press y and it is done. People press a button when they "
    "want help (?1, ?2, ... is whose turn it is): go to them, and the line Now says what "
    "Tangy sees there. Letters always go to the command line. Leave whenever you like: what you "
    "confirmed is kept. Typed, undo, redo, again 7, why, seen, next and voice do what their keys "
    "do, and phrases shows all that can be said."
)

BINDINGS: list[BindingType] = [
    Binding("t", "talk", "Talk to Tangy, or end what you say"),
    Binding("f2", "undo", "Undo the last step"),
    Binding("ctrl+z", "undo", "Undo the last step", show=False, priority=True),
    Binding("f3", "redo", "Do the step again that was undone"),
    Binding("ctrl+y", "redo", "Do it again", show=False, priority=True),
    Binding("f4", "why", "Why: what Tangy would do here by now"),
    Binding("f5", "learn", "Learn from the demonstrations"),
    Binding("f7", "next", "Another demonstration"),
    Binding("f8", "coverage", "What was shown and what not"),
    Binding("f9", "again", "Show again from the chosen step"),
    Binding("up", "choose(-1)", "Choose a step", show=False),
    Binding("down", "choose(1)", "Choose a step", show=False),
    Binding("escape", "leave", "Leave; your steps are kept"),
    Binding("escape", "think_no_more", "Cancel", show=False, priority=True),
]
