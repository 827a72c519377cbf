"""Check of a declared activity by a search of its games: unreachable parts, endless games."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from time import thread_time
from typing import Literal

from tangy_profiles.declared.activity import DeclaredActivity
from tangy_profiles.declared.demonstrated_moves import UNDECIDED, DemonstratedMoves, Move
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.progress import progress
from tangy_profiles.declared.search import Cut, Limit, SearchResult, explore
from tangy_profiles.declared.search_way import Counterexample
from tangy_profiles.declared.speech import empty_slots
from tangy_profiles.declared.state_keys import StateFactor
from tangy_profiles.state import EVERYBODY

Flaw = Literal[
    "stage never reached",
    "situation never reached",
    "fact never changes",
    "fact never cleared",
    "fact never looked at",
    "behaviour never possible",
    "text lacks a word",
    "never ends",
    "nothing possible",
    "repeated in vain",
]
PLAYERS = ("one", "other")
LIMIT = Limit(states=12_000, seconds=10.0)
"""Limit of each search, and of the CPU time (s) of all together."""
SHARE = 0.6
"""The share of the remaining time for a search if another one follows."""


@dataclass(frozen=True, slots=True)
class DeadEnd:
    """A dead end in games of a number of players, and the path to it."""

    players: int
    as_expected: bool
    counterexample: Counterexample


@dataclass(frozen=True, slots=True)
class ActivityFlaw:
    """A flaw of an activity: the name concerned, and perhaps its text."""

    flaw: Flaw
    name: str
    text: str = ""
    dead_end: DeadEnd | None = None
    endless: bool = False
    """No game ends: none that goes as expected, or none at all."""


@dataclass(frozen=True, slots=True)
class SearchedGames:
    """How far games of a number of players were searched.

    `as_expected` are games with the expected behaviours, others have every possible one. `cut` says
    why the search ended early, and `shares` which facts contribute most states.
    """

    players: int
    states: int
    cut: Cut
    as_expected: bool = False
    shares: tuple[StateFactor, ...] = ()


@dataclass(frozen=True, slots=True)
class Findings:
    """The flaws of an activity, worst first, and how far its games were searched.

    `not_met` are stages, situations and behaviours that an incomplete search did not reach.
    """

    flaws: tuple[ActivityFlaw, ...]
    searches: tuple[SearchedGames, ...]
    not_met: tuple[ActivityFlaw, ...] = ()


def findings(activity: DeclaredActivity, limit: Limit = LIMIT) -> Findings:
    """Search the games of an activity, and return its flaws.

    Args:
        activity: the activity.
        limit: the states of each search, and the CPU time of all of them in s.
    """
    until = thread_time() + limit.seconds
    slots: dict[tuple[str, str], bool] = {}
    in_vain: list[ActivityFlaw] = []
    players = (activity.teams or PLAYERS)[:2]
    sizes = [players] if activity.teams else [players[:1], players]
    found: list[tuple[SearchedGames, SearchResult]] = []

    def note(group: Sequence[str], one: SearchResult, *, as_expected: bool = False) -> None:
        searched = SearchedGames(len(group), one.states, one.cut, as_expected, one.shares)
        found.append((searched, one))

    for group in sizes:
        left = Limit(limit.states, SHARE * (until - thread_time()))
        note(group, _tried(activity, group, slots, left))
    tried = [one for _, one in found]
    if activity.expected:
        left = Limit(limit.states, until - thread_time())
        slots, in_vain, one = _played_as_expected(activity, players, left)
        note(players, one, as_expected=True)
    dead = list(_dead_ends(activity, found))
    endless = any(_is_endless(one.dead_end) for one in dead)
    flaws = [replace(one, endless=endless) for one in dead[:1]]
    flaws += islice(_idle(activity, found), 1)
    flaws += () if flaws else in_vain  # a dead end explains it
    missing = tuple(_missing(activity, tried))
    whole = all(one.whole for one in tried)
    played = {name for one in tried for name in one.played}
    flaws += missing if whole else ()
    flaws += [
        ActivityFlaw("text lacks a word", behaviour, text)
        for (behaviour, text), lacks in slots.items()
        if lacks and behaviour in played
    ]
    flaws += _unused_facts(activity)
    return Findings(tuple(flaws), tuple(one for one, _ in found), () if whole else missing)


def _is_endless(end: DeadEnd | None) -> bool:
    return end is not None and (end.as_expected or not end.counterexample.way)


def _dead_ends(
    activity: DeclaredActivity, found: Sequence[tuple[SearchedGames, SearchResult]]
) -> Iterator[ActivityFlaw]:
    """Yield a flaw for each search with a dead end.

    If every behaviour is possible, it is the state in which the end becomes unreachable, because a
    condition is wrong there. In expected games it is the loop in which they stay, because an
    expectation is wrong there.
    """
    for games, one in found:
        if one.lost is None or one.loop is None:
            continue
        counterexample = one.loop if games.as_expected or not one.lost.way else one.lost
        end = DeadEnd(games.players, games.as_expected, counterexample)
        yield ActivityFlaw("never ends", activity.in_names(counterexample.situation), dead_end=end)


def _idle(
    activity: DeclaredActivity, found: Sequence[tuple[SearchedGames, SearchResult]]
) -> Iterator[ActivityFlaw]:
    """Yield a flaw for each search with a state in which no behaviour is possible."""
    for games, one in found:
        if one.idle is not None and not games.as_expected:
            end = DeadEnd(games.players, games.as_expected, one.idle)
            name = activity.in_names(one.idle.situation)
            yield ActivityFlaw("nothing possible", name, dead_end=end)


def _missing(activity: DeclaredActivity, found: Sequence[SearchResult]) -> Iterator[ActivityFlaw]:
    """Yield the stages, situations and behaviours that no search reached."""
    reached = {situation for one in found for situation in one.reached}
    stages = {situation.stage for situation in reached}
    for stage in activity.stages:
        if stage not in stages:
            yield ActivityFlaw("stage never reached", stage)
    for situation in activity.situations:
        if situation.stage in stages and situation not in reached:
            yield ActivityFlaw("situation never reached", activity.in_names(situation))
    for name in activity.behaviours:
        if not any(name in one.played for one in found):
            yield ActivityFlaw("behaviour never possible", name)


def _tried(
    activity: DeclaredActivity,
    players: Sequence[str],
    slots: dict[tuple[str, str], bool],
    limit: Limit,
) -> SearchResult:
    """Search with every behaviour, and record texts that always have an empty slot."""
    declaration = activity.declaration
    rounds = min(declaration.items.rounds, max(1, declaration.most_counted))
    situations = DemonstratedMoves(activity.behaviours)

    def moves(game: DeclaredGame) -> list[Move]:
        able: list[Move] = []
        for name, one in declaration.behaviours.items():
            people = [game.whom(selector) for selector in one.to]
            for whom in dict.fromkeys(people) if one.to else (None,):
                nobody = whom is None and one.to and "group" not in one.to
                if game.allows(name, whom) and not nobody:
                    able.append((name, whom))
                    _note_slots(game, name, whom, slots, any_time=False)
        return able

    game = DeclaredGame(declaration, players, range(rounds))
    return explore(game, moves, situations.situation, limit)


def _played_as_expected(
    activity: DeclaredActivity, players: Sequence[str], limit: Limit
) -> tuple[dict[tuple[str, str], bool], list[ActivityFlaw], SearchResult]:
    """Search games with the expected behaviours.

    Also return the texts with slots that can be empty, and a flaw for each behaviour that changes
    nothing, not even by the time that it takes: until people act, it is repeated.
    """
    slots: dict[tuple[str, str], bool] = {}
    in_vain: dict[str, ActivityFlaw] = {}
    declaration = activity.declaration
    shown = expected_moves(activity)

    def moves(game: DeclaredGame) -> list[Move]:
        move = shown.move(game)
        if move is None or move[0] == UNDECIDED:
            return []
        name, whom = move
        _note_slots(game, name, whom, slots, any_time=True)
        if name not in in_vain and not declaration.behaviours[name].invites:
            after = game.copy()
            after.execute(name, whom)
            if not after.differs(game) and progress(game, after) == "none":
                situation = activity.in_names(shown.situation(game))
                in_vain[name] = ActivityFlaw("repeated in vain", name, situation)
        return [move]

    rounds = min(2, declaration.items.rounds) or 1
    game = DeclaredGame(declaration, players, range(rounds))
    searched = explore(game, moves, shown.situation, limit)
    return slots, list(in_vain.values()), searched


def expected_moves(activity: DeclaredActivity) -> DemonstratedMoves:
    """Return the expected behaviours of an activity as if they had been demonstrated."""
    shown = DemonstratedMoves(activity.behaviours)
    for situation, behaviour in activity.expected.items():
        shown.shown[situation] = behaviour
        to = activity.behaviours[behaviour].to
        selector = activity.expected_selector(situation) or (to[0] if to else None)
        if selector is not None:
            named = EVERYBODY if selector == "group" else selector
            shown.whom[situation.stage, behaviour] = (named,)
    return shown


def _note_slots(
    game: DeclaredGame,
    name: str,
    whom: str | None,
    slots: dict[tuple[str, str], bool],
    *,
    any_time: bool,
) -> None:
    """Record which texts of a behaviour have an empty slot: at any time, or always so far."""
    declared = game.declaration.behaviours[name]
    texts = [text for found in declared.says.values() for text in found] + [declared.image]
    wanted = [text for text in texts if "{" in text]
    if not wanted or all(slots.get((name, text)) is any_time for text in wanted):
        return  # no slots, or nothing can change
    after = game.copy()
    after.execute(name, whom)
    for text in wanted:
        lacks = bool(empty_slots(after, text, whom))
        before = slots.get((name, text), not any_time)
        slots[name, text] = (lacks or before) if any_time else (lacks and before)


def _unused_facts(activity: DeclaredActivity) -> Iterator[ActivityFlaw]:
    declaration = activity.declaration
    effects = [effect for one in declaration.behaviours.values() for effect in one.effects]
    changed = {
        effect.fact for effect in effects if effect.does in ("set", "add", "start", "invite")
    }
    cleared = {effect.fact for effect in effects if effect.does in ("set", "clear", "start")}
    brought = {habit.fact for habit in declaration.habits}
    final = {habit.fact for habit in declaration.habits if habit.last}
    looked = {fact.name for fact, _ in declaration.looked_at}
    spoken = {
        slot
        for one in declaration.behaviours.values()
        for text in (*(text for texts in one.says.values() for text in texts), one.image)
        for slot in looked ^ set(declaration.facts)
        if f"{{{slot}}}" in text or f"{{{slot} of each}}" in text
    }
    for fact in declaration.facts.values():
        if fact.built_in or fact.kind == "test":
            continue
        if fact.name not in changed | brought and not fact.sources:
            yield ActivityFlaw("fact never changes", fact.name)
        elif fact.name not in looked | spoken:
            yield ActivityFlaw("fact never looked at", fact.name)
        elif fact.kind != "count" and fact.name in brought - cleared - final:
            values = {
                value for h in declaration.habits if h.fact == fact.name for value, _ in h.weights
            }
            if fact.values[0] not in values:
                yield ActivityFlaw("fact never cleared", fact.name)
