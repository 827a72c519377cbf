"""A driver that blocks or ends its process is named, and the other devices are tried."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict
from pathlib import Path

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.camera_source import CameraSource
from tangy_hw.robot_process.isolated_test import try_robot_apart
from tangy_profiles.activity import load_activity
from tangy_profiles.robot import Robot, load_robot

DRIVERS = Path(__file__).with_name("blocking_drivers.py")
TOLD = """
import json, sys
asked = sys.stdin.readline()
print(json.dumps({"calls": "gripper", "step": "start"}), flush=True)
if not json.loads(asked)["failed"]:
    sys.exit(7)
print(json.dumps({"found": [{"device": "gripper", "ok": True, "text": asked}]}), flush=True)
"""
GRIPPER = """
[[devices]]
name = "gripper"
label = "gripper"
stale_after = 5
"""


def robot_in(folder: Path) -> Robot:
    path = folder / "mine.toml"
    shipped = load_robot("turtlebot4").file.read_text(encoding="utf-8")
    before, _, after = shipped.partition("[drivers]\n")
    drivers = '[drivers]\ngripper = { kind = "blocks" }\nbattery = { kind = "works" }\n'
    path.write_text(before + drivers + after[after.index("\n[[devices]]") :] + GRIPPER)
    return load_robot(str(path))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("step", "says"),
    [
        ("open", "its driver has not started within 1.5 s."),
        ("start", "its driver has not started within 1.5 s."),
        ("read", "its driver has not answered within 1.5 s."),
        ("close", "its driver has not closed within 1.5 s."),
        ("exit", "its driver ended the process that tried it (status 7)."),
        ("thread", "blocks works"),
    ],
)
def test_a_driver_that_blocks_is_named_and_the_others_are_tried(
    step: str, says: str, tmp_path: Path
) -> None:
    tried = try_robot_apart(
        robot_in(tmp_path),
        load_activity("bingo"),
        {},
        0.2,
        patience=1.5,
        command=(sys.executable, str(DRIVERS), step),
    )
    found = {one.device: one for one in tried}
    assert found["gripper"].text.startswith(says)
    assert found["gripper"].ok is (step == "thread")
    assert found["battery"].ok and found["battery"].text.startswith("works works")


def test_a_process_that_cannot_start_is_told() -> None:
    with pytest.raises(DeviceError, match="could not be tried: no process can be started"):
        try_robot_apart(load_robot(), load_activity("bingo"), {}, command=("/no/such/program",))


def test_the_process_is_told_what_to_try_and_which_driver_failed() -> None:
    source = CameraSource("head_camera", "stream", "http://10.0.0.7/")
    (found,) = try_robot_apart(
        load_robot(),
        load_activity("trivia"),
        {"head_camera": source},
        0.3,
        pairing={"chest": "secret"},
        command=(sys.executable, "-S", "-c", TOLD),
    )
    told = json.loads(found.text)
    assert told["robot"] == str(load_robot().file) and "trivia" in told["activity"]
    assert told["cameras"] == {"head_camera": asdict(source)} and told["seconds"] == 0.3
    assert told["pairing"] == {"chest": "secret"}
    assert told["failed"]["gripper"].endswith("ended the process that tried it (status 7).")
