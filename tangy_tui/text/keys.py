"""The names of the keymap's actions, in palette and help, and at the foot."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from tangy_tui.app.keymap import BY_ID, Keymap


class Named(NamedTuple):
    """The name of an action in the palette and in help, and a word for the line of keys."""

    name: str
    short: str


NAMES: Mapping[str, Named] = MappingProxyType(
    {
        "stop": Named("STOP the robot", "STOP"),
        "quit": Named("Leave Tangy", "quit"),
        "palette": Named("All commands", "commands"),
        "help": Named("Help", "help"),
        "draw": Named("Draw the screen again", "draw again"),
        "talk": Named("Talk to Tangy, or end what you say", "talk"),
        "listen": Named("Stop listening, or listen again", "listening"),
        "name": Named("Change your name", "your name"),
        "command": Named("Type a command", "type"),
        "filter": Named("Show only lines with some words", "filter"),
        "zoom": Named("Enlarge the panel", "enlarge"),
        "picture": Named("Save a picture of the screen", "picture"),
        "mouse": Named("Mouse on or off", "mouse"),
        "voice": Named("Voice on or off", "voice"),
        "phrases": Named("Everything you can say or type", "phrases"),
        "undo": Named("Undo the last step or change", "undo"),
        "redo": Named("Redo what was undone", "redo"),
        "why": Named("Why Tangy does that", "why"),
        "learn": Named("Learn from the demonstrations", "learn"),
        "library": Named("The library of demonstrations", "library"),
        "next": Named("Another game", "next game"),
        "guided": Named("Teach in a guided game", "guided"),
        "again": Named("Show the game again from the chosen step", "again"),
        "rule": Named("Make the last step a rule: the same whatever ...", "rule"),
        "shown": Named("What you have shown so far", "shown"),
        "begin": Named("Begin the game", "begin"),
        "inside": Named("How Tangy decides, or what staff need", "how it decides"),
        "pause": Named("Pause or go on", "pause"),
        "step": Named("Do one step", "step"),
        "faster": Named("Faster", "faster"),
        "slower": Named("Slower", "slower"),
        "skip": Named("Skip to the end of the game", "to the end"),
        "inject": Named("Bring about a fault", "fault"),
        "acknowledge": Named("I have seen the fault", "seen"),
        "accept": Named("All is well", "all is well"),
        "expert": Named("Call the expert, or show whom to call", "expert"),
        "reached": Named("I have reached the expert", "reached"),
        "autonomy": Named("How much Tangy does by itself", "autonomy"),
        "take_over": Named("Say what Tangy does next", "take over"),
        "drive": Named("Drive it with the arrow keys", "drive"),
        "call_again": Named("Call the last number again", "call again"),
        "ask_for": Named("Ask for help for a person", "ask for"),
        "claim": Named("Check whether a card wins", "check card"),
        "presence": Named("Who has come, or has left", "who is here"),
        "whose_card": Named("Say whose card is whose", "whose card"),
        "tell": Named("Tell Tangy what a person answers or does", "tell"),
        "put_away": Named("Put away, or bring back", "put away"),
        "mark": Named("Mark, to merge", "mark"),
        "merge": Named("Merge the marked demonstrations", "merge"),
        "split": Named("Split after the chosen step", "split"),
        "differences": Named("Where they disagree", "disagree"),
        "compare": Named("Compare with another", "compare"),
        "another": Named("Choose another", "another"),
        "pronounce": Named("How a person's name is said", "name"),
        "hear": Named("Hear it", "hear"),
        "feedback": Named("Say what the person did", "answer"),
        "method": Named("How Tangy persuades this person", "method"),
        "join": Named("Add a person or a guest", "add"),
        "rename": Named("Give a person another name", "rename"),
        "world": Named("Simulated, bench or live games", "games"),
        "camera": Named("Show what the camera sees, or hide it", "camera"),
        "back": Named("Back", "back"),
        "open": Named("Open or choose", "open"),
        "up": Named("Up", "up"),
        "down": Named("Down", "down"),
        "left": Named("Left", "left"),
        "right": Named("Right", "right"),
        "panel": Named("Next panel", "panel"),
        "page": Named("A page up or down", "page"),
        "ends": Named("First or last", "first, last"),
        "still": Named("Stand still", "stand still"),
        "yes": Named("Yes", "yes"),
        "no": Named("No", "no"),
        "close": Named("Close", "close"),
        "number": Named("Choose by number", "choose"),
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
