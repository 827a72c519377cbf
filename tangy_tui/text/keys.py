"""The names of the keymap's actions, in palette and help, and at the foot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from tangy_tui.app.keymap import BY_ID, Keymap


class ActionName(NamedTuple):
    """The name of an action in the palette and in help, and a word for the line of keys."""

    name: str
    short: str


EMPTIES = "empty the line"
"""What Esc does first while there is text in the line for commands."""

NAMES: Mapping[str, ActionName] = MappingProxyType(
    {
        "stop": ActionName("STOP the robot", "STOP"),
        "quit": ActionName("Leave Tangy", "quit"),
        "palette": ActionName("All commands", "commands"),
        "help": ActionName("Help", "help"),
        "draw": ActionName("Draw the screen again", "draw again"),
        "talk": ActionName("Talk to Tangy, or end what you say", "talk"),
        "listen": ActionName("Stop listening, or listen again", "listening"),
        "name": ActionName("Change your name", "your name"),
        "messages": ActionName("Read the last messages again", "messages"),
        "command": ActionName("Type a command", "type"),
        "filter": ActionName("Show only lines with some words", "filter"),
        "zoom": ActionName("Enlarge the panel", "enlarge"),
        "picture": ActionName("Save a picture of the screen", "picture"),
        "mouse": ActionName("Mouse on or off", "mouse"),
        "voice": ActionName("Voice on or off", "voice"),
        "phrases": ActionName("Everything you can say or type", "phrases"),
        "undo": ActionName("Undo the last step or change", "undo"),
        "redo": ActionName("Redo what was undone", "redo"),
        "why": ActionName("Why Tangy does that", "why"),
        "learn": ActionName("Learn from the demonstrations", "learn"),
        "library": ActionName("The library of demonstrations", "library"),
        "next": ActionName("Another game", "next game"),
        "guided": ActionName("Teach in a guided game", "guided"),
        "again": ActionName("Show the game again from the chosen step", "again"),
        "rule": ActionName("Make the last step a rule: the same whatever ...", "rule"),
        "shown": ActionName("What you have shown so far", "shown"),
        "begin": ActionName("Begin the game", "begin"),
        "inside": ActionName("How Tangy decides, or what staff need", "how it decides"),
        "pause": ActionName("Pause or go on", "pause"),
        "step": ActionName("Do one step", "step"),
        "faster": ActionName("Faster", "faster"),
        "slower": ActionName("Slower", "slower"),
        "skip": ActionName("Skip to the end of the game", "to the end"),
        "inject": ActionName("Bring about a fault", "fault"),
        "acknowledge": ActionName("I have seen the fault", "seen"),
        "accept": ActionName("All is well", "all is well"),
        "expert": ActionName("Call the expert, or show whom to call", "expert"),
        "reached": ActionName("I have reached the expert", "reached"),
        "autonomy": ActionName("How much Tangy does by itself", "autonomy"),
        "take_over": ActionName("Say what Tangy does next", "take over"),
        "drive": ActionName("Drive it with the arrow keys", "drive"),
        "call_again": ActionName("Call the last number again", "call again"),
        "ask_for": ActionName("Ask for help for a person", "ask for"),
        "claim": ActionName("Check whether a card wins", "check card"),
        "presence": ActionName("Who has come, or has left", "who is here"),
        "whose_card": ActionName("Say whose card is whose", "whose card"),
        "tell": ActionName("Tell Tangy what a person answers or does", "tell"),
        "put_away": ActionName("Put away, or bring back", "put away"),
        "mark": ActionName("Mark, to merge", "mark"),
        "merge": ActionName("Merge the marked demonstrations", "merge"),
        "split": ActionName("Split after the chosen step", "split"),
        "differences": ActionName("Where they disagree", "disagree"),
        "compare": ActionName("Compare with another", "compare"),
        "another": ActionName("Choose another", "another"),
        "pronounce": ActionName("How a person's name is said", "name"),
        "hear": ActionName("Hear it", "hear"),
        "feedback": ActionName("Say what the person did", "answer"),
        "method": ActionName("How Tangy persuades this person", "method"),
        "join": ActionName("Add a person or a guest", "add"),
        "rename": ActionName("Give a person another name", "rename"),
        "world": ActionName("Simulated, bench or live games", "games"),
        "printed_page": ActionName("Write the report as a page to print (HTML)", "page to print"),
        "camera": ActionName("Show what the camera sees, or hide it", "camera"),
        "back": ActionName("Back", "back"),
        "open": ActionName("Open or choose", "open"),
        "up": ActionName("Up", "up"),
        "down": ActionName("Down", "down"),
        "left": ActionName("Left", "left"),
        "right": ActionName("Right", "right"),
        "panel": ActionName("Next panel", "panel"),
        "page": ActionName("A page up or down", "page"),
        "ends": ActionName("First or last", "first, last"),
        "still": ActionName("Stand still", "stand still"),
        "yes": ActionName("Yes", "yes"),
        "no": ActionName("No", "no"),
        "close": ActionName("Close", "close"),
        "number": ActionName("Choose by number", "choose"),
    }
)

HELP_KEYS = "up down more   esc closes"
DIGIT_SHOWN = "the digit it shows for yes"
"""Placeholder for the key for yes if each question has its own."""

_PLACE = re.compile(r"\{(\^?)([a-z_]+)\}")


def with_keys(text: str, keymap: Keymap, *, typing: bool = False) -> str:
    """Replace names of actions in a text with their keys: "{undo} takes it back".

    "{^talk}" is the key that works while an input line takes letters; `typing` chooses such keys
    for all actions.
    """

    def key(found: re.Match[str]) -> str:
        types = typing or bool(found[1])
        return keymap.shown(found[2], typing=types) if found[2] in BY_ID else found[0]

    return _PLACE.sub(key, text)
