"""The grammar of commands that change a game: pace, patterns, a call, a claim, who is present."""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import suppress

from tangy_profiles.errors import TangyError
from tangy_profiles.game_rules import LONGEST_PACE, SHORTEST_PACE, GameRules
from tangy_tui.app.claim_grammar import one_claim_each, read_claim
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
_TAKE_BACK = re.compile(r"take back (\S{1,8})", re.I)


def lines_of(said: str, read: Callable[[str], object]) -> list[str]:
    """Return the lines to carry out: one for each person or claim if a line names several.

    Args:
        said: the line.
        read: reads a line as a command.

    Raises:
        TangyError: the line cannot be read, or it names a person who is not known.
    """
    claims = one_claim_each(said)
    if len(claims) > 1 and all(isinstance(_read(read, line), ClaimCard) for line in claims):
        return claims
    try:
        if read(said) is not None:
            return [said]
    except TangyError:
        each = one_person_each(said)
        if len(each) == 1:
            raise
    else:
        each = one_person_each(said)
        if len(each) == 1 or all(_read(read, line) is None for line in each):
            return [said]
    for line in each:
        read(line)
    return each


def _read(read: Callable[[str], object], line: str) -> object:
    """Return a line as a command; None if it cannot be read as one."""
    with suppress(TangyError):
        return read(line)
    return None


def read_planned(
    said: str, find_person: Callable[[str], str], rules: GameRules
) -> GameCommand | None:
    """Parse words as one of these commands; None if they are none.

    Raises:
        TangyError: they resemble a command, but a part of it is wrong; one sentence.
    """
    if claim := read_claim(said, find_person, rules):
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
