"""Words calls as a caller says them: slowly, with pauses, and repeated digit by digit.

Fifteen and fifty sound alike in a noisy room; "one five" and "five zero" do not. The text on the
screen stays unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from xml.sax.saxutils import escape

from tangy_profiles.cards import Deck

SLOWER = 75  # % of the normal rate; the synthesiser goes no slower than 80 words a minute
BEFORE, AFTER = 400, 600  # ms of pause before and after a call
BETWEEN = "[ \u00a0\u2010\u2011-]?"  # separator between letter and number

_UNSPEAKABLE = re.compile("[\x00-\x1f\x7f-\x9f\u200b-\u200f\u2028-\u202e\u2060-\u2069\ufeff\ufffd]")


@dataclass(frozen=True, slots=True)
class SpokenPiece:
    """Part of a text; a call is spoken slowly, with a pause before and after it."""

    text: str
    call: bool = False


def as_called(text: str, deck: Deck | None) -> tuple[SpokenPiece, ...]:
    """Split a text into plain pieces and calls, worded as a caller says them.

    A call is a letter of the deck with a number of its column ("X 17", "X-17"). Its first
    occurrence in a text is spoken as one number, later ones digit by digit; a single occurrence is
    spoken in both ways.
    """
    text = " ".join(_UNSPEAKABLE.sub(" ", text).split())
    if deck is None:
        return (SpokenPiece(text),) if text else ()
    pattern = _pattern(deck)
    found = [label for match in pattern.finditer(text) if (label := _label(match, deck))]
    return tuple(_pieces(text, pattern, deck, found))


def in_words(pieces: tuple[SpokenPiece, ...]) -> str:
    """Join the pieces into a text."""
    return " ".join(piece.text for piece in pieces)


def marked_up(pieces: tuple[SpokenPiece, ...]) -> str:
    """Return the pieces as SSML for a synthesiser."""
    written: list[str] = []
    for place, piece in enumerate(pieces):
        # espeak-ng reads double brackets as phonemes, even within SSML.
        said = escape(piece.text.replace("[[", "[ ["))
        if piece.call:
            before = place > 0 and not pieces[place - 1].call
            after = place < len(pieces) - 1
            # espeak-ng respects a pause before the slow part, and one at the end inside it; a pause
            # after it is cut short, and without one the rest is slow as well.
            said = (
                f"{_pause(BEFORE) if before else ''}"
                f'<prosody rate="{SLOWER}%">{said}{_pause(AFTER) if after else ""}</prosody>'
            )
        written.append(said)
    return f"<speak>{' '.join(written)}</speak>" if written else ""


def _pause(milliseconds: int) -> str:
    return f'<break time="{milliseconds}ms"/>'


def _pieces(
    text: str, pattern: re.Pattern[str], deck: Deck, found: list[str]
) -> Iterator[SpokenPiece]:
    said: set[str] = set()
    begin = 0
    for match in pattern.finditer(text):
        label = _label(match, deck)
        if not label:
            continue
        if before := text[begin : match.start()].strip():
            yield SpokenPiece(before)
        letter, number = match["letter"], str(int(match["number"]))
        whole, digits = f"{letter}, {number}.", f"{letter}, {' '.join(number)}."
        yield SpokenPiece(digits if label in said else whole, call=True)
        if found.count(label) == 1:
            yield SpokenPiece(digits, call=True)
        said.add(label)
        begin = match.end()
    if rest := text[begin:].strip():
        yield SpokenPiece(rest)


def _label(match: re.Match[str], deck: Deck) -> str:
    """Return a call as the deck writes it; "" if its column has no such number."""
    number = int(match["number"])
    in_column = any(c.letter == match["letter"] and c.low <= number <= c.high for c in deck.columns)
    return deck.label(number) if in_column else ""


@lru_cache(maxsize=8)
def _pattern(deck: Deck) -> re.Pattern[str]:
    letters = "|".join(re.escape(c.letter) for c in deck.columns)
    return re.compile(
        rf"(?<![\w-])(?P<letter>{letters}){BETWEEN}(?P<number>[0-9]{{1,3}})"
        r"(?![\w-]|[.,][0-9])[.,;:!?]*"
    )
