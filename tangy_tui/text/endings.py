"""Words for how games ended."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tangy_tui.text.numbers import listed

if TYPE_CHECKING:
    from tangy_tui.monitoring.games import Game

TO_ITS_END = "played to the end"
ENDED_EARLY = "ended early: “{due}” was still to come"
BROKEN_OFF = "it has no end in the log: it is still going on, or the program was broken off"

SEVERAL = (
    ("It was ", "They were "),
    ("It has no end in the log: it is", "They have no end in the log: they are"),
    ("before its end", "before the end"),
)
"""What is written otherwise about several games."""


def ending_words(game: Game) -> str:
    """Tell how a game ended: the reason in the log, or a clause."""
    if game.ended is None:
        return BROKEN_OFF
    if game.stopped is not None:
        return game.stopped
    return ENDED_EARLY.format(due=game.due) if game.due else TO_ITS_END


def ending_sentence(game: Game) -> str:
    """Tell how a game ended in a sentence of its own."""
    words = ending_words(game)
    return words[:1].upper() + words[1:] + ("" if words.endswith((".", "!", "?")) else ".")


def all_endings(games: Sequence[Game]) -> str:
    """Tell how the games of a session ended, those that ended alike together."""
    alike: dict[str, list[int]] = {}
    for game in games:
        alike.setdefault(ending_sentence(game), []).append(game.number)
    return " ".join(
        f"Game {listed(numbers)}: {words}"
        if len(numbers) == 1
        else f"Games {listed(numbers)}: {_of_several(words)}"
        for words, numbers in alike.items()
    )


def _of_several(words: str) -> str:
    for one, several in SEVERAL:
        words = words.replace(one, several)
    return words


def game_document(game: Game) -> dict[str, Any]:
    """Return a game as `--json` lists it, with its ending in words."""
    return {**game.to_json(), "ending": ending_words(game)}
