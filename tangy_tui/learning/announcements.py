"""Announcements of a guided game: each coming situation once, as early as possible."""

from __future__ import annotations

from tangy_profiles.scene import Arranged, ArrangedSituation
from tangy_tui.learning.teaching_events import Announced
from tangy_tui.world import Arranging, World


class Announcements:
    """Looks at a world after each step, and announces each coming event once."""

    def __init__(self) -> None:
        self._coming: Arranged | ArrangedSituation | None = None

    def news(self, world: World) -> list[Announced]:
        """Return what the world is about to bring about, if that was not told yet."""
        coming = world.coming if isinstance(world, Arranging) and not world.over else None
        before, self._coming = self._coming, coming
        return [Announced(coming)] if coming is not None and coming != before else []
