"""The lines of the robot process, and the answer to each of them."""

from __future__ import annotations

import asyncio
import json
import random
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, cast
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.device_protocols import STILL, MachineClock
from tangy_hw.navigation.navigator import Navigator
from tangy_hw.rate_estimator import FIRST
from tangy_hw.robot_client.robot_state import RobotState
from tangy_hw.robot_process import controller as robots
from tangy_hw.robot_process import process
from tangy_hw.robot_process.assembly import RobotRuntime
from tangy_hw.robot_process.control_loop import TICK
from tangy_hw.robot_process.controller import LiveRobot
from tangy_hw.robot_process.heartbeat import beat_of
from tangy_hw.robot_process.process import RobotProcess
from tangy_hw.robot_process.requests import IMMEDIATE_REQUESTS, LASTING_REQUESTS, Request
from tangy_profiles.health import ERROR
from tangy_profiles.process_log import PROGRAM_LOG, logging_to
from tangy_profiles.robot import load_robot
from tests.hw.live_bodies import HERE, ToldBody
from tests.hw.navigated import MAP
from tests.support.waiting import until


class Spoken:
    """A robot process inside the test: it takes lines, and `said` collects its answers."""

    def __init__(self) -> None:
        self.parts = ToldBody()
        navigator = Navigator(MAP, np.random.default_rng(1), HERE)
        self.robot = LiveRobot(load_robot(), self.parts.body(), navigator, MachineClock())
        self.said: list[dict[str, Any]] = []
        wired = RobotRuntime(self.robot, cast(Any, None), cast(Any, None))
        self.process = RobotProcess(wired, self.said.append, stepped=False)

    async def take(self, **line: Any) -> None:
        await self.process.take(json.dumps(line).encode())

    def state(self) -> RobotState:
        return RobotState.from_json(json.loads(json.dumps(beat_of(self.robot, 1))))


@asynccontextmanager
async def spoken() -> AsyncIterator[Spoken]:
    one = Spoken()
    await one.robot.start()
    try:
        yield one
    finally:
        await one.robot.close()


async def test_a_command_cancelled_before_its_start_is_answered() -> None:
    async with spoken() as one:
        await one.take(id=1, do="go", to=[1, 1, 0])
        await one.take(id=2, do="cancel", why="something is wrong")
        await until(lambda: len(one.said) == 2)
        answer = next(said for said in one.said if said["id"] == 1)
        assert (answer["failed"], answer["broken"]) == ("something is wrong", True)


async def test_a_cancelled_command_is_answered_once() -> None:
    async with spoken() as one:
        await one.take(id=1, do="wait", seconds=60)
        await until(lambda: one.robot.passing.waiting)
        await one.take(id=2, do="cancel", why="something is wrong")
        await until(lambda: len(one.said) == 2)
        assert sorted(said["id"] for said in one.said) == [1, 2]


async def test_a_stop_is_released_only_by_its_owner() -> None:
    async with spoken() as one:
        await one.take(do="stop", why="staff stopped it")
        await one.take(do="stop", why="base-runaway", by="fault")
        await one.take(do="release", by="fault")
        assert one.state().stopped == "staff stopped it"
        await one.take(do="stop", why="base-runaway", by="fault")
        await one.take(do="release")
        assert one.state().stopped == one.state().hazard == ""


async def test_a_hanging_program_cancels_every_command() -> None:
    with (
        patch.object(robots, "HAZARD_SECONDS", 0.1),
        patch.object(process, "SILENT_SECONDS", 0.3),
    ):
        async with spoken() as one:
            await one.take(id=1, do="perform", text="A long line", posture={"head": [0] * 6})
            await one.take(id=2, do="wait", seconds=60)
            await until(lambda: len(one.said) == 2)
            assert {said["failed"] for said in one.said} == {"the program says nothing"}
            assert {"hold", "hush"} <= set(one.parts.told)
            await one.take(beat=1)
            assert one.state().stopped == one.state().hazard == ""


