"""The state of the bench's people: each at the table, and their game."""

from __future__ import annotations

from dataclasses import dataclass, field

from tangy_profiles.state import Response
from tangy_sim.worlds.users import SimulatedUser


@dataclass
class Sitter:
    """A person at the table, with a card and a sign.

    `asks_since` is the time (s) at which the sign went up, None while it is down; `visited` whether
    the robot has been there since; `hides` how the
    card is out of view, "" if it is visible; `moved` how often the card was moved, `refused` how
    many requests the person refused.
    """

    player: SimulatedUser
    card: int
    asks_since: float | None = None
    visited: bool = False
    hides: str = ""
    moved: int = 0
    refused: int = 0

    @property
    def id(self) -> str:
        """Id of the person."""
        return self.player.id


@dataclass
class GameProgress:
    """Events of a game so far, as everybody in the room knows them."""

    opened: bool = False
    over: bool = False
    called: list[int] = field(default_factory=list)
    responses: list[Response] = field(default_factory=list)
    spoken: list[str] = field(default_factory=list)
    """People who have asked for help aloud, because signs cannot be seen."""
    acts: list[tuple[str, str, str, float]] = field(default_factory=list)
    """Observations that no sensor sees: fact, person, value, certainty."""
