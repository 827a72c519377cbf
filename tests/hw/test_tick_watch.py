"""A robot whose control was frozen cancels its command, and stops until staff release it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import pytest

from tangy_hw.robot_process import controller
from tangy_hw.robot_process.stop_latch import FAULT, STAFF
from tangy_hw.robot_process.tick_watchdog import LATE_SECONDS, TickWatch, time_awake_and_asleep
from tangy_profiles.health import ERROR, OK
from tests.hw.test_robot_lines import Spoken, spoken
from tests.support.waiting import until


class Asleep:
    """A clock that can jump."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class TestTickWatch:
    def test_slightly_late_ticks_are_no_freeze(self) -> None:
        clock = Asleep()
        watch = TickWatch(clock)
        assert not watch.tick()  # it had not started
        watch.begin()
        for _ in range(20):
            clock.now += 0.9 * LATE_SECONDS
            assert not watch.overdue and not watch.tick()
        assert watch.frozen == 0.0

    def test_a_very_late_tick_is_reported_until_staff_acknowledge_it(self) -> None:
        clock = Asleep()
        watch = TickWatch(clock)
        watch.begin()
        clock.now += 5.0
        assert watch.overdue and watch.tick()
        assert watch.frozen == 5.0 and not watch.overdue
        clock.now += 0.05
        assert not watch.tick() and watch.frozen == 5.0

    def test_the_clock_for_freezes_never_goes_back(self) -> None:
        before = time_awake_and_asleep()
        assert time_awake_and_asleep() >= before


def frozen(one: Spoken) -> None:
    """Freeze the robot's control for five seconds before the next tick."""
    clock = Asleep()
    one.robot.watch = TickWatch(clock)
    one.robot.watch.begin()
    clock.now += 5.0


class TestFrozen:
    async def test_a_freeze_cancels_the_command_and_stops_the_robot_until_release(self) -> None:
        async with spoken() as one:
            await one.take(id=1, do="go", to=[8.0, 3.0, 0.0])
            await until(lambda: one.robot.going)
            one.parts.told.clear()
            frozen(one)
            await until(lambda: one.said)
            assert one.said[0]["broken"] and one.said[0]["failed"] == "it was frozen for 5.0 s"
            await until(lambda: {"stop", "hold", "hush"} <= set(one.parts.told))
            await one.take(do="release", by=STAFF)
            assert one.state().stopped == one.state().hazard == "it was frozen for 5.0 s"
            assert one.state().frozen == 5.0
            await one.take(id=2, do="go", to=[8.0, 3.0, 0.0])
            await until(lambda: len(one.said) == 2)
            assert one.said[1]["broken"]
            await one.take(do="release", by=FAULT)
            assert one.state().stopped == "" and one.state().frozen == 0.0

    async def test_a_freeze_is_the_reason_even_if_the_drive_is_checked_first(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """After a freeze the program seems to have been silent for as long."""
        monkeypatch.setattr(controller, "HAZARD_SECONDS", 0.0)
        async with spoken() as one:
            robot = one.robot
            robot.alone = lambda: "the program says nothing" if robot.watch.overdue else ""
            until_it_is_over = robot.passing.until

            async def frozen_before(over: Callable[[], bool], seconds: float) -> bool:
                frozen(one)
                return await until_it_is_over(over, seconds)

            monkeypatch.setattr(robot.passing, "until", frozen_before)
            await one.take(id=1, do="go", to=[8.0, 3.0, 0.0])
            await until(lambda: one.said)
            assert one.said[0]["failed"] == "it was frozen for 5.0 s"

    async def test_a_freeze_is_the_reason_even_if_the_program_was_silent_before(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        async with spoken() as one:
            one.robot.alone = lambda: "the program says nothing"
            await one.take(id=1, do="go", to=[8.0, 3.0, 0.0])
            await until(lambda: one.state().hazard)
            await one.robot.passing.sleep(0.2)  # it notices the program's silence
            monkeypatch.setattr(controller, "HAZARD_SECONDS", 0.0)
            frozen(one)
            await until(lambda: one.said)
            assert one.said[0]["failed"] == "it was frozen for 5.0 s"

    async def test_the_link_reports_a_freeze_until_staff_acknowledge_it(self) -> None:
        async with spoken() as one:

            def link() -> tuple[str, object]:
                told = next(r for r in one.state().health if r.device == "link")
                return told.state, told.facts.get("frozen")

            assert link() == (OK, None)
            frozen(one)
            await until(lambda: one.robot.watch.frozen)
            state, seconds = link()
            assert state == ERROR and round(float(str(seconds))) == 5
            await one.take(do="seen to")
            assert link() == (OK, None)
            assert one.state().stopped == "it was frozen for 5.0 s"

    async def test_a_beat_after_a_freeze_includes_the_freeze(self) -> None:
        async with spoken() as one:
            frozen(one)
            beating = asyncio.create_task(one.process.beat())
            await until(lambda: one.said)
            beating.cancel()
            assert one.said[0]["beat"]["frozen"] == 5.0

    async def test_a_stepped_bench_reports_no_freeze(self) -> None:
        async with spoken() as one:
            one.robot.stepped = True
            clock = Asleep()
            one.robot.watch = TickWatch(clock)
            one.robot.watch_ticks()
            clock.now += 5.0
            beating = asyncio.create_task(one.process.beat())
            await until(lambda: one.said)  # it goes on reporting, as nothing is late
            beating.cancel()
            assert one.state().stopped == "" and one.state().frozen == 0.0