async def test_the_state_reports_the_rates_that_are_measured() -> None:
    async with spoken() as one:
        assert {reading.rate for reading in one.state().health} == {None}
        await asyncio.sleep(FIRST + 0.1)
        rates = {reading.device: reading.rate for reading in one.state().health}
        assert rates["navigator"] is not None
        assert rates["navigator"] == pytest.approx(rates["localisation"], rel=0.02)
        assert 5 < rates["navigator"] <= 1 / TICK + 1
        assert rates["voice"] is None


async def test_a_failure_of_the_control_loop_is_reported_for_good() -> None:
    async with spoken() as one:
        assert one.state().failed == ""
        with patch.object(one.robot.navigator, "tick", side_effect=ZeroDivisionError):
            await until(lambda: one.robot.failed)
        await one.take(do="release")
        state = one.state()
        assert "ZeroDivisionError" in state.failed and state.hazard == state.failed


DEEP = b"[" * 100_000
WRONG = [
    b"",
    b"hello",
    b"[1, 2]",
    b'"go"',
    b"\xff\xfe",
    DEEP,
    b'{"do": ' + DEEP,
    b'{"id": [1], "do": "spin"}',
    b'{"id": {"a": 1}, "do": "wait", "seconds": 0}',
    b'{"id": null, "do": "spin"}',
    b'{"id": true, "do": "spin"}',
    b'{"id": 1.5, "do": "spin"}',
    b'{"do": "spin"}',
    b'{"id": 1, "do": ["go"]}',
    b'{"id": 1, "do": {"go": 1}}',
    b'{"id": 1}',
    b'{"id": 1, "do": "fly"}',
    b'{"id": 1, "do": "drive", "forward": "fast", "turn": 0}',
    b'{"id": 1, "do": "drive", "forward": 0.1}',
    b'{"do": "drive", "forward": NaN, "turn": 0}',
    b'{"do": "drive", "forward": 0.1, "turn": Infinity}',
    b'{"do": "drive", "forward": true, "turn": 0}',
    b'{"do": "drive", "forward": 1' + 400 * b"0" + b', "turn": 0}',
    b'{"id": 1, "do": "go", "to": ["a", 1, 0]}',
    b'{"id": 1, "do": "go", "to": [NaN, 1, 0]}',
    b'{"id": 1, "do": "go", "to": [1, 1]}',
    b'{"id": 1, "do": "go", "to": [1, 1, 0], "name": 5}',
    b'{"id": 1, "do": "place", "at": [1, Infinity, 0]}',
    b'{"id": 1, "do": "wait", "seconds": NaN}',
    b'{"id": 1, "do": "wait"}',
    b'{"id": 1, "do": "perform", "text": ["Hello"]}',
    b'{"id": 1, "do": "perform", "picture": 7}',
    b'{"id": 1, "do": "release", "by": ["staff"]}',
    b'{"id": 1, "do": "cancel", "why": 1}',
]


@pytest.mark.parametrize("line", WRONG, ids=lambda line: line[:40].decode("latin-1"))
async def test_an_invalid_line_is_answered_with_an_error(line: bytes) -> None:
    async with spoken() as one:
        await one.process.take(line)
        await until(lambda: one.said)
        (answer,) = one.said
        assert answer["failed"].endswith(".") and "done" not in answer
        assert answer.get("id", 1) == 1
        json.dumps(answer)
        one.said.clear()
        await one.take(id=2, do="wait", seconds=0)
        await until(lambda: one.said)
        assert one.said[0]["id"] == 2 and "done" in one.said[0]
        assert one.robot.failed == ""


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner),
    max_leaves=6,
)
DOES = ("stop", "release", "cancel", "drive", "go", "wait", "place", "perform", "answered", "fail")
KEYS = ("id", "why", "by", "forward", "turn", "to", "at", "seconds", "text", "picture", "device")


@pytest.mark.slow
@given(
    do=st.sampled_from(DOES) | JSON,
    what=st.dictionaries(st.sampled_from(KEYS), JSON),
)
async def test_no_content_of_a_line_ends_the_process(do: Any, what: dict[str, Any]) -> None:
    async with spoken() as one:
        await one.take(**{**what, "do": do})
        await one.take(id="last", do="stop")
        await until(lambda: any(said.get("id") == "last" for said in one.said))
        assert one.robot.failed == "" and one.robot.stopped


