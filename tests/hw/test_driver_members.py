"""Drivers are checked against the Protocol of their device when they are opened."""

from __future__ import annotations

import pytest

from tangy_hw.device_protocols import Device, DeviceError, MachineClock, members_of
from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import DriverKind, DriverSettings, Wiring, open_device
from tangy_profiles.activity import load_activity
from tangy_profiles.health import Reading
from tangy_profiles.robot import load_robot


class LaserWithoutScan:
    """Implements `Device`, but not `Laser`."""

    name = "laser"

    async def start(self) -> None: ...

    async def close(self) -> None: ...

    def reading(self) -> Reading:
        return Reading(self.name)


class ConstantLaser(LaserWithoutScan):
    @property
    def scan(self) -> None:
        raise AssertionError("opening a driver must not read its scan")


def open_laser(monkeypatch: pytest.MonkeyPatch, driver: Device, device: str = "laser") -> Device:
    def opens(wiring: Wiring, settings: DriverSettings) -> Device:
        return driver

    kinds = {**registry.DRIVERS, "mine": DriverKind((device,), opens)}
    monkeypatch.setattr(registry, "DRIVERS", kinds)
    wiring = Wiring(load_robot("tangy"), load_activity("bingo"), MachineClock())
    return open_device(wiring, device, {"kind": "mine"})


def test_a_driver_without_a_member_of_its_protocol_is_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pytest.raises(DeviceError, match=r"drivers\.laser \(mine\).* scan\."):
        open_laser(monkeypatch, LaserWithoutScan())


def test_a_driver_with_all_members_is_opened_without_reading_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    driver = ConstantLaser()
    assert open_laser(monkeypatch, driver) is driver


def test_a_camera_is_refused_a_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(DeviceError, match=r"drivers\.camera: .*source"):
        open_laser(monkeypatch, LaserWithoutScan(), "camera")


def test_a_device_of_the_robots_own_needs_the_common_members_only() -> None:
    assert members_of("battery") == ("name", "start", "close", "reading")
    assert members_of("laser") == ("name", "start", "close", "reading", "scan")


def test_rosbridge_refuses_a_device_that_it_has_no_driver_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rosbridge = registry.DRIVERS["rosbridge"]
    more = rosbridge._replace(devices=(*rosbridge.devices, "lamp"))
    monkeypatch.setattr(registry, "DRIVERS", {**registry.DRIVERS, "rosbridge": more})
    wiring = Wiring(load_robot("tangy"), load_activity("bingo"), MachineClock())
    with pytest.raises(DeviceError, match="no device named 'lamp'"):
        open_device(wiring, "lamp", {"kind": "rosbridge", "at": "ws://127.0.0.1:9"})


def test_a_driver_that_raises_when_it_is_opened_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def opens(wiring: Wiring, settings: DriverSettings) -> Device:
        raise ValueError("no such port.")

    monkeypatch.setattr(registry, "DRIVERS", {"mine": DriverKind(("laser",), opens)})
    wiring = Wiring(load_robot("tangy"), load_activity("bingo"), MachineClock())
    with pytest.raises(
        DeviceError, match=r"drivers\.laser \(mine\): .*ValueError: no such port\.$"
    ):
        open_device(wiring, "laser", {"kind": "mine"})


def test_a_kind_that_nobody_knows_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    wiring = Wiring(load_robot("tangy"), load_activity("bingo"), MachineClock())
    with pytest.raises(
        DeviceError, match=r"no driver 'xyzzy' .is its package installed.*; choose one of"
    ):
        open_device(wiring, "laser", {"kind": "xyzzy"})
    with pytest.raises(DeviceError, match="'page' drives no laser; choose one of"):
        open_device(wiring, "laser", {"kind": "page"})
