"""The picture on the chest screen in an activity by facts, and the one that stays there."""

from __future__ import annotations

from collections.abc import Callable

from tangy_hw.device_protocols import Picture
from tangy_profiles.declared.game import DeclaredGame
from tangy_profiles.declared.speech import media, person_on_screen, standing_words, with_names

SeatOf = Callable[[str | None], str]
"""Returns the public word for a person."""


def chest_picture(
    game: DeclaredGame, behaviour: str, whom: str | None, text: str, seat_of: SeatOf
) -> Picture:
    """Return the picture of a behaviour.

    Args:
        game: the game after it.
        behaviour: its name.
        whom: the person addressed, None for the group.
        text: its screen text, with people as ids.
        seat_of: returns the public word for a person.
    """
    invites = game.declaration.behaviours[behaviour].invites
    asks = "" if invites else seat_of(person_on_screen(game, whom))
    shown, _ = media(game, behaviour)
    return Picture(with_names(text, seat_of), asks=asks, file=shown.path if shown else "")


def standing_picture(game: DeclaredGame, seat_of: SeatOf) -> tuple[str, Picture | None]:
    """Return speech and picture of what stays on the screen, such as an open question.

    The speech has people as ids; "" and None if nothing stays there.
    """
    if game.screen is None:
        return "", None
    speech, text = standing_words(game)
    return speech, chest_picture(game, game.screen[0], game.screen[1], text, seat_of)