@pytest.mark.parametrize("id", [[1], None, {"a": 1}])
async def test_a_stop_takes_effect_despite_other_errors_in_its_line(id: Any) -> None:
    async with spoken() as one:
        await one.take(id=id, do="stop", why=["a hand"], by=3)
        assert one.state().stopped == "stopped" and one.parts.told[0] == "stop"
        assert "failed" in one.said[0]
        await one.take(do="release", by="staff")
        assert one.state().stopped == ""


async def test_a_second_line_with_a_running_id_is_refused() -> None:
    async with spoken() as one:
        await one.take(id=1, do="wait", seconds=60)
        await one.take(id=1, do="wait", seconds=0)
        assert "id of its own" in one.said[0]["failed"]
        await one.take(id=2, do="cancel", why="enough")
        await until(lambda: len(one.said) == 3)
        assert [said.get("failed") for said in one.said if said["id"] == 1][1] == "enough"


async def test_the_id_of_a_command_goes_from_its_line_to_the_driver_and_back(
    tmp_path: Path,
) -> None:
    with logging_to(tmp_path):
        async with spoken() as one:
            await one.take(id=1, do="relax", command="c0ffee42")
            await until(lambda: any(said.get("id") == 1 for said in one.said))
    logged = (tmp_path / PROGRAM_LOG).read_text(encoding="utf-8").splitlines()
    served = [line.partition(" [c0ffee42] ")[2] for line in logged if "[c0ffee42]" in line]
    assert served == ["begins relax", "has done relax"]


@pytest.mark.parametrize("asked", (*IMMEDIATE_REQUESTS, *LASTING_REQUESTS))
async def test_the_process_knows_every_request(asked: Request) -> None:
    async with spoken() as one:
        await one.take(id=1, do=asked)
        await until(lambda: bool(one.said))
        assert "cannot do" not in json.dumps(one.said)


async def test_an_unknown_device_state_is_an_error() -> None:
    async with spoken() as one:
        await one.take(id=1, do="fail", device="laser", state="FINE")
        await until(lambda: bool(one.said))
        assert one.said[0]["failed"] == "There is no state 'FINE' of a device."
        beat = json.loads(json.dumps(beat_of(one.robot, 1)))
        beat["health"][0][2] = "BETTER THAN EVER"
        assert RobotState.from_json(beat).health[0].state == ERROR


def fuzzed(rng: random.Random) -> bytes:
    """Return an invalid line, or a merely odd one."""
    line = bytearray(rng.choice([*WRONG, *(json.dumps({"id": rng.randrange(9), "do": do}).encode()
                                           for do in DOES)])[:300])  # fmt: skip
    for _ in range(rng.randrange(6)):
        at = rng.randrange(len(line) + 1)
        match rng.randrange(3):
            case 0:
                line[at:at] = bytes([rng.randrange(256)])
            case 1:
                del line[at : at + rng.randrange(5)]
            case _:
                line[at : at + 1] = rng.choice(list(JSON_PARTS))
    return bytes(line).replace(b"\n", b" ")


JSON_PARTS = (b"{", b"}", b"[", b"]", b'"', b":", b",", b"NaN", b"1e999", b"null", b"\x00", b"\xff")


@pytest.mark.slow
async def test_ten_thousand_invalid_lines_neither_end_the_process_nor_drive() -> None:
    rng = random.Random(5)
    async with spoken() as one:
        for number in range(10_000):
            await one.process.take(fuzzed(rng))
            if number % 500 == 499:
                one.said.clear()
                await one.take(id="check", do="stop", by="staff")
                await until(lambda: any(said.get("id") == "check" for said in one.said))
                assert one.robot.failed == "" and one.robot.stopped
                one.robot.tick()
                assert one.robot.wheels.driven == STILL
                await one.take(do="release", by="staff")
