"""Coverage in a teaching session: by all earlier demonstrations, and by this game."""

from __future__ import annotations

from tangy_profiles.state import Situation
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.coverage import Coverage, coverage
from tangy_tui.learning.library import read_library
from tangy_tui.learning.teaching_session import TeachingSession


class ShownSoFar:
    """Counts the situations of a session; reads the library once per game, not per step."""

    def __init__(self, workspace: Workspace, teaching: TeachingSession) -> None:
        self._workspace = workspace
        self._teaching = teaching
        self._before = Coverage(dict.fromkeys(workspace.activity.situations, 0))

    def begin(self) -> None:
        """Count the situations shown before this game, without those it replaces."""
        activity, present = self._workspace.activity, self._teaching.demonstration
        replaced = {present.id, *present.of}
        finished = read_library(self._workspace.store, activity.name).finished
        self._before = coverage(activity, [d for d in finished if d.id not in replaced])

    def now(self) -> Coverage:
        """Count all situations shown up to now."""
        here = self.here().times
        return Coverage({s: times + here[s] for s, times in self._before.times.items()})

    def here(self) -> Coverage:
        """Count the situations shown in this game."""
        return coverage(self._workspace.activity, [self._teaching.demonstration])

    def first(self, situation: Situation) -> bool:
        """Return whether the last step was the first one ever in its situation."""
        return self.now().times.get(situation) == 1
