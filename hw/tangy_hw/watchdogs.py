"""Watchdogs (III-C): state and age of each device's data, and whether the robot may drive."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tangy_profiles.health import ERROR, OK, STALE, DeviceState, Health, Reading, state_of
from tangy_profiles.robot import Robot

Report = Callable[[], Reading]
"""Returns the newest reading of a device."""

DRIVES_BY = ("link", "stop_button", "base", "laser", "localisation", "navigator")
"""Devices that must work for the robot to drive, as far as it has them."""

DARK = 0.6
"""Share of beams with a very short range from which a laser scanner is covered (robot notes)."""

BLIND = 0.01
"""Share of beams that change within a second below which a laser scanner sees nothing or repeats a
scan; its noise changes ranges even in a static room."""


class Watchdogs:
    """Health of a robot: one report for each device of its profile."""

    def __init__(self, robot: Robot, reports: Mapping[str, Report]) -> None:
        """Watch a robot's devices.

        Args:
            robot: the robot's profile.
            reports: report of each device; a device without one does not exist, so nothing can be
                wrong with it.
        """
        self._robot = robot
        self._reports = dict(reports)
        self._silenced: dict[str, DeviceState] = {}

    def health(self) -> Health:
        """Return the newest reading of every device."""
        return tuple(self._reading(name) for name in self._robot.devices)

    def fail(self, device: str, state: DeviceState = ERROR) -> None:
        """Override the state of a device; OK removes the override."""
        if state == OK:
            self._silenced.pop(device, None)
        else:
            self._silenced[device] = state

    def ages(self) -> dict[str, float]:
        """Return the age, in s, of the data that driving depends on."""
        return {name: self._reading(name).age for name in DRIVES_BY if name in self._reports}

    def late(self) -> dict[str, float]:
        """Return the age, in s, of stale data that driving depends on."""
        return {
            name: reading.age
            for name in DRIVES_BY
            if name in self._reports and self.state(reading := self._reading(name)) == STALE
        }

    def hazard(self) -> str:
        """Return why the robot must not drive now, "" if it may."""
        for name in DRIVES_BY:
            if name not in self._reports:
                continue
            reading = self._reading(name)
            state = self.state(reading)
            if state in (ERROR, STALE):
                said = "says nothing" if state == STALE else "has an error"
                return f"{self.label(name)} {said}"
            if reading.facts.get("latched"):
                return f"{self.label(name)} is pressed"
            if _measured(reading, "near_share", 0.0) > DARK:
                return f"{self.label(name)} is covered"
            if _measured(reading, "variety", 1.0) < BLIND:
                return f"{self.label(name)} sees nothing new"
        return ""

    def label(self, name: str) -> str:
        """Return the label of a device."""
        device = self._robot.devices.get(name)
        return name if device is None else device.label

    def state(self, reading: Reading) -> DeviceState:
        """Return the state of a device of the robot, as `state_of` does."""
        return state_of(self._robot.devices.get(reading.device), reading)

    def _reading(self, name: str) -> Reading:
        report = self._reports.get(name)
        reading = Reading(name) if report is None else report()
        silenced = self._silenced.get(name)
        return reading if silenced is None else reading._replace(state=silenced)


def _measured(reading: Reading, fact: str, otherwise: float) -> float:
    """Return a fact of a device, or a default if it is missing."""
    value = reading.facts.get(fact, otherwise)
    return otherwise if isinstance(value, str) else float(value)
