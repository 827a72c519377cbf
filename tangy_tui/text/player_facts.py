"""Words for each person's answers and counts, in reports on declared activities."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from tangy_profiles.declared.situation_words import value_words
from tangy_tui.monitoring.player_facts import PlayerFacts
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.text.numbers import listed, often
from tangy_tui.text.situations import Name
from tangy_tui.text.times import time_of_day

HEADING = "Answers and scores"
PERSON, WHEN, ITEM = "person", "when", "what it was about"
UNCLEAR = "no clear answer"


def in_game_words(replays: Mapping[str, GameReplay], facts: PlayerFacts) -> str:
    """Name the game after the heading, if a session has several: ", game 2, Trivia"."""
    replay = replays[facts.game]
    return f", {game_heading(replay)}" if len(replays) > 1 else ""


def game_heading(replay: GameReplay) -> str:
    """Name a game of a session: "game 2, Trivia"."""
    return f"game {replay.game.number}, {replay.title}"


def player_columns(facts: PlayerFacts) -> tuple[str, ...]:
    """Return the columns of the table of people."""
    unclear = (UNCLEAR,) if facts.unclear else ()
    return (PERSON, *facts.counts, *(fact.name for fact in facts.facts), *unclear)


def player_rows(facts: PlayerFacts, name: Name) -> list[tuple[str, ...]]:
    """Return a row for each person: counts, answers, and the number of unclear ones."""
    return [
        (
            name(person),
            *(str(numbers[person]) for numbers in facts.counts.values()),
            *(_values(facts, person, at) for at in range(len(facts.facts))),
            *((str(facts.unclear.get(person, "")),) if facts.unclear else ()),
        )
        for person in facts.people
    ]


def act_columns(facts: PlayerFacts) -> tuple[str, ...]:
    """Return the columns of the table of answers."""
    item = (ITEM,) if any(act.item for act in facts.acts) else ()
    return (WHEN, *item, PERSON, listed([fact.name for fact in facts.facts]))


def act_rows(facts: PlayerFacts, name: Name) -> list[tuple[str, ...]]:
    """Return a row for each answer, in order."""
    words = {fact.name: fact for fact in facts.facts}
    items = any(act.item for act in facts.acts)
    return [
        (
            time_of_day(act.at),
            *((f"{act.round}. {act.item}" if act.item else "",) if items else ()),
            name(act.person),
            value_words(words[act.fact], act.value),
        )
        for act in facts.acts
    ]


def player_lines(facts: PlayerFacts, name: Name) -> Iterator[str]:
    """Format each person's counts and answers in a line."""
    for person in facts.people:
        told = [f"{fact} {numbers[person]}" for fact, numbers in facts.counts.items()]
        told += [
            f"{fact.name}: {values}"
            for at, fact in enumerate(facts.facts)
            if (values := _values(facts, person, at))
        ]
        if unclear := facts.unclear.get(person):
            told.append(f"{UNCLEAR}: {often(unclear)}")
        if told:
            yield f"  {name(person)}: {'; '.join(told)}"


def look_after_lines(games: Iterable[PlayerFacts], name: Name) -> list[str]:
    """Tell of whom a fact was true that staff should look after, and when."""
    when = dict[tuple[str, str], list[str]]()
    for facts in games:
        declared = {fact.name: fact for fact in facts.facts}
        for act in facts.acts:
            fact = declared[act.fact]
            if act.value in fact.attention:
                told = name(act.person), value_words(fact, act.value)
                when.setdefault(told, []).append(time_of_day(act.at))
    return [f"{who}: {what} ({listed(times)})." for (who, what), times in when.items()]


def _values(facts: PlayerFacts, person: str, at: int) -> str:
    fact = facts.facts[at]
    return ", ".join(
        f"{value_words(fact, value)} ({count})" for value, count in facts.of(person, fact).items()
    )
