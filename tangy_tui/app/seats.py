"""Who sits where somebody else usually sits, told once, and when that is over."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from tangy_tui.interaction.game_events import GameBegun
from tangy_tui.monitoring.supervision import Event


class Seats:
    """Tells what is new of who sits where, game by game."""

    def __init__(self, name: Callable[[str], str]) -> None:
        """Prepare to tell; `name` says what somebody is called."""
        self._name = name
        self._told: dict[str, str] = {}

    def news(self, events: Iterable[Event], sitting: Mapping[str, str]) -> list[str]:
        """Say what is new after what happened, of who was seen at whose place."""
        if any(isinstance(event, GameBegun) for event in events):
            self._told = {}  # nobody has been seen in this game yet
        before, self._told = self._told, dict(sitting)
        lines = []
        for place, person in self._told.items():
            if before.get(place) != person:
                name = self._name(person)
                lines.append(f"{name} sits at {self._name(place)}'s place: Tangy speaks to {name}.")
        for place in before.keys() - self._told.keys():
            lines.append(f"{self._name(place)} sits at {self._name(place)}'s place again.")
        return lines
