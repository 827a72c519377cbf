"""Voiding of a person's last response in a game, because it was observed wrongly."""

from __future__ import annotations

from tangy_profiles.store import Store
from tangy_tui.interaction.feedback import Feedback


def void_last(store: Store, game: str, person: str, by: str) -> bool:
    """Void a person's last response in a game; return whether there was one.

    Args:
        store: the log.
        game: the id of the game.
        person: the id of the person.
        by: who says so.
    """
    feedback = Feedback(store)
    entries = [e for e in feedback.history(person) if e.game == game and e.counts]
    if not entries:
        return False
    feedback.void(person, entries[-1].seq, f"said by {by} in the game")
    return True
