"""A battery behind ROS, from the message to the fault; and the shipped robots."""

from __future__ import annotations

from typing import Any

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.camera_source import find_camera
from tangy_hw.drivers.registry import Wiring, open_device
from tangy_hw.drivers.ros_battery import RosBattery, charge_of
from tangy_hw.drivers.simulated_clock import SteppedClock
from tangy_hw.navigation.limits import MotionLimits
from tangy_hw.robot_process.assembly import drivers_of
from tangy_profiles.activity import Activity
from tangy_profiles.fault_file import load_faults
from tangy_profiles.health import OK, STALE
from tangy_profiles.robot import load_robot
from tangy_tui.monitoring.diagnosis import diagnose
from tests.hw.ros_links import linked, soon
from tests.support.waiting import until


def state(percentage: float | None, status: int = 2, **more: Any) -> dict[str, Any]:
    """Return a sensor_msgs/BatteryState; unmeasured values are null in JSON."""
    return {
        "voltage": 14.2, "current": -0.8, "charge": None, "capacity": None,
        "design_capacity": 2.6, "percentage": percentage, "power_supply_status": status,
        "present": True, **more,
    }  # fmt: skip


class TestBattery:
    async def test_the_battery_reports_its_charge_and_whether_it_is_charging(self) -> None:
        async with linked() as (server, bridge, now):
            battery = RosBattery(bridge)
            await battery.start()
            await soon(server.subscribed("/battery_state"))
            assert battery.reading().state == STALE
            server.publish("/battery_state", "sensor_msgs/BatteryState", state(0.43))
            await until(lambda: battery.reading().state == OK)
            assert battery.reading().facts == {"charge": 0.43, "charging": False}
            server.publish("/battery_state", "sensor_msgs/BatteryState", state(0.44, 1))
            await until(lambda: battery.reading().facts["charging"] is True)
            server.publish("/battery_state", "sensor_msgs/BatteryState", {"percentage": "full"})
            server.publish("/battery_state", "sensor_msgs/BatteryState", state(2.0))
            await until(lambda: battery.reading().facts["charge"] == pytest.approx(0.02))
            server.publish("/battery_state", "sensor_msgs/BatteryState", state(1.0))
            await until(lambda: battery.reading().facts["charge"] == pytest.approx(0.01))
            now.time += 40
            assert battery.reading().age == pytest.approx(40)
            await battery.close()

    def test_a_charge_in_percent_or_from_capacity_becomes_a_share(self) -> None:
        assert charge_of(state(43.0)) == pytest.approx(0.43)
        assert charge_of(state(None, charge=1.3)) == pytest.approx(0.5)
        with pytest.raises((ValueError, TypeError)):
            charge_of(state(None))

    @pytest.mark.parametrize(
        ("charge", "charging", "code"),
        [(0.5, False, ""), (0.15, False, "battery-low"), (0.15, True, ""),
         (0.05, False, "battery-flat"), (0.05, True, "")],
    )  # fmt: skip
    def test_a_low_and_a_flat_battery_are_separate_faults(
        self, charge: float, charging: bool, code: str
    ) -> None:
        book = load_faults(load_robot("turtlebot4"))
        evidence = {"battery.charge": charge, "battery.charging": charging}
        found = [one.rule.code for one in diagnose(book, evidence)]
        assert found == ([code] if code else [])

    def test_a_robot_without_a_battery_sensor_has_no_battery_faults(self) -> None:
        codes = {rule.code for rule in load_faults(load_robot()).rules}
        assert not codes & {"battery-low", "battery-flat"}


@pytest.mark.parametrize("name", ["turtlebot4", "pepper"])
class TestShipped:
    def test_each_of_its_drivers_opens_with_its_settings(
        self, name: str, activity: Activity
    ) -> None:
        robot = load_robot(name)
        wiring = Wiring(robot, activity, SteppedClock())
        for device, values in drivers_of(robot, {}).items():
            try:
                opened = open_device(wiring, device, values)
            except DeviceError as error:  # no voice on this machine
                assert device == "voice", error
            else:
                assert opened.name == device

    def test_a_shipped_robot_has_a_ros_camera_and_a_safe_maximum_speed(self, name: str) -> None:
        robot = load_robot(name)
        assert find_camera(robot.devices["camera"].source).live
        assert MotionLimits.of(robot).max_speed <= 0.306  # a Create 3 limits itself to this speed

    def test_a_shipped_robot_has_the_postures_of_the_activity(
        self, name: str, activity: Activity
    ) -> None:
        load_robot(name).check(activity)
