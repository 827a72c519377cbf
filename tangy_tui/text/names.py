"""What a person is called, how the name is said, and how Tangy speaks to them."""

from __future__ import annotations


def renamed(person: str, name: str) -> str:
    """Say what a person is called from now on."""
    return f"{person} is now called {name}."


def say_otherwise(command: str) -> str:
    """Say what to do about a name that sounds like another."""
    return f"Change how Tangy says it, or choose another name: {command}"


def if_right(command: str) -> str:
    """Say how a pronunciation that was suggested is accepted."""
    return f"To accept it: {command} --accept"


def known_now(sentence: str, world: str) -> str:
    """Say what is known of a person after a change, in the games of a world."""
    return f"Now: {sentence}, in {world} games."


def voice_words(name: str, rate: int | None, voice: str | None) -> str:
    """Say how a person is spoken to."""
    parts = []
    if rate is not None:
        parts.append(f"at {rate} words a minute")
    if voice is not None:
        parts.append(f"in the voice {voice}")
    return f"Tangy speaks to {name} {' '.join(parts) or 'as to everybody else'}."
