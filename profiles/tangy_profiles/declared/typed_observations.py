"""Observations that staff type or say during a game: a fact, its player and its value.

They use the words of the activity's file: an answer ("B", "honey"), whether an answer was right
("right", "guess wrong"), a value ("match"), a fact ("tired", "not tired"), or a fact with its value
("mood sad").
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from tangy_profiles.declared.acts import Act, take_in
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.judging import judged, plain_words, right_answers, verdict
from tangy_profiles.declared.model import Fact
from tangy_profiles.declared.vocabulary import ASKING, NO, YES

ASKS = ("asks", "asks for help", "asking", "help")
NEGATIONS = ("not", "no", "does not", "is not", "no longer")
BETWEEN = ("is", "has", "gives")
"""Words before a fact or a value without a meaning."""


class TypedObservation(NamedTuple):
    """A typed observation: the fact, its player (None: the group), and its value."""

    fact: str
    who: str | None
    raw: str


def can_be_told(game: DeclaredGame) -> tuple[Fact, ...]:
    """Return the facts that people can change, in the order of the file."""
    return tuple(one for one in game.declaration.facts.values() if one.sources)


def meant(game: DeclaredGame, who: str | None, words: str) -> TypedObservation | None:
    """Parse words about a player, or about the group (None).

    An option or the right answer of the current item has priority over a value, a value over a
    fact, and all of them over another free answer, which may be any words.

    Args:
        game: the game, with its current item.
        who: the player concerned, None if nobody is named.
        words: the typed or recognised words.

    Returns:
        The observation; None if the words mention no fact. It has no player if the fact is a
        player's, nobody is named, and it is not clear who is meant.
    """
    said = plain_words(words)
    if not said:
        return None
    if said in ASKS and who is not None:
        return TypedObservation(ASKING, who, YES)
    facts = can_be_told(game)
    for fact, raw in (*_answers(game, facts, words), *_values(facts, said)):
        whose = who if fact.per_player else None
        if fact.per_player and whose is None:
            whose = about(game)
        return TypedObservation(fact.name, whose, raw)
    return None


def sayable(game: DeclaredGame) -> list[str]:
    """Return words that can be observed now: the options, and values or names of facts.

    The options, and "right" and "wrong", are there while their question is open.
    """
    found = open_options(game)
    for fact in can_be_told(game):
        if fact.checks and is_open(game, fact):
            found += fact.values[1:]
    for fact in can_be_told(game):
        if fact.checks:
            continue
        if fact.kind == "choice":
            found += fact.values[1:]
        else:
            found.append(fact.name)
    return found


def open_options(game: DeclaredGame) -> list[str]:
    """Return the options of the questions that are open, in the words of the items."""
    asked = [fact for fact in can_be_told(game) if fact.checks and is_open(game, fact)]
    items = game.declaration.items
    return [one for fact in asked for c in fact.options if (one := items.value(game.row, c))]


def is_open(game: DeclaredGame, fact: Fact) -> bool:
    """Return whether a question is open: an answer would change the situation of the game."""
    seen = game.seen()
    for who in game.here if fact.per_player else (None,):
        for value in fact.values[1:]:
            answered = game.copy()
            if take_in(answered, Act(fact.name, who, value)) and answered.seen() != seen:
                return True
    return False


def about(game: DeclaredGame) -> str | None:
    """Return the person meant by words without a name; None if anybody could be meant.

    It is the person whose turn it is, or to whom Tangy has spoken and now listens.
    """
    stage, person = game.stage()
    if stage.about in ("whose turn", "addressed") and person is not None:
        return person
    if game.declaration.takes_turns:
        return game.players[game.turn]
    return game.here[0] if len(game.here) == 1 else None


def waits_for(game: DeclaredGame) -> str:
    """Return the person to whom a spoken answer belongs: that of the stage, or whose turn it is."""
    person = game.stage()[1]
    return person if person is not None else game.players[game.turn]


def _answers(game: DeclaredGame, facts: tuple[Fact, ...], words: str) -> Iterator[tuple[Fact, str]]:
    items, said = game.declaration.items, plain_words(words)
    for fact in facts:
        free = fact.checks and not fact.options
        # "false" may be the answer to the item, and then is no verdict on it
        right = free and said in right_answers(fact, items, game.row)
        if right or (fact.options and judged(fact, items, game.row, words, 1.0) is not None):
            yield fact, words


def _values(facts: tuple[Fact, ...], said: str) -> Iterator[tuple[Fact, str]]:
    for fact in facts:
        if (value := _value_of(fact, said)) is not None:
            yield fact, value
    for fact in facts:
        if fact.checks and not fact.options:
            name = plain_words(fact.name)
            yield fact, said.removeprefix(f"{name} ")


def _value_of(fact: Fact, said: str) -> str | None:
    """Return the value of a fact that words name, with or without the fact's name."""
    words, negated = said.split(), False
    while words and words[0] in (*BETWEEN, *NEGATIONS):
        negated |= words.pop(0) in NEGATIONS
    name = plain_words(fact.name).split()
    values = {plain_words(value): value for value in fact.values}
    if words[: len(name)] == name:
        rest = " ".join(one for one in words[len(name) :] if one not in BETWEEN)
        if fact.kind == "count" and not rest:
            return YES
        if fact.kind == "flag":
            given = YES if rest in ("", YES) else NO if rest in NEGATIONS else None
            return given if not negated or given is None else NO
        if fact.checks:
            plain = [one for one in rest.split() if one not in NEGATIONS]
            negated |= len(plain) < len(rest.split())
            return verdict(fact, " ".join(plain), negated=negated)
        return values.get(rest)
    if fact.checks:
        return verdict(fact, said) or verdict(fact, " ".join(words), negated=negated)
    usable = fact.kind == "choice" and not negated
    return values.get(" ".join(words)) if usable else None
