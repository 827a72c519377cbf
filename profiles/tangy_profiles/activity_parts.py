"""Parts of an activity's file: strategies, user states, and limits on how often Tangy asks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from tangy_profiles.cards import CHECKERS, CardState
from tangy_profiles.defaults import PRESSING_STRATEGIES
from tangy_profiles.reading import Table

VISIT, GAME = "asks_in_visit", "asks_in_game"
"""The keys of these limits in an activity's file."""


@dataclass(frozen=True)
class AskingLimits:
    """The number of refused requests after which a person is asked no more.

    `visit` counts those in a row, `game` all of a game. `named`: the activity's file has both.
    """

    visit: int = 3
    game: int = 6
    named: bool = False


def read_asking_limits(top: Table) -> AskingLimits:
    """Read the limits of an activity; missing ones get the defaults.

    Raises:
        ProfileError: a number is out of range, or the limit per visit exceeds that per game.
    """
    usual = AskingLimits()
    named = VISIT in top and GAME in top
    visit = top.whole(VISIT, 1, 10, usual.visit)
    game = top.whole(GAME, 1, 50, max(usual.game, visit))
    if game < visit:
        raise top.wrong(GAME, f"must not be below {VISIT}.")
    return AskingLimits(visit, game, named)


def read_strategies(table: Table) -> dict[str, str]:
    """Read the persuasive strategies with their descriptions.

    Raises:
        ProfileError: there is none.
    """
    strategies = {key: table.text(key) for key in table}
    if not strategies:
        raise table.wrong("", "must name at least one persuasive strategy.")
    return strategies


def read_pressing(top: Table, strategies: dict[str, str]) -> tuple[str, ...]:
    """Read which strategies press people; the default is the usual ones.

    Raises:
        ProfileError: a strategy is unknown, or none is left for people who refuse.
    """
    usual = tuple(name for name in PRESSING_STRATEGIES if name in strategies)
    usual = usual if len(usual) < len(strategies) else ()
    pressing = top.words("pressing_strategies", strategies, usual)
    if set(pressing) == set(strategies):
        raise top.wrong("pressing_strategies", "must leave a strategy for people who refuse.")
    return pressing


def read_user_states(top: Table) -> tuple[CardState, ...]:
    """Read the user activity states and the checkers that recognise them on a card.

    Raises:
        ProfileError: a name stands twice, or a necessary checker is missing or stands twice.
    """
    states: list[CardState] = []
    for entry in top.tables("user_states"):
        name = entry.text("name")
        states.append(
            CardState(
                name,
                entry.text("label", name),
                entry.choice("checker", CHECKERS),
                entry.text("hint", ""),
                entry.text("not_yet", ""),
                read_sentence(entry, "now", entry.text("now", "")),
            )
        )
        entry.close()
    checkers = [s.checker for s in states]
    if len({s.name for s in states}) < len(states):
        raise top.wrong("user_states", "two of them have the same name.")
    for needed in ("unread", "otherwise"):
        if checkers.count(needed) != 1:
            raise top.wrong("user_states", f"exactly one must have the checker {needed!r}.")
    return tuple(sorted(states, key=lambda s: s.checker == "otherwise"))


def read_sentence(table: Table, key: str, sentence: str) -> str:
    """Check that {name} is the only slot of a sentence.

    Raises:
        ProfileError: it has another slot.
    """
    if "{" in sentence.replace("{name}", "") or "}" in sentence.replace("{name}", ""):
        raise table.wrong(key, "can have nothing filled in but {name}.")
    return sentence


def read_by_request(entry: Table, key: str) -> Mapping[str, str]:
    """Read words by request: for ANR, and for AR."""
    table = entry.table(key, optional=True)
    words = {request: table.text(request) for request in ("ANR", "AR") if request in table}
    table.close(also=("ANR", "AR"))
    return MappingProxyType(words)
