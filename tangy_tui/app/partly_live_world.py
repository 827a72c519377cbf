"""A simulated room with some real devices, whose reports override the simulated ones.

So that a lens that is covered in earnest is diagnosed in a simulated game as what it is.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence

from tangy_profiles.activity import Activity
from tangy_profiles.health import Health
from tangy_sim.worlds.faulty_world import FaultyWorld
from tangy_sim.worlds.injection import Injection

OLDEST = 0.05
"""Seconds for which a reading is not asked for anew: the rules look at it 40 times a second."""


class PartlyLiveWorld(FaultyWorld):
    """A simulated world in which the readings of some devices are those of real ones."""

    def __init__(
        self,
        activity: Activity,
        people: Sequence[str],
        *,
        seed: int,
        injections: Sequence[Injection] = (),
        live: Callable[[], Health],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """Make the world; `live` gives the readings of the real devices, of `clock`'s present."""
        self._live = live
        self._clock = clock
        self._simulated: Health = ()
        self._merged: Health = ()
        self._asked = 0.0
        super().__init__(activity, people, seed=seed, injections=injections)

    def health(self) -> Health:
        """Return what the devices report, the real ones as they are."""
        simulated, now = super().health(), self._clock()
        if simulated is not self._simulated or now - self._asked > OLDEST:
            real = {reading.device: reading for reading in self._live()}
            self._simulated, self._asked = simulated, now
            self._merged = tuple(real.get(reading.device, reading) for reading in simulated)
        return self._merged
