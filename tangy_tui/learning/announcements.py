"""Announcements of a guided game: each upcoming situation once, as early as possible."""

from __future__ import annotations

from tangy_profiles.scene import ArrangedCard, ArrangedSituation
from tangy_tui.learning.teaching_events import Announced
from tangy_tui.world import Arranging, World


class Announcements:
    """Checks a world after each step, and announces each upcoming event once."""

    def __init__(self) -> None:
        self._coming: ArrangedCard | ArrangedSituation | None = None

    def news(self, world: World) -> list[Announced]:
        """Return the event that the world will bring about next, unless already announced."""
        coming = world.coming if isinstance(world, Arranging) and not world.over else None
        before, self._coming = self._coming, coming
        return [Announced(coming)] if coming is not None and coming != before else []
