"""The grammar of commands that change a game: pace, patterns, a call, a claim, who is present."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress
from functools import partial

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import LONGEST_PACE, SHORTEST_PACE, GameRules
from tangy_profiles.reading import plain
from tangy_tui.app.game_commands import (
    ChoosePatterns,
    ClaimCard,
    ComesIn,
    GameCommand,
    GoesAway,
    HasCard,
    Joins,
    SetPace,
    TakeBackCall,
)
from tangy_tui.app.presence_grammar import one_person_each, read_moved
from tangy_tui.app.time_grammar import read_time

CHECK = "check"
"""The word before a card's number in every activity; an activity may define another."""
_PACE = re.compile(r"pace (\d{1,4}(?:\.\d)?)(?: ?s| seconds?)?", re.I)
_PATTERNS = re.compile(r"(?:play for|play on for|patterns?) (.+)", re.I)
_JOINS = re.compile(
    r"(?:(add|guest)(?: (.+?))?|([^:]+?) joins(?: in| us)?)"
    r"(?:,? (?:at|on|in|to) (?:(table) |seat |chair |place )(\d{1,2}))?",
    re.I,
)
_CARD = re.compile(
    r"(.+?) (?:has|holds) (?:the )?card (?:number )?#?(\d{1,6})"
    r"|card (?:number )?#?(\d{1,6}) (?:is|belongs to) (.+?)(?:['\u2019]s)?",
    re.I,
)
_CLAIMS = re.compile(r"(.+?) (?:has|calls|says|shouts|claims|got)(?: a| an)? (.+)", re.I)
_TAKE_BACK = re.compile(r"take back (\S{1,8})", re.I)


def lines_of(said: str, read: Callable[[str], object]) -> list[str]:
    """Return the lines to carry out: one for each person if a line names several.

    Args:
        said: the line.
        read: reads a line as a command.

    Raises:
        TangyError: the line cannot be read, or it names a person who is not known.
    """
    try:
        if read(said) is not None:
            return [said]
    except TangyError:
        each = one_person_each(said)
        if len(each) == 1:
            raise
    else:
        each = one_person_each(said)
        if len(each) == 1 or not any(map(partial(_reads, read), each)):
            return [said]
    for line in each:
        read(line)
    return each


def _reads(read: Callable[[str], object], line: str) -> bool:
    """Return whether a line can be read as a command."""
    with suppress(TangyError):
        return read(line) is not None
    return False


def read_planned(
    said: str, find_person: Callable[[str], str], rules: GameRules
) -> GameCommand | None:
    """Parse words as one of these commands; None if they are none.

    Raises:
        TangyError: they resemble a command, but a part of it is wrong; one sentence.
    """
    if claim := _claim(said, find_person, rules):
        return claim
    if (time := read_time(said)) is not None:
        return time
    if rules.claim and (card := _CARD.fullmatch(said)):
        return HasCard(find_person(card[1] or card[4]), int(card[2] or card[3]))
    if pace := _PACE.fullmatch(said):
        seconds = float(pace[1])
        if not SHORTEST_PACE <= seconds <= LONGEST_PACE:
            raise TangyError(f"The pace is from {SHORTEST_PACE:g} to {LONGEST_PACE:g} s.")
        return SetPace(seconds)
    if (back := _TAKE_BACK.fullmatch(said)) and back[1].casefold() not in ("it", "that"):
        return TakeBackCall(back[1])
    if rules.patterns and (patterns := _PATTERNS.fullmatch(said)):
        names = [one.strip() for one in re.split(r",|\bthen\b", patterns[1]) if one.strip()]
        return ChoosePatterns(tuple(rules.pattern(name).name for name in names))
    if joins := _JOINS.fullmatch(said):
        place = int(joins[5] or 0)
        seat, table = (0, place) if joins[4] else (place, 0)
        guest = (joins[1] or "").casefold() == "guest"
        return Joins(joins[2] or joins[3] or "", guest, seat, table)
    if (moved := read_moved(said)) is not None:
        try:
            person = find_person(moved.names)
        except TangyError:
            if moved.names_first:  # it may be an answer in words
                return None
            raise
        return ComesIn(person) if moved.comes else GoesAway(person)
    return None


def _claim(said: str, find_person: Callable[[str], str], rules: GameRules) -> GameCommand | None:
    """Parse a claim: the activity's word for it, with a card's number, a name, or both."""
    word, _, rest = said.partition(" ")
    if not rules.claim:
        return None
    if word.casefold() not in (CHECK, rules.claim.casefold()):
        return _claim_of(said, find_person, rules.claim)
    number, _, person = rest.partition(" ")
    digits = number.strip("#,:")
    if rest and not digits.isdecimal():
        with suppress(TangyError):
            return ClaimCard(0, find_person(re.sub(r"^(?:for|by|of|from) ", "", rest)))
    if not (digits.isascii() and digits.isdecimal() and len(digits) <= 6):
        wrong = f"'{rest[:60]}'" if rest else f"'{word}' alone"
        raise TangyError(plain(f"{wrong} is no number of a card. Say it as in: {word} 17."))
    return ClaimCard(int(digits), find_person(person) if person.strip() else "")


def _claim_of(said: str, find_person: Callable[[str], str], word: str) -> ClaimCard | None:
    """Parse a sentence such as "Rosa has bingo"; None if nobody has the name."""
    found = _CLAIMS.fullmatch(said)
    if found is None or found[2].casefold() != word.casefold():
        return None
    with suppress(TangyError):
        return ClaimCard(0, find_person(found[1]))
    return None
