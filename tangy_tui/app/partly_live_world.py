"""A simulated room with some real devices, whose readings replace the simulated ones.

If a person covers the real camera during a simulated game, Tangy diagnoses it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.health import Health
from tangy_profiles.robot import Robot
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import Injection

OLDEST = 0.05
"""Readings are cached for this many seconds: the fault rules read them 40 times a second."""


class PartlyLiveWorld(FaultyWorld):
    """A simulated world in which some devices are real."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        injections: Sequence[Injection] = (),
        robot: Robot | None = None,
        live: Callable[[], Health],
    ) -> None:
        """Create the world; `live` returns the current readings of the real devices."""
        self._live = live
        self._simulated: Health = ()
        self._merged: Health = ()
        self._asked = 0.0
        super().__init__(activity, people, seed=seed, injections=injections, robot=robot)

    def health(self) -> Health:
        """Return the readings of all devices; real ones replace simulated ones."""
        simulated, now = super().health(), time.monotonic()
        if simulated is not self._simulated or now - self._asked > OLDEST:
            real = {reading.device: reading for reading in self._live()}
            self._simulated, self._asked = simulated, now
            self._merged = tuple(real.get(reading.device, reading) for reading in simulated)
        return self._merged
