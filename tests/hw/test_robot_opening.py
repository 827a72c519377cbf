"""The opening of a robot is abandoned as soon as the program ends."""

from __future__ import annotations

import asyncio
import signal
from typing import Any, cast

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_process import startup
from tangy_hw.robot_process.assembly import RobotRuntime
from tangy_hw.robot_process.startup import switched_on


class Slow:
    """A robot whose devices answer when the test allows it."""

    def __init__(self, error: DeviceError | None = None) -> None:
        self.answers = asyncio.Event()
        self.did: list[str] = []
        self._error = error

    async def __aenter__(self) -> Slow:
        self.did.append("begins")
        try:
            await self.answers.wait()
            if self._error is not None:
                raise self._error
        except BaseException:
            self.did.append("is let go of")
            raise
        self.did.append("is on")
        return self

    async def __aexit__(self, *_: object) -> None:
        self.did.append("is switched off")


@pytest.fixture
def armed(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """The seconds until the process is ended anyway."""
    seconds: list[float] = []

    class Signal:
        ITIMER_REAL = signal.ITIMER_REAL

        @staticmethod
        def setitimer(which: int, after: float) -> None:
            assert which == signal.ITIMER_REAL
            seconds.append(after)

    monkeypatch.setattr(startup, "signal", Signal)
    return seconds


def lines(*said: bytes, end: bool = False) -> asyncio.StreamReader:
    reader = asyncio.StreamReader()
    for line in said:
        reader.feed_data(line + b"\n")
    if end:
        reader.feed_eof()
    return reader


def opening(robot: Slow, said: asyncio.StreamReader) -> Any:
    return switched_on(cast(RobotRuntime, robot), said)


async def test_no_robot_is_opened_for_a_program_that_has_ended(armed: list[float]) -> None:
    robot = Slow()
    async with asyncio.timeout(5), opening(robot, lines(b'{"beat":1}', end=True)) as said:
        assert said is None
    assert robot.did in ([], ["begins", "is let go of"])
    assert armed == [startup.GIVE_UP_SECONDS]


async def test_an_opening_is_abandoned_if_the_program_ends(armed: list[float]) -> None:
    robot, pipe = Slow(), lines(b'{"beat":1}')
    asyncio.get_running_loop().call_later(0.02, pipe.feed_eof)
    async with asyncio.timeout(5), opening(robot, pipe) as said:
        assert said is None
    assert robot.did == ["begins", "is let go of"]
    assert len(armed) == 1


async def test_a_robot_that_opens_as_the_program_ends_is_closed(
    armed: list[float],
) -> None:
    robot, pipe = Slow(), lines()
    both = asyncio.get_running_loop()
    both.call_later(0.02, robot.answers.set)
    both.call_later(0.02, pipe.feed_eof)
    async with asyncio.timeout(5), opening(robot, pipe):
        pass
    assert robot.did[-1] in ("is let go of", "is switched off")


async def test_lines_sent_during_the_opening_are_kept(armed: list[float]) -> None:
    stop = b'{"do":"stop","why":"staff"}'
    robot, pipe = Slow(), lines(b'{"beat":1}', stop, b'{"beat":2}')
    asyncio.get_running_loop().call_later(0.02, robot.answers.set)
    async with asyncio.timeout(5), opening(robot, pipe) as said:
        assert said == [stop + b"\n"]
        pipe.feed_data(b"next\n")
        assert await pipe.readline() == b"next\n"
        assert robot.did == ["begins", "is on"]
    assert robot.did == ["begins", "is on", "is switched off"]
    assert armed == []


async def test_a_device_error_during_the_opening_is_raised(armed: list[float]) -> None:
    robot = Slow(DeviceError("The arms have no cable."))
    robot.answers.set()
    with pytest.raises(DeviceError, match="no cable"):
        async with asyncio.timeout(5), opening(robot, lines()):
            pass
