"""News about people who sit at another person's place, and about their return."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tangy_tui.interaction.game_events import GameBegun, ResumedGame
from tangy_tui.monitoring.supervision import Event


@dataclass(frozen=True, slots=True)
class Seated:
    """A person was seen at another's place, or at their own again."""

    person: str
    place: str


class Seats:
    """Collects news about who sits where, per game."""

    def __init__(self) -> None:
        """Start with everybody at their own place."""
        self._told: dict[str, str] = {}

    def news(self, events: Iterable[Event], sitting: Mapping[str, str]) -> list[Seated]:
        """Return the news after some events: who was seen at whose seat."""
        if any(isinstance(event, GameBegun | ResumedGame) for event in events):
            self._told = {}  # nobody has been seen in this game yet
        before, self._told = self._told, dict(sitting)
        new = [Seated(one, place) for place, one in self._told.items() if before.get(place) != one]
        return new + [Seated(place, place) for place in before.keys() - self._told.keys()]
