"""Reports of staff or speech about players during a game, and whether they count."""

from __future__ import annotations

from typing import Literal, NamedTuple

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.judging import VERDICT, judged
from tangy_profiles.declared.open_questions import counts_now
from tangy_profiles.declared.typed_observations import TypedObservation, meant, waits_for

STAFF, SPEECH = "staff", "speech"
Judgement = Literal["", "right", "wrong"]


class PlayerReport(NamedTuple):
    """What words state about whom, and whether it counts now.

    `judgement` is that of an answer, "" if there is none; `by_staff`: they gave it, not an answer.
    """

    meant: TypedObservation
    counts: bool
    judgement: Judgement
    by_staff: bool
    whose: bool = False
    """Whether the fact is a player's, and it is not clear of whom."""


def read_report(
    game: DeclaredGame, who: str | None, said: str, certainty: float, source: str = STAFF
) -> PlayerReport | None:
    """Parse a report about a player (None: nobody is named); None if it states no fact.

    `certainty` is the probability that it is right, `source` its origin.
    """
    found = meant(game, waits_for(game) if who is None and source == SPEECH else who, said)
    if found is None:
        return None
    declaration = game.declaration
    fact = declaration.facts[found.fact]
    if fact.per_player and found.who is None:
        return PlayerReport(found, counts=False, judgement="", by_staff=False, whose=True)
    if not fact.checks:
        return PlayerReport(found, counts=True, judgement="", by_staff=False)
    if not counts_now(game, fact, found.who):
        return PlayerReport(found, counts=False, judgement="", by_staff=False)
    value = judged(fact, declaration.items, game.row, found.raw, certainty)
    judgement: Judgement = "" if value is None else "right" if value == fact.values[1] else "wrong"
    return PlayerReport(found, True, judgement, found.raw.startswith(VERDICT))
