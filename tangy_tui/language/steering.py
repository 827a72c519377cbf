"""Requests to the program itself: to undo, to pause, for help.

Each sentence stands for a typed command; only a whole sentence counts. They are in the vocabulary
of speech recognition, because most would be misheard otherwise.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cache
from typing import Literal, TypeAlias

from tangy_tui.language.words import Words, bare, words_of

Steering: TypeAlias = Literal[
    "undo", "redo", "phrases", "help", "pause", "go on", "call again", "faster", "slower"
]

WAYS: dict[Steering, tuple[str, ...]] = {
    "undo": (
        *("undo", "undo that", "undo it", "undo the last step", "take that back", "take it back"),
        *("take back that step", "take back the last step", "go one step back", "go back one step"),
        *(
            "one step back",
            "that was wrong",
            "that was a mistake",
            "i made a mistake",
            "scratch that",
        ),
        *("i did not mean that", "i didn't mean that", "delete that", "delete the last step"),
    ),
    "redo": ("redo", "redo that", "redo the last step", "do that again after all"),
    "phrases": (
        *("what can i say", "what could i say", "what may i say", "what do you understand"),
        *("what can i tell you", "what can you do", "show me the phrases", "list the phrases"),
        *("which commands are there", "what are the commands", "what are my choices"),
    ),
    "help": (
        "help",
        "help me",
        "i need help",
        "show the help",
        "how does this work",
        "open the help",
    ),
    "pause": (
        *(
            "pause",
            "pause it",
            "pause the game",
            "make a pause",
            "take a break",
            "let us take a break",
        ),
        *("let's take a break", "wait a moment", "wait a minute", "hold on", "one moment"),
    ),
    "go on": (
        *("go on", "continue", "resume", "carry on", "keep going", "continue the game"),
        *("resume the game", "go on with the game", "let us go on", "let's go on", "proceed"),
    ),
    "call again": (
        *("call again", "say it again", "say that again", "repeat that", "repeat it", "repeat"),
        *("repeat the number", "what was that", "what did you say", "once more", "pardon"),
    ),
    "faster": (
        *("faster", "go faster", "call faster", "a bit faster", "a little faster", "play faster"),
        *("go a bit faster", "go a little faster", "call the numbers faster", "speed up"),
        *("that is too slow", "that's too slow", "this is too slow", "it is too slow"),
    ),
    "slower": (
        *("slower", "go slower", "call slower", "a bit slower", "a little slower", "play slower"),
        *("go a bit slower", "go a little slower", "call the numbers slower", "slow down"),
        *("not so fast", "that is too fast", "that's too fast", "this is too fast"),
        *("it is too fast", "more slowly", "call more slowly"),
    ),
}
WHILE_TEACHING: tuple[Steering, ...] = ("undo", "redo", "phrases", "help")
"""A teacher's requests to the program while showing a game."""
IN_GAMES: tuple[Steering, ...] = ("pause", "go on", "call again", "faster", "slower")
"""Staff's requests to the program while Tangy plays."""


def steering_texts(ways: Collection[Steering]) -> tuple[str, ...]:
    """Return the sentences for some steering requests."""
    return tuple(text for way in ways for text in WAYS[way])


def steering_of(text: str) -> Steering | None:
    """Return the steering request of a sentence, or None."""
    return _ways().get(bare(words_of(text)))


@cache
def _ways() -> dict[Words, Steering]:
    return {bare(words_of(text)): way for way, texts in WAYS.items() for text in texts}
