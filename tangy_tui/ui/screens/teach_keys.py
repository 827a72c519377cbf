"""The keys of the teaching screen, and what its help says of them."""

from __future__ import annotations

from textual.binding import Binding, BindingType

KEYS = "u undo  U redo  a again  w why  c seen  d next  r learn  : type  esc home"
HEARING_KEYS = "t talk  u undo  a again  w why  c seen  d next  r learn  : type  esc home"
"""The same where there is a key to push to talk."""

WATCHING = "up down a step  w why  c seen  ? help  esc leave"
"""The keys that a scripted teacher leaves to who watches."""

WHICH_STEP = "Choose the step first: up and down, or type again 7."

HELP = (
    "You are the teacher. Look at the room, decide what Tangy should do, and type it. Tangy "
    "asks whether it understood; press y and it is done. People press a button when they "
    "want help (?1, ?2, ... is whose turn it is): go to them, and the line Now says what "
    "Tangy sees there. Leave whenever you like: what you confirmed is kept. Typed, undo, redo, "
    "again 7, why, seen, next and voice do what their keys do, and phrases shows all that can be "
    "said."
)

BY_KEY = (
    "To talk, press t (in the command line ctrl+t), say it, and press t again; after 6 seconds it "
    "ends by itself. The line of the microphone says what it hears, and what is wrong if nothing "
    "comes. Say stop, and the robot stops."
)
HANDS_FREE = (
    "Just say what Tangy should do: the microphone is open, except while Tangy speaks. Say stop, "
    "and the robot stops."
)

BINDINGS: list[BindingType] = [
    Binding("t", "talk", "Talk to Tangy, or end what you say"),
    Binding("u", "undo", "Undo the last step"),
    Binding("ctrl+z", "undo", "Undo the last step", show=False, priority=True),
    Binding("U", "redo", "Do the step again that was undone", key_display="U"),
    Binding("ctrl+y", "redo", "Do it again", show=False, priority=True),
    Binding("a", "again", "Show again from the chosen step"),
    Binding("w", "why", "Why: what Tangy would do here by now"),
    Binding("c", "coverage", "What was shown and what not"),
    Binding("up,k", "choose(-1)", "Choose a step", show=False),
    Binding("down,j", "choose(1)", "Choose a step", show=False),
    Binding("r", "learn", "Learn from the demonstrations"),
    Binding("d", "next", "Another demonstration"),
    Binding("escape", "leave", "Leave; your steps are kept"),
    Binding("escape", "think_no_more", "Cancel", show=False, priority=True),
]
