"""Words for what games were played for, who won, and from when to when people took part."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import TYPE_CHECKING

from tangy_tui.monitoring.played_for import wins_of
from tangy_tui.text.changes import pattern_words
from tangy_tui.text.numbers import listed

if TYPE_CHECKING:
    from tangy_tui.monitoring.played_for import PlayedFor, Win
    from tangy_tui.monitoring.presence import Stay
    from tangy_tui.monitoring.replay import GameReplay
    from tangy_tui.monitoring.session import Session
    from tangy_tui.text.situations import Name

PLAYED_FOR = "Played for"
WON, NOBODY_WON, NOT_REACHED = "Who won", "nobody won", "not reached"
NOBODY_YET, YET = "nobody has won yet", " yet"
"""Of a game that is still going on, or was broken off."""
MOST_GAMES = 24
"""Of more games a report does not tell one by one what they were played for."""


def played_for_rows(session: Session) -> list[tuple[str, str]]:
    """Tell what each game was played for and who won, as heading and words."""
    if len(session.replays) > MOST_GAMES:
        return []
    rows = []
    for replay, found in zip(session.replays, session.played_for, strict=True):
        if found:
            words = "; then ".join(_pattern_words(replay, one, session.name) for one in found)
            game = f", game {replay.game.number}" if len(session.replays) > 1 else ""
            rows.append((f"{PLAYED_FOR if found[0].pattern else WON}{game}", words))
    return rows


def _pattern_words(replay: GameReplay, one: PlayedFor, name: Name) -> str:
    yet = "" if replay.game.ended else YET
    who = wins_words(replay, one.wins, name) if one.wins else NOBODY_YET if yet else NOBODY_WON
    who = who if one.reached else f"{NOT_REACHED}{yet}"
    return f"{pattern_words(replay.activity, (one.pattern,))}: {who}" if one.pattern else who


def wins_words(replay: GameReplay, wins: Sequence[Win], name: Name) -> str:
    """Tell who won with which card, and at which call: once if it is the same for all."""
    ways = dict.fromkeys(
        (name(win.person), _card_words(win), _call_words(replay, win)) for win in wins
    )
    if len(ways) == 1:
        ((who, card, call),) = ways
        return f"{who} won{card}{call}"
    calls = {call for _, _, call in ways}
    same = calls.pop() if len(calls) == 1 else ""
    return f"{listed(who + card + ('' if same else call) for who, card, call in ways)} won{same}"


def with_card_words(replay: GameReplay, win: Win) -> str:
    """Tell with which card somebody won, and at which call."""
    return f"{_card_words(win)}{_call_words(replay, win)}"


def _card_words(win: Win) -> str:
    return f" with card {win.card}" if win.card else ""


def _call_words(replay: GameReplay, win: Win) -> str:
    """Tell at which call somebody won, with its number: " at call 23 (O-70)"."""
    if not win.call:
        return ""
    label = f" ({replay.activity.deck.label(win.number)})" if replay.activity else ""
    return f" at call {win.call}{label}"


def won_words(replay: GameReplay, person: str) -> str:
    """Tell with which card, for what, and at which call a person won; "" if they did not."""
    told = []
    for pattern, win in wins_of(replay, person):
        what = pattern_words(replay.activity, (pattern,)) if pattern else ""
        parts = (f"card {win.card}" if win.card else "", what, f"call {win.call}")
        told.append(", ".join(part for part in parts[: 3 if win.call else 2] if part) or "yes")
    return "; ".join(told)


def stay_words(stays: Sequence[Stay]) -> str:
    """Tell from when to when a person took part; "" if they did all the time."""
    if any(one.whole for one in stays):
        return ""
    return listed([_one_stay(one) for one in stays])


def _one_stay(one: Stay) -> str:
    if one.since is None or one.until is None:
        return f"from {_time(one.since)}" if one.since else f"until {_time(one.until)}"
    since, until = _time(one.since), _time(one.until)
    return f"at {since}" if since == until else f"{since} to {until}"


def _time(at: datetime | None) -> str:
    return f"{at.astimezone():%H:%M}" if at else ""


def with_stay(session: Session, person: str) -> str:
    """Name a person, with the time in which they took part if not all the time."""
    words = stay_words(session.stays.get(person, ()))
    return f"{session.name(person)} ({words})" if words else session.name(person)


def took_part(session: Session) -> str:
    """Name those who took part, with their times; "" if the log names nobody."""
    return ", ".join(with_stay(session, person.id) for person in session.people)
