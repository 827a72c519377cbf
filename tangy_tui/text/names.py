"""Words for people's names, their pronunciation, and how Tangy speaks to people."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

if TYPE_CHECKING:
    from tangy_tui.language.name_conflicts import NameConflict
    from tangy_tui.language.name_pronunciation import HowSaid


def turn_words(name: str) -> str:
    """Tell whose turn it is: a person's, or a team's, whose name may be a plural."""
    whose = f"{name}'" if name.endswith("s") else f"{name}'s"
    return f"It is {whose} turn"


def renamed(person: str, name: str) -> str:
    """Tell a person's new name."""
    return f"{person} is now called {name}."


def said_words(said: HowSaid) -> str:
    """Tell the pronunciation of a name, and whether Tangy can recognise it."""
    match said.source:
        case "person":
            return f"{said.name} is said {said.phones}."
        case "dictionary":
            return f"{said.name} is said {said.phones}, as in the dictionary."
        case "suggested":
            lacks = " and ".join(map(repr, said.lacks))
            are = "is" if len(said.lacks) == 1 else "are"
            return (
                f"{said.name} can be typed, but not yet heard: {lacks} {are} not in the "
                f"dictionary. It may be said {said.phones}."
            )
        case "":
            return f"{said.name} can be typed, but not heard: nobody knows how it is said."
        case forgotten:
            assert_never(forgotten)


def naming_lines(said: HowSaid, command: str) -> list[str]:
    """Tell what to do about a new name that Tangy cannot recognise yet.

    Args:
        said: the pronunciation.
        command: the command that stores a pronunciation, without the phones.
    """
    match said.source:
        case "person" | "dictionary":
            return []
        case "suggested":
            return [
                said_words(said),
                f"Hear it:     {command} --hear",
                f"Accept it:   {command} --accept",
                f'Change it:   {command} "{said.phones}"',
            ]
        case "":
            return [said_words(said), f'Say how:     {command} "R OW Z AH"']
        case forgotten:
            assert_never(forgotten)


def conflict_words(conflict: NameConflict) -> str:
    """Tell which name or phrase a name sounds like, and what Tangy then cannot recognise."""
    name, like = conflict.person.name, conflict.like
    if conflict.guessed:
        return (
            f"{name} can be typed, but not heard: it may be said {conflict.guessed}, "
            f"and that sounds like {like}."
        )
    if not conflict.lost:
        return f"{name} sounds like {like}: if you say it alone, Tangy takes it for that."
    return f"{name} sounds like {like}: {conflict.lost} can be typed, but not heard."


def say_otherwise(command: str) -> str:
    """Tell what to do about a name that sounds like another."""
    return f"Change how Tangy says it, or choose another name: {command}"


def if_right(command: str) -> str:
    """Tell how to accept a suggested pronunciation."""
    return f"To accept it: {command} --accept"


def known_now(sentence: str, world: str) -> str:
    """Describe a person's posteriors after a change, in the games of a world."""
    return f"Now: {sentence}, in {world} games."


def voice_words(name: str, rate: int | None, voice: str | None) -> str:
    """Tell how a person is spoken to."""
    parts = []
    if rate is not None:
        parts.append(f"at {rate} words a minute")
    if voice is not None:
        parts.append(f"in the voice {voice}")
    return f"Tangy speaks to {name} {' '.join(parts) or 'as to everybody else'}."
