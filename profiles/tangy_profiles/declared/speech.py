"""Texts for speech and screen in a declared activity, with their slots filled in."""

from __future__ import annotations

import re
from collections.abc import Callable

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.media import file_name
from tangy_profiles.declared.model import Fact, MediaFile
from tangy_profiles.declared.vocabulary import SLOT

PERSON = re.compile(r"\x02([^\x03]*)\x03")
"""A person's id in a filled text, because the worlds do not know names."""
OF_EACH = " of each"
SLOT_AND_END = re.compile(rf"{SLOT.pattern}(?:([.!?])(?![.!?]))?")
"""A slot with the end of the sentence after it, if that is a single character."""
MOST_LINES = 6
"""How many people have a line each on the chest screen; of more, it shows a list."""


def filled(
    game: DeclaredGame, template: str, whom: str | None, turn: str = "", *, shown: bool = False
) -> str:
    """Fill the slots of a text.

    Args:
        game: the game, with its current item.
        template: the text.
        whom: the player who is addressed, None for the group.
        turn: the player whose turn it is in the text ("": whose turn it is now).
        shown: it is for the chest screen, not for speech.

    If a value ends its sentence itself, as the text does after it, one full stop is dropped.

    Returns:
        The text, with people as ids (see `with_names`); "" if a slot is empty.
    """
    empty = False

    def value(match: re.Match[str]) -> str:
        nonlocal empty
        slot, end = match.group(1), match.group(2) or ""
        found = _table(game, slot) if shown else ""
        found = found or _value(game, slot, whom, turn)
        empty = empty or not found
        if end == "." and found.endswith((".", "!", "?")):
            return found
        return (found.removesuffix(".") if end else found) + end

    text = SLOT_AND_END.sub(value, template)
    return "" if empty else text


def words(
    game: DeclaredGame, before: DeclaredGame, behaviour: str, strategy: str, whom: str | None
) -> tuple[str, str]:
    """Return the speech and screen text of a behaviour, by the facts after it.

    Args:
        game: the game after the behaviour.
        before: the game before it.
        behaviour: its name.
        strategy: the persuasive strategy.
        whom: the player addressed, None for the group.
    """
    declared = game.declaration.behaviours[behaviour]
    texts = declared.says.get(strategy) or next(iter(declared.says.values()), ())
    times = before.executed.get(behaviour, 0)
    in_turn = [texts[(times + n) % len(texts)] for n in range(len(texts))]
    spoken = (filled(game, text, whom) for text in in_turn)
    return next((text for text in spoken if text), ""), _image(game, behaviour, whom)


def _image(game: DeclaredGame, behaviour: str, whom: str | None) -> str:
    """Return the screen text after a behaviour: its own, the one that stays, or the title."""
    name, person, turn = game.screen or (behaviour, whom, "")
    declared = game.declaration.behaviours[name]
    if declared.image or declared.picture:
        return filled(game, declared.image, person, turn, shown=True)
    return game.declaration.title


def standing_words(game: DeclaredGame) -> tuple[str, str]:
    """Return the speech and screen text of what stays on the chest screen; "" if nothing does.

    The speech is that of the last time, with the first strategy.
    """
    if game.screen is None:
        return "", ""
    name, whom, _ = game.screen
    before = game.copy()
    before.executed[name] = max(0, before.executed.get(name, 0) - 1)
    return words(game, before, name, "", whom)


def person_on_screen(game: DeclaredGame, whom: str | None) -> str | None:
    """Return the person whom the chest screen names after a behaviour, None for nobody.

    It is the one addressed; while their question stays, and is what the game is about, also if
    Tangy then speaks to everybody.
    """
    if whom is not None or game.screen is None:
        return whom
    asked = game.screen[1]
    return asked if asked == game.stage()[1] else None


def media(game: DeclaredGame, behaviour: str) -> tuple[MediaFile | None, MediaFile | None]:
    """Return the picture on the screen and the sound after a behaviour, by the facts then."""
    declaration = game.declaration
    name = game.screen[0] if game.screen is not None else behaviour
    picture, sound = declaration.behaviours[name].picture, declaration.behaviours[behaviour].sound
    names = (file_name(text, declaration.items, game.row) for text in (picture, sound))
    shown, heard = (declaration.media.get(name) for name in names)
    return shown, heard


def again(game: DeclaredGame, behaviour: str, whom: str) -> list[str]:
    """Return the texts that repeat the question, in order, if a person does not answer."""
    texts = game.declaration.behaviours[behaviour].again
    return [text for one in texts if (text := filled(game, one, whom))]


def empty_slots(game: DeclaredGame, template: str, whom: str | None) -> list[str]:
    """Return the slots of a text that would be empty now."""
    return [slot for slot in SLOT.findall(template) if not _value(game, slot, whom)]


def with_names(text: str, name: Callable[[str], str]) -> str:
    """Replace the ids of people in a filled text by names."""
    return PERSON.sub(lambda match: name(match.group(1)), text)


def _value(game: DeclaredGame, slot: str, whom: str | None, turn: str = "") -> str:
    declaration = game.declaration
    if slot == "name":
        return _person(whom) if whom is not None else ""
    if slot == "turn":
        return _person(turn or game.players[game.turn])
    if slot == "n":
        return str(game.round) if game.round else ""
    if fact := _fact_of_each(game, slot):
        parts = [f"{_person(one)} {game.number(fact, one):.0f}" for one in game.here]
        *others, last = parts
        return f"{', '.join(others)} and {last}" if others else last
    if slot in declaration.items.columns:
        return declaration.items.value(game.row, slot).split("|")[0]
    fact = declaration.facts[slot]
    if fact.kind in ("count", "timer"):
        return f"{game.number(fact, whom):.0f}"
    return game.value(slot, whom)


def _table(game: DeclaredGame, slot: str) -> str:
    """Return the counts of each player for the chest screen, "" for other slots.

    A name and its number stay in one line; two spaces begin a line.
    """
    if not (fact := _fact_of_each(game, slot)):
        return ""
    parts = [f"{_person(one)}:\u00a0{game.number(fact, one):.0f}" for one in game.here]
    return ("  " if len(parts) <= MOST_LINES else ", ").join(parts)


def _fact_of_each(game: DeclaredGame, slot: str) -> Fact | None:
    facts = game.declaration.facts
    return facts.get(slot.removesuffix(OF_EACH)) if slot.endswith(OF_EACH) else None


def _person(id: str) -> str:
    return f"\x02{id}\x03"
