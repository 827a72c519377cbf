"""Symptoms during a drive, kept for a while because some pass before they are read.

A brief loss of localisation is kept until the robot has turned on the spot: it may be localised
again, but no longer where it was in the game.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from tangy_profiles.health import Fact, Reading

if TYPE_CHECKING:
    from tangy_hw.navigation.navigator_protocol import NavigatorProtocol

LOST_FIT, LOST_SPREAD, SLIPS = 0.85, 0.5, 0.3  # thresholds of the fault rules
KEPT_SECONDS = 3.0  # for which symptoms are reported after a drive


class DriveMonitor:
    """The worst of a navigator's facts during the current drive, and for a moment after it."""

    def __init__(self, navigator: NavigatorProtocol, now: Callable[[], float]) -> None:
        self.blocked = False
        """Whether there was no path to the last goal."""
        self._navigator = navigator
        self._now = now
        self._worst: dict[str, Fact] = {}
        self._kept: dict[str, Fact] = {}
        self._until = 0.0
        self._lost: dict[str, Fact] = {}
        self._slipped = 0.0

    def begin(self) -> None:
        """Start a drive, and clear the symptoms of the last one."""
        self.blocked = False
        self._worst, self._kept = {}, {}

    def note(self) -> None:
        """Update with the current facts."""
        facts, worst = self._navigator.facts(), self._worst
        for name in ("still", "slip"):
            worst[name] = max(float(worst.get(name, 0.0)), float(facts[name]))
        if facts["path"] == "replanned":
            worst["path"] = "replanned"
        if float(facts["fit"]) < LOST_FIT and float(facts["spread"]) > LOST_SPREAD:
            self._lost |= {name: facts[name] for name in ("fit", "spread")}
            if float(worst["slip"]) > SLIPS:  # the cause of being lost
                self._slipped = max(self._slipped, float(worst["slip"]))

    def keep(self) -> None:
        """Keep the symptoms of a finished drive for a moment."""
        self._kept, self._until = dict(self._worst), self._now() + KEPT_SECONDS

    def detour_taken(self) -> None:
        """Drop the symptom of a detour that is being driven."""
        self._worst.pop("path", None)
        self._kept.pop("path", None)

    def base(self, own: Reading) -> Reading:
        """Return the reading of the base, with the navigator's facts about it."""
        facts = self._navigator.facts()
        told = {name: facts[name] for name in ("still", "slip")} | self._of("still", "slip")
        told["slip"] = max(float(told["slip"]), self._slipped)
        return own._replace(facts={**own.facts, **told})

    def looked_round(self, *, found: bool) -> None:
        """Record the result of a turn on the spot: localised or not."""
        if not found:
            self._lost["found"] = False
            return
        self._lost, self._slipped = {}, 0.0

    def localisation(self, age: float) -> Reading:
        """Return the reading of localisation, last updated `age` s ago."""
        reading = self._navigator.readings(age)[0]
        return reading._replace(facts={**reading.facts, **self._lost})

    def navigator(self, age: float) -> Reading:
        """Return the reading of navigation, last updated `age` s ago."""
        reading = self._navigator.readings(age)[1]
        told: dict[str, Fact] = {"path": "none"} if self.blocked else self._of("path")
        return reading._replace(facts={**reading.facts, **told})

    def _of(self, *names: str) -> dict[str, Fact]:
        if self._now() >= self._until:
            return {}
        return {name: self._kept[name] for name in names if name in self._kept}
