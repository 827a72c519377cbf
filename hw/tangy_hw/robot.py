"""The robot itself, as the robot process holds it: it drives, speaks, shows, looks, and stops.

Everything that moves goes through its tick: there it looks whether it may drive, asks the navigator
how, and tells the base. What it must not do it does not do, whatever the program wants: while an
emergency stop is pressed, a device that it drives by is silent, or the program is, it stands still.
A stop waits behind nothing and latches; only `release` takes it back.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine, Mapping, Sequence
from contextlib import suppress
from typing import Any

from tangy_hw.body import Body
from tangy_hw.devices import STILL, Arms, Clock, DeviceError, Picture, Pose, Twist
from tangy_hw.drive_evidence import DriveEvidence
from tangy_hw.health import Watchdogs
from tangy_hw.navigation.wayfinding import Wayfinder
from tangy_hw.passing_time import PassingTime
from tangy_hw.perception.requests.asking import Ask, RequestSource
from tangy_hw.reports import reports_of
from tangy_hw.senses import Senses
from tangy_profiles.health import ERROR, Health, Reading
from tangy_profiles.robot import Robot
from tangy_profiles.state import FRONT

DRIVE_SECONDS = 180.0  # for one drive; ten metres with three detours take 60
SPIN_SECONDS = 60.0
SPEECH_SECONDS = 60.0  # for one line
POSE_SECONDS = 1.5  # in which arms are where they should be
POSE_PATIENCE = 6.0
BLOCKED_SECONDS = 4.0  # without a way, before somebody is asked to clear it
HAZARD_SECONDS = 1.0  # that it may have to stand still on its way, before it gives the drive up
WATCH_SECONDS = 0.02  # between two looks at whether it may still drive
STOP_SECONDS = 1.0  # in which arms and voice have heard that they are to stop
BY_HAND_SECONDS = 0.4  # for which a command of somebody who drives by keys holds


class BrokenOff(DeviceError):
    """Something was not done to its end, because the robot has to stand still."""


class LiveRobot:
    """A robot that is switched on. `start` it, and `close` it at the end, which stops it."""

    def __init__(
        self,
        robot: Robot,
        body: Body,
        navigator: Wayfinder,
        clock: Clock,
        *,
        senses: Senses | None = None,
        requests: RequestSource | None = None,
        stepped: bool = False,
    ) -> None:
        """Put it together.

        Args:
            robot: its profile.
            body: its devices.
            navigator: what finds its place and its way.
            clock: its time.
            senses: what reads its pictures.
            requests: who asks for help.
            stepped: its time stands still while nothing is done.
        """
        self.robot = robot
        self.navigator = navigator
        self.senses = senses
        self.requests = requests
        self.alone: Callable[[], str] = str
        """Says why nobody holds the reins any more, "" as long as somebody does."""
        self.stopped = ""
        """Why it was stopped, until it is released."""
        self.going = ""
        """Where it is driving to."""
        self.passing = PassingTime(clock, self._tick, stepped=stepped)
        self._body = body
        self._clock = clock
        self._stepped = stepped
        self._hand: tuple[Twist, float] | None = None
        self._driven = STILL
        self._sent: asyncio.Task[None] | None = None
        self._gaze = ""
        self._wanted: Pose | None = None
        self._was = ""  # how the last drive ended
        self._evidence = DriveEvidence(navigator, clock.now)
        self._ticked = clock.now()
        reports = reports_of(
            robot,
            body,
            self._evidence,
            lambda: clock.now() - self._ticked,
            senses=senses,
            requests=requests,
            stepped=stepped,
        )
        self._watchdogs = Watchdogs(robot, reports)
        self._tasks: list[asyncio.Task[None]] = []

    # ------------------------------------------------------------------------ on and off

    async def start(self) -> None:
        """Switch its devices on."""
        for device in self._body.all:
            await device.start()
        if self.requests is not None:
            await self.requests.start()
        ticking = asyncio.create_task(self.passing.run())
        ticking.add_done_callback(self._ticked_last)
        self._tasks = [ticking]
        if not self._stepped:
            self._tasks.append(asyncio.create_task(self._watch()))

    def _ticked_last(self, task: asyncio.Task[None]) -> None:
        """Stand still for good when ticks have ended otherwise than by closing."""
        if not task.cancelled() and (error := task.exception()) is not None:
            self.stopped = f"its control has failed ({error!r})"

    async def close(self) -> None:
        """Stop it, and switch its devices off."""
        with suppress(Exception):
            await self._body.base.stop()
        self.navigator.cancel()
        for task in self._tasks:
            task.cancel()
        if self._tasks:
            await asyncio.wait(self._tasks)
        if self.requests is not None:
            await self.requests.close()
        for device in reversed(self._body.all):
            with suppress(Exception):  # the others are to be closed as well
                await device.close()

    # ------------------------------------------------------------------------ what it knows

    def health(self) -> Health:
        """Return the newest reading of every device."""
        return self._watchdogs.health()

    @property
    def screen_url(self) -> str:
        """The address at which tablets open the chest screen, "" where it is no page."""
        return str(getattr(self._body.screen, "url", ""))

    def state_of(self, reading: Reading) -> str:
        """Return the state of a device: STALE where its data is too old."""
        return self._watchdogs.state(reading)

    @property
    def pose(self) -> Pose:
        """Where it believes to be."""
        estimate = self.navigator.estimate
        return Pose(0.0, 0.0, 0.0) if estimate is None else estimate.pose

    @property
    def asking(self) -> tuple[Ask, ...]:
        """Who asks for help, the one who has waited longest first."""
        return () if self.requests is None else self.requests.asking

    @property
    def hazard(self) -> str:
        """Why it stands still, "" if it may drive."""
        return self.stopped or self.alone() or self._watchdogs.hazard()

    # ------------------------------------------------------------------------ what it does

    async def perform(
        self,
        *,
        text: str = "",
        picture: Picture | None = None,
        posture: Mapping[str, Sequence[float]] | None = None,
        gazes: bool = False,
    ) -> dict[str, bool]:
        """Say, show and gesture at once; return which of it was done.

        What cannot be done is left out: its device says so in its reading. With an arm that has
        an error there are no gestures; the eyes are still turned, which `gazes` says this is for.

        Raises:
            BrokenOff: it was stopped meanwhile.
        """
        doing: dict[str, Coroutine[Any, Any, None]] = {}
        if self._body.voice is not None and text:
            doing["said"] = self._body.voice.say(text)
        if self._body.screen is not None and picture is not None:
            doing["shown"] = self._body.screen.show(picture)
        arms = self._body.arms
        if arms is not None and posture and (gazes or arms.reading().state != ERROR):
            doing["posed"], self._gaze = self._pose(arms, posture), ""
        tasks = {what: asyncio.create_task(work) for what, work in doing.items()}
        try:
            await self.passing.until(
                lambda: bool(self.stopped) or all(task.done() for task in tasks.values()),
                SPEECH_SECONDS,
            )
        finally:
            for task in tasks.values():
                task.cancel()
            await asyncio.gather(*tasks.values(), return_exceptions=True)
        if self.stopped:
            raise BrokenOff(self.stopped)
        return {
            what: not task.cancelled() and task.exception() is None for what, task in tasks.items()
        }

    async def _pose(self, arms: Arms, posture: Mapping[str, Sequence[float]]) -> None:
        """Move the arms; not when it was stopped before they were told."""
        if self.stopped:
            raise BrokenOff(self.stopped)
        await arms.pose(posture, POSE_SECONDS)

    async def go(self, goal: Pose, name: str = "") -> bool:
        """Drive somewhere; return whether it has arrived (no: there is no way, or it is stuck).

        Raises:
            BrokenOff: it has to stand still, and why.
        """
        self.going = name or FRONT
        self._wanted = goal
        try:
            self.navigator.go(goal)
            arrived = await self._drive(DRIVE_SECONDS)
            self._evidence.blocked = self._was == "blocked"
            return arrived
        except BaseException:
            self.navigator.cancel()
            raise
        finally:
            self.going = ""

    async def spin(self) -> bool:
        """Turn on the spot to find its place; return whether it has.

        Raises:
            BrokenOff: it has to stand still, and why.
        """
        self.navigator.spin()
        await self._drive(SPIN_SECONDS)
        estimate = self.navigator.estimate
        found = estimate is not None and estimate.found
        if found:
            self._evidence.found()
        return found

    async def look_at(self, what: str) -> None:
        """Turn the eyes to a card or a face, as the robot's profile says how."""
        angles = self.robot.gaze.get(what)
        if angles and self._body.arms is not None and self._gaze != what:
            await self.perform(posture=angles, gazes=True)
            self._gaze = what

    def replan(self) -> None:
        """Look whether there is a way again to where there was none."""
        self._evidence.detour_taken()
        if self._wanted is not None and self._evidence.blocked:
            self._evidence.blocked = not self.navigator.finds_way(self._wanted)

    def drive_by_hand(self, twist: Twist) -> None:
        """Drive as somebody says who holds a key; it holds for a moment, and not in a hazard."""
        self.navigator.cancel()
        self._hand = twist, self._clock.now() + BY_HAND_SECONDS

    async def stop(self, why: str) -> None:
        """Stand still now, hold the arms where they are, and be quiet; it latches.

        The base is first, and what fails in the rest changes nothing.
        """
        self.stopped = self.stopped or why
        self._hand = None
        self._driven = STILL
        self._gaze = ""
        try:
            await self._body.base.stop()
        finally:
            self.navigator.cancel()
            rest: list[Coroutine[Any, Any, None]] = []
            if self._body.arms is not None:
                rest.append(self._body.arms.hold())
            if self._body.voice is not None:
                rest.append(self._body.voice.hush())
            await _within(STOP_SECONDS, *rest)

    def release(self) -> None:
        """Let it move again."""
        self.stopped, self._evidence.blocked = "", False

    def fail(self, device: str, state: str) -> None:
        """Take a device for broken, whatever it says, to try what follows; "OK" takes it back."""
        self._watchdogs.fail(device, state)

    async def restart(self, device: str) -> None:
        """Switch a device off and on again."""
        for one in self._body.all:
            if one.name == device:
                await one.close()
                await one.start()

    async def relax(self) -> None:
        """Let the arms hang without torque."""
        if self._body.arms is not None:
            await self._body.arms.relax()

    # ------------------------------------------------------------------------ in each tick

    async def _drive(self, seconds: float) -> bool:
        """Let the navigator drive until it has arrived, or cannot; or the robot must not."""
        navigator, now = self.navigator, self._clock.now()
        self._evidence.begin()
        since = {"blocked": now, "hazard": now}

        def over() -> bool:
            now = self._clock.now()
            if navigator.state != "blocked":
                since["blocked"] = now
            if not self.hazard:
                since["hazard"] = now
            return (
                bool(self.stopped)
                or navigator.state in ("arrived", "failed", "idle")
                or now - since["blocked"] > BLOCKED_SECONDS
                or now - since["hazard"] > HAZARD_SECONDS
            )

        await self.passing.until(over, seconds)
        arrived = navigator.state == "arrived"
        hazard = self.hazard
        self._was = navigator.state
        self._evidence.keep()
        if not arrived:
            navigator.cancel()
            await self._body.base.stop()
        if hazard and not arrived:
            raise BrokenOff(hazard)
        return arrived

    def _tick(self) -> bool:
        """Look, decide, and tell the base; say whether it drives, or is about to."""
        base, laser = self._body.base, self._body.laser
        now = self._clock.now()
        passed, self._ticked = now - self._ticked, now
        odometry, scan = base.odometry, laser.scan
        command = STILL
        if odometry is not None:
            seen = None if scan is None else scan.value
            command = self.navigator.tick(odometry.value, seen, passed)
            self._evidence.note()
        if self._hand is not None:
            twist, until = self._hand
            command = twist if now < until else STILL
            if now >= until:
                self._hand = None
        if self.hazard:
            command = STILL
            self._stand()
        elif command != STILL or self._driven != STILL:
            self._send(command)
        return command != STILL or self.going != ""

    async def _watch(self) -> None:
        """Look for hazards between ticks, too: a robot that drives has no time to lose."""
        while True:
            await asyncio.sleep(WATCH_SECONDS)
            if (self._driven != STILL or self.navigator.drives) and self.hazard:
                self._stand()

    def _stand(self) -> None:
        """Have the base stand, and whatever drives it past us call that off, until it has."""
        self.navigator.held()
        if self._driven != STILL or self.navigator.drives:
            self._send(STILL)

    def _send(self, command: Twist) -> None:
        """Tell the base; a command that could not be handed over is followed by the next."""
        halting = command == STILL and self._driven != STILL
        if not halting and self._sent is not None and not self._sent.done():
            return
        self._driven = command
        work = self._body.base.stop() if command == STILL else self._body.base.drive(command)
        self._sent = asyncio.create_task(_quietly(work))


async def _within(seconds: float, *works: Coroutine[Any, Any, None]) -> None:
    """Do things at once, for so many s at most; whatever comes of them."""
    tasks = [asyncio.create_task(work) for work in works]
    if tasks:
        await asyncio.wait(tasks, timeout=seconds)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def _quietly(work: Coroutine[Any, Any, None]) -> None:
    with suppress(DeviceError):  # its reading tells
        await work
