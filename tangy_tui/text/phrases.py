"""The phrasebook in words: what can be said or typed, and how it is searched."""

from __future__ import annotations

LIST_TITLE = "What can be said or typed"
LIST_HELP = (
    "Up and down choose an entry, {filter} searches, {hear} says it aloud. Tangy does not hear a "
    "name yet if it only guesses how it sounds: choose the person and press {pronounce}."
)
CHOOSE_SAYABLE = "Choose something you can say: a word, a person or a behaviour."
CHOOSE_PERSON = "Choose a person: the activity's words are changed in its file."
NONE_FOUND = "Nothing found: esc shows everything again."
LOOKING_UP = "Looking up the words ..."
