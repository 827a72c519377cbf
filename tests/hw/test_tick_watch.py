"""A robot whose control was frozen breaks off, and stands until it is told to go on."""

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
    def test_ticks_that_are_a_little_late_are_nothing(self) -> None:
        clock = Asleep()
        watch = TickWatch(clock)
        assert not watch.tick()  # it was not begun
        watch.begin()
        for _ in range(20):
            clock.now += 0.9 * LATE_SECONDS
            assert not watch.overdue and not watch.tick()
        assert watch.frozen == 0.0

    def test_one_that_is_much_too_late_is_told_until_staff_have_seen_to_it(self) -> None:
        clock = Asleep()
        watch = TickWatch(clock)
        watch.begin()
        clock.now += 5.0
        assert watch.overdue and watch.tick()
        assert watch.frozen == 5.0 and not watch.overdue
        clock.now += 0.05
        assert not watch.tick() and watch.frozen == 5.0

    def test_its_time_goes_on(self) -> None:
        before = time_awake_and_asleep()
        assert time_awake_and_asleep() >= before


def frozen(one: Spoken) -> None:
    """Let the robot's control have been frozen for five seconds before the next tick."""
    clock = Asleep()
    one.robot.watch = TickWatch(clock)
    one.robot.watch.begin()
    clock.now += 5.0


class TestFrozen:
    async def test_what_was_under_way_is_given_up_and_it_stands_until_it_is_told(self) -> None:
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

    async def test_it_is_told_even_if_a_drive_is_looked_at_before_the_next_tick(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """After a freeze the program seems to have said nothing for as long."""
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

    async def test_it_is_told_even_if_the_program_was_silent_just_before(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        async with spoken() as one:
            one.robot.alone = lambda: "the program says nothing"
            await one.take(id=1, do="go", to=[8.0, 3.0, 0.0])
            await until(lambda: one.state().hazard)
            await one.robot.passing.sleep(0.2)  # in which its silence is noticed
            monkeypatch.setattr(controller, "HAZARD_SECONDS", 0.0)
            frozen(one)
            await until(lambda: one.said)
            assert one.said[0]["failed"] == "it was frozen for 5.0 s"

    async def test_it_shows_in_the_link_until_staff_have_seen_to_it(self) -> None:
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

    async def test_nothing_is_told_before_it_has_looked_how_late_it_is(self) -> None:
        async with spoken() as one:
            frozen(one)
            beating = asyncio.create_task(one.process.beat())
            await until(lambda: one.said)
            beating.cancel()
            assert one.said[0]["beat"]["frozen"] == 5.0

    async def test_on_a_bench_in_a_hurry_time_stands_still_and_nothing_is_frozen(self) -> None:
        async with spoken() as one:
            one.robot.stepped = True
            clock = Asleep()
            one.robot.watch = TickWatch(clock)
            one.robot.watch_ticks()
            clock.now += 5.0
            beating = asyncio.create_task(one.process.beat())
            await until(lambda: one.said)  # it goes on telling how it is, as nothing is late
            beating.cancel()
            assert one.state().stopped == "" and one.state().frozen == 0.0
