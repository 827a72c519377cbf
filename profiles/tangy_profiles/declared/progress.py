"""Progress of a game of a declared activity: whether its behaviours lead anywhere.

A behaviour leads nowhere if it changes nothing that decides what comes next, or if the game is then
in a state in which it has been since people last did something: the same behaviours would follow
again.
"""

from __future__ import annotations

from collections.abc import Hashable

from tangy_profiles.declared.game import DeclaredGame, Key
from tangy_profiles.declared.state_keys import state_key
from tangy_profiles.state import Progress

A_MOMENT = 1e-6
"""In s: a timer is surely in its next band so long after the bound, whatever is rounded."""


class ProgressWatch:
    """Judges each behaviour of a game: `begin`, then `done` after its effects, then `end`."""

    def __init__(self, game: DeclaredGame) -> None:
        self._been: set[Hashable] = set()
        self._last = self._before = game.copy()
        self._acted = False
        self._progress: Progress = "none"

    def begin(self, game: DeclaredGame) -> None:
        """Note the state before a behaviour."""
        self._acted = game.differs(self._last)  # people, in between
        if self._acted:
            self._been.clear()
        self._been.add(_state(game))
        self._last = self._before = game.copy()
        self._progress = "none"

    def done(self, game: DeclaredGame) -> None:
        """Judge the effects of the behaviour, before people act."""
        key = _state(game)
        self._progress = progress(self._before, game)
        if self._progress == "on" and key in self._been:
            self._progress = "back"
        self._been.add(key)
        self._last = game.copy()

    def end(self, game: DeclaredGame) -> Progress:
        """Return the progress, after people could act."""
        if game.differs(self._last):
            self._acted = True
            self._been.clear()
            self._last = game.copy()
        return "on" if self._acted else self._progress


def progress(before: DeclaredGame, after: DeclaredGame) -> Progress:
    """Return the progress by the effects of one behaviour alone."""
    if after.over or _untimed(before) != _untimed(after) or _timers(before) != _timers(after):
        return "on"
    return "waits" if _waits(after) else "none"


def _state(game: DeclaredGame) -> Hashable:
    """Return what can influence the rest of the game, and whose turn it is.

    For a search, games are alike if only another person has the turn; for that person they are not.
    """
    return state_key(game), game.turn


def _untimed(game: DeclaredGame) -> Hashable:
    """Return what can influence the rest of the game, apart from how late it is."""
    still = game.copy()
    still.now = 0.0
    return _state(still)


def _timers(game: DeclaredGame) -> dict[Key, float]:
    """Return when each timer that conditions or stages read was started, in s of the game."""
    read = {fact.name for fact, _ in game.declaration.looked_at if fact.kind == "timer"}
    return {key: began for key, began in game.counts.items() if key[0] in read}


def _waits(game: DeclaredGame) -> bool:
    """Return whether time alone will change the situation that the policy sees."""
    moments = {
        began + bound + A_MOMENT
        for (name, _), began in _timers(game).items()
        for bound in game.declaration.bounds_of(game.declaration.facts[name])
    }
    seen = game.seen()
    return any(game.seen(at) != seen for at in sorted(moments) if at > game.now)
