"""Tells the bench's people what the host would announce: the pattern, winners, who left.

People in a real room know this without the robot.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from tangy_profiles.cards import PATTERNS
from tangy_profiles.codec import decode
from tangy_profiles.declared.memory import GameMemory
from tangy_sim.device_simulator.declared_people import DeclaredPeople
from tangy_sim.device_simulator.people import People


def tell(people: People, told: Mapping[str, Any]) -> dict[str, Any]:
    """Tell people the current rules.

    Args:
        people: the group.
        told: optional keys: `patterns` and `together` of what wins; `done`, the person whose sign
            comes down; `away`, the absent people; `taken_back`, a number that counts as not called;
            `memory`, an interrupted game by facts to go on with; `called`, the calls of one with
            cards, with everybody's card in `cards` and who asks already in `asking`; `rows`, the
            rows of the items whose picture or sound comes with the next sentence.

    Raises:
        KeyError: an unknown person or pattern.
        InvalidValue: the interrupted game is invalid.
    """
    if "memory" in told and isinstance(people, DeclaredPeople):
        people.remember(decode(GameMemory, told["memory"]))
    if "rows" in told and isinstance(people, DeclaredPeople):
        people.perceived = tuple(map(int, told["rows"]))
    if "patterns" in told:
        _play_for(people, tuple(map(str, told["patterns"])), int(told["together"]))
    if "called" in told and not isinstance(people, DeclaredPeople):
        cards = {str(person): int(card) for person, card in told["cards"].items()}
        people.resume(cards, [int(number) for number in told["called"]])
        for person in told.get("asking", ()):
            people.ask(str(person))
    if "done" in told:
        people.sitters[str(told["done"])].asks_since = None
    if "away" in told:
        people.away = {people.sitters[str(person)].id for person in told["away"]}
        for person in people.away:
            people.sitters[person].asks_since = None
        if isinstance(people, DeclaredPeople):
            people.notice_away()
    if "taken_back" in told:
        _take_back(people, int(told["taken_back"]))
    return {}


def _play_for(people: People, patterns: tuple[str, ...], together: int) -> None:
    if unknown := set(patterns) - set(PATTERNS):
        raise KeyError(*unknown)
    deck = replace(people.activity.deck, patterns=patterns, together=together)
    people.activity = replace(people.activity, deck=deck)
    for sitter in people.sitters.values():
        sitter.player.deck = deck


def _take_back(people: People, number: int) -> None:
    if number in people.game.called:
        people.game.called.remove(number)
    for sitter in people.sitters.values():
        sitter.player.uncall(number)
