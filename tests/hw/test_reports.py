"""The common report of devices: the worst of several links to a robot counts."""

from __future__ import annotations

import numpy as np
import pytest

from tangy_hw.device_protocols import MachineClock
from tangy_hw.drivers.registry import Wiring, open_device
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.robot_process.device_diagnostics import device_diagnostics
from tangy_hw.robot_process.drive_monitor import DriveMonitor
from tangy_hw.watchdogs import Watchdogs
from tangy_profiles.activity import load_activity
from tangy_profiles.health import ERROR, OK, STALE, WARN, DeviceState, Reading
from tangy_profiles.robot import load_robot
from tests.hw.live_bodies import ToldBody, ToldDevice
from tests.hw.navigated import MAP

ROBOT = load_robot()
BASE, VOICE = "ws://10.0.0.1:9090", "ws://10.0.0.2:9090"


class Link(ToldDevice):
    """One of several links; the robot may drive by it."""

    def __init__(self, state: DeviceState = OK, age: float = 0.0, *, drives: bool = True) -> None:
        super().__init__("link", [])
        self.state, self.age, self.drives = state, age, drives


def watched(*links: Link) -> Watchdogs:
    evidence = DriveMonitor(Navigator(MAP, np.random.default_rng(1)), lambda: 0.0)
    return Watchdogs(
        ROBOT, device_diagnostics(ROBOT, ToldBody().body(*links), evidence, lambda: 0.0)
    )


def told(*links: Link) -> Reading:
    return next(reading for reading in watched(*links).health() if reading.device == "link")


@pytest.mark.parametrize("bad", [Link(STALE), Link(OK, 1.0), Link(ERROR)])
def test_the_robot_stops_if_it_loses_a_link_needed_for_driving(bad: Link) -> None:
    for links in ([bad, Link()], [Link(), bad], [Link(), bad, Link(WARN)]):
        assert told(*links) == bad.reading()
        assert watched(*links).hazard().startswith(ROBOT.devices["link"].label)
    assert watched(Link(), Link()).hazard() == ""


def test_the_oldest_data_counts_among_healthy_links() -> None:
    assert told(Link(OK, 0.1), Link(OK, 0.2), Link(OK, 0.0)).age == 0.2


def test_a_link_of_the_voice_alone_does_not_stop_the_robot() -> None:
    assert told(Link(), Link(STALE, 9.0, drives=False)) == Link().reading()
    assert watched(Link(), Link(STALE, 9.0, drives=False)).hazard() == ""


@pytest.mark.parametrize(
    ("devices", "drives"),
    [
        ({"voice": VOICE}, {VOICE: False}),
        ({"base": BASE, "voice": VOICE, "arms": VOICE}, {BASE: True, VOICE: False}),
        ({"voice": BASE, "base": BASE}, {BASE: True}),
        ({"base": BASE, "arms": BASE}, {BASE: True}),
        ({"stop_button": BASE, "laser": VOICE}, {BASE: True, VOICE: True}),
    ],
)
async def test_a_link_is_needed_for_driving_if_one_of_its_devices_is(
    devices: dict[str, str], drives: dict[str, bool]
) -> None:
    wiring = Wiring(ROBOT, load_activity("bingo"), MachineClock())
    for device, at in devices.items():
        open_device(wiring, device, {"kind": "rosbridge", "at": at})
    assert {at: link.drives for at, link in wiring.links.items()} == drives
