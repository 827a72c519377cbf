"""Time passes for a robot in ticks; on a bench in a hurry only while somebody waits for it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import pytest

from tangy_hw.passing_time import AT_REST, ON_THE_WAY, TICK, PassingTime


class HandClock:
    """A clock that whoever sleeps on it turns."""

    def __init__(self) -> None:
        self.time = 0.0
        self.slept: list[float] = []

    def now(self) -> float:
        return self.time

    async def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.time += seconds
        await asyncio.sleep(0)


@asynccontextmanager
async def passing(time: PassingTime) -> AsyncIterator[None]:
    task = asyncio.create_task(time.run())
    try:
        yield
    finally:
        task.cancel()
        await asyncio.wait([task])


async def test_time_stands_still_while_nobody_waits_for_it() -> None:
    clock = HandClock()
    time = PassingTime(clock, lambda: False, stepped=True)
    async with passing(time):
        await asyncio.sleep(0.02)
        assert clock.time == 0
        await time.sleep(1.0)
        now = clock.time
        await asyncio.sleep(0.02)
        assert now == clock.time == pytest.approx(1.0, abs=AT_REST)


async def test_what_is_waited_for_ends_the_wait() -> None:
    clock = HandClock()
    time = PassingTime(clock, lambda: True, stepped=True)
    async with passing(time):
        assert await time.until(lambda: clock.time > 3, 100)
        assert clock.time < 3 + 2 * ON_THE_WAY
        assert not await time.until(lambda: False, 1)


async def test_steps_are_small_while_the_robot_moves_and_larger_at_rest() -> None:
    clock, moves = HandClock(), [True]
    time = PassingTime(clock, lambda: moves[0], stepped=True)
    async with passing(time):
        await time.sleep(1.0)
        assert set(clock.slept[1:]) == {ON_THE_WAY}
        moves[0] = False
        clock.slept.clear()
        await time.sleep(1.0)
        assert clock.slept[1:] and set(clock.slept[1:]) == {AT_REST}


async def test_two_who_wait_share_the_time() -> None:
    clock = HandClock()
    time = PassingTime(clock, lambda: False, stepped=True)
    async with passing(time):
        await asyncio.gather(time.sleep(2.0), time.sleep(1.0))
    assert clock.time == pytest.approx(2.0, abs=2 * AT_REST)


async def test_on_the_clock_of_a_machine_ticks_come_by_themselves() -> None:
    clock, ticks = HandClock(), asyncio.Event()

    def tick() -> bool:
        ticks.set()
        return False

    async with passing(PassingTime(clock, tick)), asyncio.timeout(5):
        await ticks.wait()
    assert set(clock.slept) == {TICK}
