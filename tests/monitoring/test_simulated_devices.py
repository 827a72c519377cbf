"""Every robot's devices are simulated, so that its games do not halt for want of readings."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.fault_file import load_faults
from tangy_profiles.health import OK
from tangy_profiles.robot import Robot, load_robot
from tangy_sim.worlds.devices import READINGS, readings, well
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.simulated_worlds import game_world
from tangy_tui.app.workspace import Workspace
from tangy_tui.monitoring.detection import device_evidence
from tangy_tui.monitoring.diagnosis import diagnose
from tests.support.declared import declared
from tests.support.robots import SHIPPED, robot_without

RADIO = '\n[[devices]]\nname = "radio"\nlabel = "radio"\nstale_after = 0.05\n'


def with_a_radio(folder: Path) -> Robot:
    return load_robot(str(robot_without(folder, drivers=RADIO)))


@pytest.mark.parametrize("name", SHIPPED)
def test_no_simulated_device_of_a_shipped_robot_looks_faulty(name: str) -> None:
    robot = load_robot(name)
    seen = device_evidence(robot, well(robot))
    assert {device: seen[f"{device}.state"] for device in robot.devices} == dict.fromkeys(
        robot.devices, OK
    )
    assert diagnose(load_faults(robot), seen) == []


@pytest.mark.parametrize("name", SHIPPED)
def test_every_simulated_device_of_a_shipped_robot_measures_all_its_facts(name: str) -> None:
    robot = load_robot(name)
    for reading in well(robot):
        assert set(reading.facts) == set(robot.devices[reading.device].facts), reading.device


def test_a_device_that_nothing_simulates_works(tmp_path: Path) -> None:
    robot = with_a_radio(tmp_path)
    assert "radio" not in READINGS
    assert device_evidence(robot, well(robot))["radio.state"] == OK


@pytest.mark.parametrize("name", SHIPPED)
@pytest.mark.parametrize("injected", [(), None, ("laser-occluded",)])
def test_the_worlds_of_a_robot_have_its_devices(
    workspace: Workspace, name: str, injected: tuple[str, ...] | None
) -> None:
    robot = load_robot(name)
    faults = None if injected is None else ()
    world = game_world(workspace.activity, ["user1"], 1, faults, robot=robot)
    assert [reading.device for reading in world.health()] == list(robot.devices)


def test_the_world_of_an_activity_by_facts_has_the_robots_devices() -> None:
    robot = load_robot("turtlebot4")
    world = game_world(declared("trivia"), ["user1"], 1, None, robot=robot)
    assert "battery" in {reading.device for reading in world.health()}


def test_a_fault_of_a_device_that_the_robot_lacks_changes_nothing(tmp_path: Path) -> None:
    robot = load_robot(str(robot_without(tmp_path, "camera")))
    symptom = KINDS["camera-occluded"].symptom
    assert symptom is not None
    assert readings([(symptom, 5.0)], well(robot)) == well(robot)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHIPPED)
def test_a_simulated_game_of_every_shipped_robot_reaches_its_end(
    tangy: Callable[..., CompletedProcess[str]], taught: Path, name: str
) -> None:
    done = tangy("play", "--headless", "--json", "--seed", 3, "--robot", name, "--data", taught)
    told = json.loads(done.stdout)
    assert (told["finished"], told["faults"]) == (1, [])
