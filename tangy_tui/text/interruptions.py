"""Words for an interrupted game: how far it had come, and how to resume or end it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tangy_tui.text.numbers import counted, listed
from tangy_tui.text.times import day_and_time

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame

TITLE = "A game was interrupted"
ADD = ("add", "add somebody who has come", "and then go on with it")
RESUME = ("resume", "go on with it", "paused at first")
END = ("end", "end it", "with a report of it")
DISCARD = ("discard", "discard it", "and play a new game")
ENDED = "It was interrupted, and ended afterwards."
"""The logged reason for the end of such a game."""
_LATER = "start Tangy again to go on with it."
GOES_ON_LATER = f"The game is not over: {_LATER}"
NONE = "No game was interrupted: there is nothing to go on with. Leave --resume out."
BOTH = "Use either --resume or --discard."


def interrupted_words(past: PastGame, calls: int) -> str:
    """Tell when a game was interrupted, and how far it had come."""
    return f"A game was interrupted after {_far(past, calls)} ({day_and_time(past.at)})."


def still_open_words(past: PastGame, calls: int) -> str:
    """Tell in the note on a choice that a game was interrupted, and can be resumed."""
    return f"interrupted after {_far(past, calls)}: Enter asks whether to go on"


def to_be_resumed_words(past: PastGame, calls: int) -> str:
    """Tell, once the program has ended, that its game can be resumed."""
    return f"The game is not over, after {_far(past, calls)}: {_LATER}"


def _far(past: PastGame, calls: int) -> str:
    return counted(calls, "call") if calls else counted(len(past.steps), "step")


def begins_anew(verb: str) -> str:
    """Tell that a new game begins, and how to resume the interrupted one instead."""
    return (
        f"A new game begins. `tangy {verb} --resume` would go on with the interrupted one, "
        "until another game is played."
    )


def waiting_words(names: Sequence[str]) -> str:
    """Tell that people who came meanwhile cannot join the resumed game."""
    verb = "plays" if len(names) == 1 else "play"
    return f"{listed(names)} cannot join this game in the middle, and {verb} in the next one."


def with_words(names: Sequence[str]) -> str:
    """Describe the choice to resume with people who came meanwhile."""
    return f"paused at first; {listed(names)} joins" if names else RESUME[2]


def lines_ask(*, joins: bool) -> str:
    """Ask in console mode what becomes of a game that was interrupted."""
    add = " If somebody has come, type first, as in: add Berta." if joins else ""
    return f"Type: go on, end (with a report), or discard (and play a new game).{add}"


KEPT = "The game is kept. You are asked again the next time."


def joins_words(name: str) -> str:
    """Tell that a person joins the interrupted game."""
    return f"{name} joins. Type: go on."


def kept_words(command: str) -> str:
    """Tell how to go on with a game for which the robot did not come on again."""
    return f"The game is kept. Go on with it by: {command}"
