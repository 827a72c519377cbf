"""Tests a robot's devices in a process of its own, so that no driver can hold up the program.

A driver of another package may block, or end its process. It is named then, and another process
tries the other devices. The process, `python -m tangy_hw.robot_process.isolated_test`, speaks JSON
lines:

    {"robot": "tangy.toml", "activity": "bingo", "failed": {...}, ...}   what to try, and what not
    {"calls": "laser", "step": "start"}                                 a driver is called now
    {"found": [{"device": "laser", "ok": true, "text": "...", ...}]}    the results

The program sends the first line, and the process the others. It exits if its input closes.
"""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from queue import Empty, SimpleQueue
from types import MappingProxyType
from typing import Any, NoReturn

from tangy_hw.device_protocols import DeviceError, hangs
from tangy_hw.drivers.camera_source import CameraSource
from tangy_hw.perception.camera_hub import Sources
from tangy_hw.robot_process.driver_checks import START_SECONDS
from tangy_hw.robot_process.self_test import (
    CLOSE_SECONDS,
    CLOSES,
    READS,
    SECONDS,
    STARTS,
    SelfTestResult,
    try_robot,
)
from tangy_hw.worker_process import WorkerError, WorkerProcess
from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.process_log import log_to_stderr
from tangy_profiles.robot import Robot, load_robot
from tangy_profiles.worker_lines import AnswerWriter, Asked, requests

CHILD = (sys.executable, "-P", "-m", "tangy_hw.robot_process.isolated_test")
LOAD_SECONDS = 60.0  # until the process has loaded its modules
PATIENCE = START_SECONDS + 2.0  # the process itself notices drivers that only wait
DONE = {STARTS: "started", READS: "answered", CLOSES: "closed"}


def try_robot_apart(
    robot: Robot,
    activity: Activity,
    cameras: Sources,
    seconds: float = SECONDS,
    *,
    pairing: Mapping[str, str] = MappingProxyType({}),
    patience: float = PATIENCE,
    command: Sequence[str] = CHILD,
) -> list[SelfTestResult]:
    """Do as `try_robot` does, also if a driver blocks or ends its process.

    Args:
        robot: the robot's profile.
        activity: the activity that it is for.
        cameras: sources of its cameras, by device.
        seconds: timeout for a device that sends nothing.
        pairing: secrets of paired tablets, as in `RobotSetup`.
        patience: s after which a driver blocks.
        command: the command line of the process.

    Raises:
        DeviceError: the process does not work.
    """
    failed: dict[str, str] = {}
    while True:
        asked = {
            "robot": str(robot.file),
            "activity": activity.file or activity.name,
            "cameras": {name: asdict(source) for name, source in cameras.items()},
            "seconds": seconds,
            "pairing": dict(pairing),
            "failed": failed,
        }
        found, device, why = _once(asked, patience, command)
        if found is not None:
            return found
        if not device or device in failed:
            raise DeviceError(f"The devices could not be tried: {why}")
        failed[device] = why


def _once(
    asked: Mapping[str, Any], patience: float, command: Sequence[str]
) -> tuple[list[SelfTestResult] | None, str, str]:
    """Return the results; or None, the device whose driver was called last, and what it did."""
    heard: SimpleQueue[Mapping[str, Any] | str] = SimpleQueue()
    try:
        worker = WorkerProcess(
            command, hear=lambda said, _: heard.put(said), ended=heard.put, stderr=None
        )
    except WorkerError as error:
        return None, "", f"no process can be started ({error})."
    worker.tell(asked)
    device, step, wait = "", STARTS, LOAD_SECONDS
    try:
        while True:
            match heard.get(timeout=wait):
                case {"calls": str(device), "step": str(step)}:
                    wait = patience
                case {"found": list(found)}:
                    return [SelfTestResult(**one) for one in found], "", ""
                case str(how):
                    return None, device, f"its driver ended the process that tried it ({how})."
    except Empty:
        worker.kill()
        return None, device, hangs(wait, DONE.get(step, step))
    finally:
        worker.stop(CLOSE_SECONDS)


def _end_with_input() -> None:
    """Close the devices, as for Ctrl-C, when the program is gone."""
    for _ in requests(lambda why: None):
        pass
    os.kill(os.getpid(), signal.SIGINT)


async def _run(asked: Asked, out: AnswerWriter) -> NoReturn:
    found = await try_robot(
        load_robot(asked["robot"]),
        load_activity(asked["activity"]),
        {name: CameraSource(**source) for name, source in asked["cameras"].items()},
        asked["seconds"],
        pairing=asked["pairing"],
        failed=asked["failed"],
        calls=lambda device, step: out.write({"calls": device, "step": step}),
    )
    out.write({"found": [asdict(one) for one in found]})
    os._exit(0)  # a driver may have left threads that never end


def main() -> None:
    """Try the devices that the first line names, and exit."""
    log_to_stderr()
    out = AnswerWriter()
    asked = next(requests(out.refuse))
    threading.Thread(target=_end_with_input, daemon=True).start()
    with suppress(KeyboardInterrupt):
        asyncio.run(_run(asked, out))
    os._exit(1)


if __name__ == "__main__":
    main()
