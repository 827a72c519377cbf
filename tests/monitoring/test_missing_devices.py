"""A device that a robot lacks is no fault, and staff are not sent to check it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.errors import ProfileError
from tangy_profiles.fault_file import load_faults
from tangy_profiles.health import ERROR, OK, STALE, DeviceState, Health, Reading
from tangy_profiles.known_devices import (
    TOLD_MISSING,
    driven,
    known_devices,
    missing_devices,
    reads_cards,
)
from tangy_profiles.robot import Robot, load_robot
from tangy_sim.worlds.devices import WELL
from tangy_tui.app.fault_commands import possible_kinds
from tangy_tui.monitoring.detection import device_evidence
from tangy_tui.monitoring.diagnosis import diagnose
from tests.support.robots import SHIPPED, robot_without

LACKED = [*TOLD_MISSING, "localisation", "navigator", "battery", "laser"]


def codes(robot: Robot, health: Health) -> list[str]:
    return [one.rule.code for one in diagnose(load_faults(robot), device_evidence(robot, health))]


def failing(device: str, state: DeviceState = ERROR) -> Health:
    return tuple(r._replace(state=state) if r.device == device else r for r in WELL)


@pytest.mark.parametrize("device", LACKED)
def test_rules_of_a_missing_device_are_dropped(tmp_path: Path, device: str) -> None:
    robot = load_robot(str(robot_without(tmp_path, device)))
    book = load_faults(robot)
    keys = {key for rule in book.rules for key in rule.symptoms}
    assert not [key for key in keys if key.startswith(f"{device}.")]
    assert all(rule.device != device for rule in book.rules)
    assert book.fallback.fallback
    assert codes(robot, WELL) == []


@pytest.mark.parametrize(
    ("state", "code", "says"),
    [(STALE, "laser-disconnected", "sends nothing"), (ERROR, "laser-unusable", "cannot use")],
)
def test_a_scanner_that_sends_what_cannot_be_used_is_not_silent(
    state: DeviceState, code: str, says: str
) -> None:
    assert codes(load_robot(), failing("laser", state)) == [code]
    assert says in load_faults(load_robot()).rule(code).console


@pytest.mark.parametrize("name", SHIPPED)
def test_the_rules_load_for_every_robot_that_ships(name: str) -> None:
    assert load_faults(load_robot(name)).rules[-1].fallback


@pytest.mark.parametrize("device", TOLD_MISSING)
@pytest.mark.parametrize("state", [ERROR, STALE])
def test_a_report_about_a_missing_device_is_no_fault(
    tmp_path: Path, device: str, state: DeviceState
) -> None:
    assert codes(load_robot(), failing(device, state)) != []
    assert codes(load_robot(str(robot_without(tmp_path, device))), failing(device, state)) == []


def test_a_robot_without_a_voice_is_mute_if_its_screen_fails(tmp_path: Path) -> None:
    robot = load_robot(str(robot_without(tmp_path, "voice")))
    assert codes(load_robot(), failing("screen")) == ["screen-dead"]
    assert codes(robot, failing("screen")) == ["mute"]
    assert load_faults(robot).rule("mute").device == "screen"


def test_an_unmeasured_fact_drops_only_its_own_rules(
    tmp_path: Path,
) -> None:
    text = load_robot().file.read_text(encoding="utf-8")
    line = next(one for one in text.splitlines() if one.startswith("facts.brightness"))
    path = tmp_path / "dim.toml"
    path.write_text(text.replace(line, ""), encoding="utf-8")
    robot = load_robot(str(path))
    assert codes(robot, failing("camera", STALE)) == ["camera-disconnected"]


@pytest.mark.parametrize(
    ("right", "wrong", "told"),
    [
        ('also = ["mismatch.robot\'s place", "base.still"]', 'also = ["camra.state"]', "camera"),
        ('needs = "battery"', 'needs = "batery"', "battery"),
        ('"camera.state" = { is = "STALE" }', '"camera.state" = { is = "STALEY" }', "STALE"),
    ],
)
def test_a_misspelt_device_in_the_rules_is_refused(
    tmp_path: Path, right: str, wrong: str, told: str
) -> None:
    import tangy_profiles

    text = (Path(tangy_profiles.__path__[0]) / "faults.toml").read_text(encoding="utf-8")
    assert right in text
    mine = tmp_path / "mine.toml"
    mine.write_text(text.replace(right, wrong, 1), encoding="utf-8")
    robot = load_robot(str(robot_without(tmp_path, "camera")))
    with pytest.raises(ProfileError, match=f"did you mean '{told}"):
        load_faults(robot, mine)


def test_devices_without_a_driver_are_left_out_and_listed() -> None:
    robot = load_robot("turtlebot4")
    there = driven(robot)
    assert missing_devices(there) == ("stop_button", "requests", "arms")
    assert {"camera", "battery", "voice", "localisation"} <= there.devices.keys()
    assert missing_devices(driven(there)) == missing_devices(there)
    assert missing_devices(driven(robot, ["requests"])) == ("stop_button", "arms")


def test_an_extra_device_without_a_driver_is_reported(tmp_path: Path) -> None:
    path = robot_without(tmp_path)
    lamp = '[[devices]]\nname = "lamp"\nlabel = "lamp"\nstale_after = 1\n'
    path.write_text(
        path.read_text(encoding="utf-8").replace("[[devices]]", lamp + "[[devices]]", 1),
        encoding="utf-8",
    )
    robot = driven(load_robot(str(path)))
    assert missing_devices(robot)[-1] == "lamp"
    assert codes(robot, (*WELL, Reading("lamp", state=ERROR))) == []


def test_only_a_robot_with_a_card_camera_reads_cards(tmp_path: Path) -> None:
    assert reads_cards(load_robot())
    assert not reads_cards(load_robot(str(robot_without(tmp_path, "camera"))))
    assert not reads_cards(driven(load_robot()))


def test_faults_of_missing_devices_cannot_be_injected(tmp_path: Path) -> None:
    robot = load_robot(str(robot_without(tmp_path, "camera")))
    kinds = possible_kinds(rule.code for rule in load_faults(robot).rules)
    assert not [kind for kind in kinds if kind.startswith("camera")]
    assert {"laser-occluded", "never-complies", "voice-dead"} <= set(kinds)


def test_every_reported_device_is_known() -> None:
    assert set(TOLD_MISSING) <= known_devices().keys()
    assert all(known_devices()[name].label for name in TOLD_MISSING)
    assert all(reading.state == OK for reading in WELL)
