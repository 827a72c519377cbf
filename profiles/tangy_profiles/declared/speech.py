"""Texts for speech and screen in a declared activity, with their slots filled in."""

from __future__ import annotations

import re
from collections.abc import Callable

from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.media import file_name
from tangy_profiles.declared.model import MediaFile
from tangy_profiles.declared.vocabulary import SLOT

PERSON = re.compile(r"\x02([^\x03]*)\x03")
"""A person's id in a filled text, because the worlds do not know names."""
OF_EACH = " of each"


def filled(game: DeclaredGame, template: str, whom: str | None, turn: str = "") -> str:
    """Fill the slots of a text.

    Args:
        game: the game, with its current item.
        template: the text.
        whom: the player who is addressed, None for the group.
        turn: the player whose turn it is in the text ("": whose turn it is now).

    Returns:
        The text, with people as ids (see `with_names`); "" if a slot is empty.
    """
    empty = False

    def value(match: re.Match[str]) -> str:
        nonlocal empty
        found = _value(game, match.group(1), whom, turn)
        empty = empty or not found
        return found

    text = SLOT.sub(value, template)
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
        return filled(game, declared.image, person, turn)
    return game.declaration.title


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
    if slot.endswith(OF_EACH) and slot[: -len(OF_EACH)] in declaration.facts:
        fact = declaration.facts[slot[: -len(OF_EACH)]]
        parts = [f"{_person(one)} {game.number(fact, one):.0f}" for one in game.here]
        *others, last = parts
        return f"{', '.join(others)} and {last}" if others else last
    if slot in declaration.items.columns:
        return declaration.items.value(game.row, slot).split("|")[0]
    fact = declaration.facts[slot]
    if fact.kind in ("count", "timer"):
        return f"{game.number(fact, whom):.0f}"
    return game.value(slot, whom)


def _person(id: str) -> str:
    return f"\x02{id}\x03"
