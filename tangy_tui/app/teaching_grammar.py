"""The grammar of typed commands while teaching.

The parsers return `None` for words that are no command, as those of `command_grammar` do.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass
from typing import TypeAlias

from tangy_tui.app.command_grammar import LEAVING, LONGEST_NUMBER
from tangy_tui.app.inquiry_grammar import Inquiry
from tangy_tui.app.screen_grammar import PERFORMS, Perform, read_program
from tangy_tui.language.steering import WHILE_TEACHING, steering_of
from tangy_tui.language.stop_sentence import stops
from tangy_tui.learning.remarks import answers_to
from tangy_tui.learning.teaching_events import (
    Discard,
    Finish,
    Next,
    Redo,
    Remark,
    RemarkAnswer,
    SameWhatever,
    Settle,
    Undo,
)
from tangy_tui.learning.verification import StopCommand


@dataclass(frozen=True, slots=True)
class Leave:
    """Leave; confirmed steps are kept."""


@dataclass(frozen=True, slots=True)
class AgainFrom:
    """Demonstrate the present game again from a step, counted from 1; None: no step was given."""

    step: int | None


_WHATEVER = re.compile(r"(?:always )?(?:it is |do |that is )?the same whatever(.*)")


@dataclass(frozen=True, slots=True)
class TeachAs:
    """The teacher's name."""

    name: str


TeachingWord: TypeAlias = (
    Undo
    | SameWhatever
    | Redo
    | Next
    | Discard
    | Finish
    | AgainFrom
    | Leave
    | StopCommand
    | TeachAs
    | Perform
    | Inquiry
)

TEACHING: dict[str, TeachingWord] = {
    **dict.fromkeys(("undo", "take that back"), Undo()),
    "redo": Redo(),
    **dict.fromkeys(("next", "next game", "new game", "another game"), Next()),
    **dict.fromkeys(
        ("discard the game", "discard game", "discard this game", "throw the game away"), Discard()
    ),
    **dict.fromkeys(("finish the demonstration", "finish here", "that is all"), Finish()),
    **dict.fromkeys(("start over", "begin again", "begin anew", "start again"), AgainFrom(1)),
    **dict.fromkeys(("shown", "seen"), "shown"),
    **PERFORMS,
}
"""Commands while teaching, besides the word of every action of the keymap."""

_AGAIN = re.compile(r"(?:show )?again(?: from)?(?: step)?(?: (\d{1,6}|n))?")
_CALLED = re.compile(r"(?:my name is|my name's|i am called) (\S.*)", re.I)


def read_teaching(text: str, game: Collection[str] = ()) -> TeachingWord | None:
    """Parse words as a command of teaching; None if they are none."""
    words = " ".join(text.split()).casefold()
    if words == "stop" or stops(text, game):
        return StopCommand(text)
    if called := _CALLED.fullmatch(" ".join(text.split()).rstrip(".!")):
        return TeachAs(called[1])
    if rule := _WHATEVER.fullmatch(words):
        return SameWhatever(_named_facts(rule[1]))
    if again := _AGAIN.fullmatch(words):
        number = again[1]
        return AgainFrom(int(number) if number and number.isdecimal() else None)
    if (way := steering_of(text)) in WHILE_TEACHING:
        words = str(way)
    if words in TEACHING:
        return TEACHING[words]
    return Leave() if words in LEAVING else read_program(words)


def _named_facts(words: str) -> tuple[str, ...]:
    """Return the facts that words name: "the clock and hinted are", "the value of clock"."""
    kept = re.sub(r"\b(?:is|are|(?:the )?values? of|the|happens|comes)\b", " ", words)
    return tuple(" ".join(one.split()) for one in re.split(r",| and | or ", kept) if one.strip())


SETTLING: dict[str, RemarkAnswer] = {
    "this": "this",
    "earlier": "earlier",
    "both": "both",
    **dict.fromkeys(("keep", "keep it", "y", "yes"), "keep"),
    **dict.fromkeys(("later", "decide later", "n", "no"), "later"),
}
"""Words that answer a remark, besides the numbers."""


def read_settling(text: str, remark: Remark) -> Settle | None:
    """Parse words as an answer to a remark; None if they are none of its answers."""
    words, answers = text.strip().casefold(), answers_to(remark)
    if words.isdecimal() and words.isascii() and len(words) <= LONGEST_NUMBER:
        number = int(words)
        return Settle(answers[number - 1]) if 1 <= number <= len(answers) else None
    answer = SETTLING.get(words)
    return Settle(answer) if answer == "later" or answer in answers else None
