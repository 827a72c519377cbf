"""Time passes for a robot in ticks; on a stepped bench it passes only while a task waits for it."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_process.control_loop import AT_REST, ON_THE_WAY, TICK, ControlLoop

TURNS = 50
"""Turns of the loop in which a running clock would have advanced far."""


class HandClock:
    """A clock that each sleep advances; while it is held, no sleep ends."""

    def __init__(self) -> None:
        self.time = 0.0
        self.slept: list[float] = []
        self.free = asyncio.Event()
        self.free.set()

    def now(self) -> float:
        return self.time

    async def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.time += seconds
        await self.free.wait()
        await asyncio.sleep(0)


@asynccontextmanager
async def passing(time: ControlLoop) -> AsyncIterator[None]:
    task = asyncio.create_task(time.run())
    try:
        yield
    finally:
        task.cancel()
        await asyncio.wait([task])


async def turns() -> None:
    for _ in range(TURNS):
        await asyncio.sleep(0)


async def test_time_stands_still_without_waiters() -> None:
    clock = HandClock()
    time = ControlLoop(clock, lambda: False, stepped=True)
    async with passing(time):
        await turns()
        assert clock.slept == []
        await time.sleep(1.0)
        slept = len(clock.slept)
        await turns()
        assert len(clock.slept) == slept
        assert clock.time == pytest.approx(1.0, abs=AT_REST) and clock.time >= 1.0


async def test_time_stands_still_again_after_the_waiter_is_cancelled() -> None:
    clock = HandClock()
    time = ControlLoop(clock, lambda: False, stepped=True)
    async with passing(time):
        waits = asyncio.create_task(time.sleep(1e9))
        await turns()
        assert clock.slept
        waits.cancel()
        await asyncio.wait([waits])
        await turns()
        slept = len(clock.slept)
        await turns()
        assert len(clock.slept) == slept


async def test_a_wait_ends_when_its_condition_holds() -> None:
    clock = HandClock()
    time = ControlLoop(clock, lambda: True, stepped=True)
    async with passing(time):
        assert await time.until(lambda: clock.time > 3, 100)
        assert 3 < clock.time < 3 + 2 * ON_THE_WAY
        began = clock.time
        assert not await time.until(lambda: False, 1)
        assert clock.time == pytest.approx(began + 1, abs=1.01 * ON_THE_WAY)


async def test_a_condition_that_already_holds_takes_no_time() -> None:
    clock = HandClock()
    time = ControlLoop(clock, lambda: True, stepped=True)
    async with passing(time):
        assert await time.until(lambda: True, 100)
    assert clock.slept == []


async def test_steps_are_small_while_the_robot_moves_and_larger_at_rest() -> None:
    clock, moves = HandClock(), [True]
    time = ControlLoop(clock, lambda: moves[0], stepped=True)
    async with passing(time):
        await time.sleep(1.0)
        assert set(clock.slept[1:]) == {ON_THE_WAY}
        moves[0] = False
        clock.slept.clear()
        await time.sleep(1.0)
        assert clock.slept[1:] and set(clock.slept[1:]) == {AT_REST}


async def test_two_waiters_share_the_time() -> None:
    clock, woke = HandClock(), {}
    time = ControlLoop(clock, lambda: False, stepped=True)

    async def sleeper(seconds: float) -> None:
        await time.sleep(seconds)
        woke[seconds] = clock.time

    async with passing(time):
        await asyncio.gather(sleeper(2.0), sleeper(1.0))
    assert woke == pytest.approx({1.0: 1.0, 2.0: 2.0}, abs=AT_REST)


async def test_a_repeated_short_wait_sees_every_step_of_a_longer_one() -> None:
    clock, seen = HandClock(), []
    time = ControlLoop(clock, lambda: True, stepped=True)

    async def looks() -> None:
        while clock.time < 5:
            await time.sleep(ON_THE_WAY / 2)
            seen.append(clock.time)

    async with passing(time):
        await asyncio.gather(time.sleep(5.0), looks())
    ends = [sum(clock.slept[: n + 1]) for n in range(len(clock.slept))]
    assert seen == pytest.approx(ends[: len(seen)]) and len(seen) >= 5 / ON_THE_WAY


async def test_no_waiter_observes_half_a_step() -> None:
    clock, ticks = HandClock(), []

    def tick() -> bool:
        ticks.append(clock.time)
        return False

    time = ControlLoop(clock, tick, stepped=True)
    async with passing(time):
        clock.free.clear()
        waits = asyncio.create_task(time.sleep(TICK / 2))
        await turns()
        looks = asyncio.create_task(time.still.acquire())
        await turns()
        assert clock.slept and not looks.done()  # the step has begun, and is not over
        clock.free.set()
        await looks
        await turns()
        assert waits.done() and len(clock.slept) == len(ticks)


async def test_ticks_on_a_machine_clock_need_no_waiter() -> None:
    clock, ticks = HandClock(), asyncio.Event()

    def tick() -> bool:
        if clock.time > 1:
            ticks.set()
        return True

    time = ControlLoop(clock, tick)
    async with passing(time), asyncio.timeout(5):
        await ticks.wait()
        assert not time.still.locked()  # there, looking waits for nothing
    assert set(clock.slept) == {TICK}


@pytest.mark.parametrize("stepped", [True, False])
async def test_a_waiter_gets_an_error_when_time_ends(stepped: bool) -> None:
    clock = HandClock()

    def tick() -> bool:
        if clock.time > 1:
            raise OSError("the base is gone")
        return False

    time = ControlLoop(clock, tick, stepped=stepped)
    async with passing(time), asyncio.timeout(5):
        with pytest.raises(DeviceError, match=r"time stands still .*the base is gone"):
            await time.sleep(100)
        with pytest.raises(DeviceError, match=r"time stands still .*the base is gone"):
            await time.sleep(1)  # and later waits end, too


async def test_a_cancelled_waiter_logs_no_error_when_time_ends() -> None:
    clock = HandClock()
    clock.free.clear()
    told: list[str] = []
    loop = asyncio.get_running_loop()
    loop.set_exception_handler(lambda _, context: told.append(str(context["message"])))
    time = ControlLoop(clock, lambda: False)
    async with passing(time):
        waiting = asyncio.create_task(time.sleep(100))
        await turns()
        waiting.cancel()
        await asyncio.wait([waiting])
    del time, waiting
    gc.collect()
    assert told == []
