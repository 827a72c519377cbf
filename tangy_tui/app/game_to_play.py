"""The answer to the question about an interrupted game: which game is played now."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tangy_profiles.past_game import PastGame


@dataclass(frozen=True, slots=True)
class GameToPlay:
    """The game to play: an interrupted one to resume, or (None) a new one."""

    past: PastGame | None
