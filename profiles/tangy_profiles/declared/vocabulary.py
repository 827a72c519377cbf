"""The closed vocabularies of an activity's file, as types that mypy checks."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Literal, get_args

Kind = Literal["flag", "choice", "count", "timer", "test"]
"""Kinds of facts: no or yes; one of its values; a number; seconds; the result of conditions."""
KINDS: tuple[Kind, ...] = get_args(Kind)

Source = Literal["button", "sign", "speech", "camera", "card", "staff"]
"""Sources of facts about people."""
SOURCES: tuple[Source, ...] = get_args(Source)

Quantifier = Literal["", "any", "every", "nobody", "most", "only one"]
"""Quantifiers over players in a condition; "": the person of the stage."""
QUANTIFIERS: tuple[Quantifier, ...] = get_args(Quantifier)[1:]

Comparison = Literal["is", "is not", ">=", "<"]

Does = Literal[
    "set",  # FACT VALUE
    "add",  # FACT [NUMBER]
    "clear",  # FACT: its first value, 0, or not running
    "start",  # FACT: a timer, from 0 s
    "next item",
    "next turn",
    "go to front",
    "go to whom",
    "close request",
    "invite",  # FACT VALUE: a person is asked to set it
    "finish",
]
"""Effects of a behaviour on the game."""
DOES: tuple[Does, ...] = get_args(Does)

Named = Literal[
    "group",
    "first asking",
    "whose turn",
    "next in circle",
    "quietest",
    "last to act",
    "addressed",
    "beside",
]
SELECTORS: tuple[Named, ...] = get_args(Named)
Selector = str
"""Selects the person of a behaviour or a stage: one of `SELECTORS`, or `whose CONDITION`."""
WHOSE = "whose "
"""Precedes the condition of a selector, which names the first person for whom it became true."""

Order = Literal["given", "shuffled"]
ORDERS: tuple[Order, ...] = get_args(Order)

Turns = Literal["in order", "by lot"]
TURNS: tuple[Turns, ...] = get_args(Turns)
"""Orders of the players' turns: as they sit, or drawn for each game."""

ASKING, TURN, ADDRESSED, PLACE, ITEMS = "asking", "turn", "addressed", "place", "items"
BUILT_IN: dict[str, tuple[str, ...]] = {
    ITEMS: ("left", "over"),
    ASKING: ("no", "yes"),
    TURN: ("no", "yes"),
    ADDRESSED: ("no", "yes"),
    PLACE: ("elsewhere", "front", "beside"),
}
"""The built-in facts with their values; all except the items are per player."""

NO, YES = "no", "yes"

HERE = "here"
"""The observation that a player leaves (no) or comes back (yes); not usable in conditions."""

SLOT = re.compile(r"\{([^{}]*)\}")
"""A slot of a text, such as `{name}`."""

MARKS = ("facts", "flags", "items", "people")
"""Keys that identify the file of an activity declared by facts."""


def declares(keys: Iterable[str]) -> bool:
    """Return whether a file's keys are those of an activity declared by facts."""
    return any(key in MARKS for key in keys)
