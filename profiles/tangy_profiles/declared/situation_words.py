"""Situations of a declared activity in words: those of its file, or made from its names.

They are beside the reader of the file, and not in `tangy_tui/text`, because every `Activity` has to
name its situations (`in_words`) for layers below the text: questions, coverage, conflicts.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_profiles.declared.model import Declaration, Fact, Stage
from tangy_profiles.declared.situations import seen_facts
from tangy_profiles.declared.vocabulary import (
    ADDRESSED,
    ASKING,
    ITEMS,
    NO,
    PLACE,
    TURN,
    YES,
    Selector,
)
from tangy_profiles.state import Situation

if TYPE_CHECKING:
    from tangy_profiles.declared.game import DeclaredGame

NAME = "{name}"

A_PERSON = "a person"
ANYONE: dict[Selector, str] = {
    "group": "everybody",
    "first asking": A_PERSON,
    "whose turn": "the player",
    "next in circle": "the next person",
    "quietest": "the quietest person",
    "last to act": A_PERSON,
    "addressed": "the person",
    "beside": "the person",
}
"""The person of a stage without a name."""

BUILT_IN_WORDS: dict[tuple[str, str], str] = {
    (ITEMS, "left"): "some are left",
    (ITEMS, "over"): "none are left",
    (ASKING, NO): "no request",
    (ASKING, YES): "asks for help",
    (TURN, NO): "not in turn",
    (TURN, YES): "in turn",
    (ADDRESSED, NO): "not spoken to last",
    (ADDRESSED, YES): "spoken to last",
    (PLACE, "front"): "at the front",
    (PLACE, "beside"): "beside them",
    (PLACE, "elsewhere"): "with others",
}


def situation_words(declaration: Declaration, situation: Situation, who: str = "") -> str:
    """Describe a situation: the stage, then the facts that it sees.

    Args:
        declaration: the activity.
        situation: one of its situations.
        who: the person of the stage; "" for anyone.
    """
    facts = seen_words(declaration, situation)
    words = stage_words(declaration, situation.stage, who)
    return f"{words} · {facts}" if facts else words


def seen_words(declaration: Declaration, situation: Situation) -> str:
    """Describe the facts that a stage sees ("": none)."""
    facts = declaration.facts
    seen = seen_facts(situation).items()
    return ", ".join(
        value_words(facts[name], value) if name in facts else f"{name} is {value}"
        for name, value in seen
    )


def stage_words(declaration: Declaration, name: str, who: str = "") -> str:
    """Describe a stage; an unknown stage keeps its name."""
    stage = next((one for one in declaration.stages if one.name == name), None)
    if stage is None:
        return name
    anyone = ANYONE.get(stage.about, A_PERSON)
    if declaration.teams:
        anyone = anyone.replace("person", "team").replace("player", "team")
    return (stage.words or _by_name(stage)).replace(NAME, who or anyone)


def value_words(fact: Fact, value: str) -> str:
    """Describe a value of a fact."""
    if fact.words and value in fact.values:
        return fact.words[fact.values.index(value)]
    if (fact.name, value) in BUILT_IN_WORDS:
        return BUILT_IN_WORDS[fact.name, value]
    name = plain_name(fact.name)
    match fact.kind:
        case "flag" | "test" if value in (NO, YES):
            return name if value == YES else f"not {name}"
        case "timer":
            return f"for {_range(value, ' s')}"
        case "count":
            return f"{name}: {_range(value)}"
        case _:
            return f"{name} is {value}"


def words_now(game: DeclaredGame, fact: str, player: str | None) -> str:
    """Describe the present value of a fact, of a player or the group."""
    return value_words(game.declaration.facts[fact], game.value(fact, player))


def plain_name(name: str) -> str:
    """Format the name of a stage or fact as words."""
    return " ".join(name.replace("_", " ").replace("-", " ").split()) or name


def _by_name(stage: Stage) -> str:
    """Describe a stage without words by its name and conditions."""
    conditions = [
        f"{one.quantifier} {plain_name(one.fact)} {one.comparison} {one.value}".strip()
        for one in stage.when
    ]
    name = plain_name(stage.name)
    return f"{name} ({' and '.join(conditions)})" if conditions else name


def _range(band: str, unit: str = "") -> str:
    """Format a band of numbers, with their unit (s, or none)."""
    if band.startswith("<"):
        return f"under {band[1:]}{unit}"
    if band.startswith(">="):
        return f"{band[2:]}{unit} or more"
    low, _, high = band.partition("-")
    return f"{low} to {high}{unit}" if high else f"{low}{unit}"
