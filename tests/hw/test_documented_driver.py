"""The driver that docs/robots.md shows works as it is written."""

from __future__ import annotations

import asyncio
import re
from pathlib import Path
from typing import Any

import pytest

from tangy_hw.device_protocols import MachineClock
from tangy_hw.drivers import registry
from tangy_hw.drivers.registry import Wiring, open_device
from tangy_hw.robot_process.driver_checks import scan_problem
from tangy_profiles.activity import load_activity
from tangy_profiles.robot import load_robot
from tests.hw.waiting import until

PAGE = Path(__file__).parents[2] / "docs" / "robots.md"


async def test_the_driver_in_the_docs_reads_a_scanner(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = re.search(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert shown is not None
    names: dict[str, Any] = {}
    exec(shown[1], names)  # noqa: S102 - the example for authors
    monkeypatch.setattr(registry, "DRIVERS", {"valet": names["KIND"]})

    async def scanner(_: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        writer.write(b"0 " + b"2.5 " * 180 + b"\n")
        await writer.drain()

    server = await asyncio.start_server(scanner, "127.0.0.1", 0)
    at = f"tcp://127.0.0.1:{server.sockets[0].getsockname()[1]}"
    wiring = Wiring(load_robot(), load_activity("bingo"), MachineClock())
    laser: Any = open_device(wiring, "laser", {"kind": "valet", "at": at})
    await laser.start()
    await until(lambda: laser.scan is not None)
    assert scan_problem(laser.scan, wiring.clock.now()) == ""
    assert len(laser.scan.value.ranges) == 181
    assert laser.reading().age < 60
    await laser.close()
    server.close()
