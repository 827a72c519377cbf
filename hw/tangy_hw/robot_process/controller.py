"""The robot controller of the robot process: drives, speaks, shows, looks, and stops.

Everything that moves goes through its tick: there it looks whether it may drive, asks the navigator
or whoever drives by hand how, and tells the base. What it must not do it does not do, whatever the
program wants: while an emergency stop is pressed, a device that it drives by is silent, or the
program is, it stands still; and it stops itself where its control was frozen. A stop waits behind
nothing and latches; only whoever asked for it takes it back by `release`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from contextlib import suppress

from tangy_hw.device_protocols import STILL, Clock, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits, laser_of
from tangy_hw.navigation.navigator_protocol import NavigatorProtocol
from tangy_hw.perception.card_and_face_perception import CardAndFacePerception
from tangy_hw.perception.requests.help_request_source import DEVICE as REQUESTS
from tangy_hw.perception.requests.help_request_source import Ask, RequestSource
from tangy_hw.rate_estimator import RateEstimator
from tangy_hw.robot_process.body import Body
from tangy_hw.robot_process.control_loop import ControlLoop
from tangy_hw.robot_process.courtesies import Courtesies
from tangy_hw.robot_process.device_diagnostics import device_diagnostics
from tangy_hw.robot_process.drive_monitor import DriveMonitor
from tangy_hw.robot_process.hand_drive import HandDrive
from tangy_hw.robot_process.pause_watch import PauseWatch
from tangy_hw.robot_process.performer import Performer
from tangy_hw.robot_process.stop_latch import FAULT, STAFF, Preempted, StopLatch
from tangy_hw.robot_process.tick_watchdog import TickWatch
from tangy_hw.robot_process.wheels import Wheels
from tangy_hw.watchdogs import Watchdogs
from tangy_profiles.health import DeviceState, Health
from tangy_profiles.robot import Robot
from tangy_profiles.state import FRONT

DRIVE_SECONDS = 180.0  # for one drive; ten metres with three detours take 60
SPIN_SECONDS = 60.0
BLOCKED_SECONDS = 4.0  # without a way, before somebody is asked to clear it
HAZARD_SECONDS = 1.0
"""That it may have to stand still, or be left alone, before it gives up what it does."""
OVER = ("arrived", "failed", "idle")
WATCH_SECONDS = 0.02  # between two looks at whether it may still drive


class LiveRobot:
    """A robot that is switched on. `start` it, and `close` it at the end, which stops it."""

    def __init__(
        self,
        robot: Robot,
        body: Body,
        navigator: NavigatorProtocol,
        clock: Clock,
        *,
        senses: CardAndFacePerception | None = None,
        requests: RequestSource | None = None,
        stepped: bool = False,
        courtesies: Mapping[str, str] | None = None,
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
            courtesies: what it says to those for whom it stands on its way (see `Courtesies`).
        """
        self.robot = robot
        self.navigator = navigator
        self.senses, self.requests = senses, requests
        self.alone: Callable[[], str] = str
        """Says why nobody holds the reins any more, "" as long as somebody does."""
        self.left: Callable[[str], None] = lambda why: None
        """Is called with why when all that is under way is to be given up."""
        self.going = ""
        """Where it is driving to."""
        self.passing = ControlLoop(clock, self.tick, stepped=stepped)
        self.body = body
        """Its devices."""
        self._clock, self.stepped = clock, stepped
        limits = MotionLimits.of(robot)
        self.hand = HandDrive(limits, laser_of(robot))
        self.watch = TickWatch(late=robot.liveness.fault_after)
        self.wheels = Wheels(body.base, limits)
        self._stops = StopLatch()
        self._alone_since: float | None = None
        self._left_alone = False
        self._performer = Performer(body, self.passing, robot, navigator, lambda: self._halted)
        self.perform = self._performer.perform
        self._courtesies = Courtesies(courtesies or {}, lambda text: self.perform(text=text))
        self._wanted: Pose | None = None
        self._was = ""  # how the last drive ended
        self._evidence = DriveMonitor(navigator, clock.now)
        self._ticked, self._ticks = clock.now(), RateEstimator()
        reports = device_diagnostics(
            robot,
            body,
            self._evidence,
            lambda: clock.now() - self._ticked,
            lambda: self._ticks.rate(clock.now()),
            failed=lambda: self.failed,
            frozen=lambda: self.watch.frozen,
            pauses=lambda: self.pauses,
            senses=senses,
            requests=requests,
            stepped=stepped,
        )
        self.watchdogs = Watchdogs(robot, reports)
        self.pauses = PauseWatch(robot.liveness, limits, self.watchdogs.label)
        self._tasks: list[asyncio.Task[None]] = []

    # ------------------------------------------------------------------------ on and off

    async def start(self, starts: Callable[[str], object] = lambda part: None) -> None:
        """Switch its devices on; `starts` is told the name of each before that."""
        for device in self.body.all:
            starts(device.name)
            await device.start()
        if self.requests is not None:
            starts(REQUESTS)
            await self.requests.start()
        self._tasks = [asyncio.create_task(self.passing.run())]
        if not self.stepped:
            self._tasks.append(asyncio.create_task(self._watch()))
        for task in self._tasks:
            task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        """Stand still for good when its control has ended otherwise than by closing."""
        if not task.cancelled() and (error := task.exception()) is not None:
            self._stops.failed = f"its control has failed ({error!r})"
            self._tasks.append(asyncio.create_task(self._halt()))

    async def close(self) -> None:
        """Stop it, and switch its devices off."""
        with suppress(Exception):
            await self.wheels.stop()
        self.navigator.cancel()
        for task in self._tasks:
            task.cancel()
        if self._tasks:
            await asyncio.wait(self._tasks)
        if self.requests is not None:
            await self.requests.close()
        for device in reversed(self.body.all):
            with suppress(Exception):  # the others are to be closed as well
                await device.close()

    # ------------------------------------------------------------------------ what it knows

    def health(self) -> Health:
        """Return the newest reading of every device."""
        return self.watchdogs.health()

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
    def stopped(self) -> str:
        """Why it was stopped, until all who did have released it."""
        return self._stops.why

    @property
    def failed(self) -> str:
        """What of its control has failed, for good; "" if nothing has."""
        return self._stops.failed

    @property
    def _halted(self) -> str:
        """Why nothing of it may move, "" if it may."""
        return self.stopped or (self.alone() if self._left_alone else "")

    @property
    def hazard(self) -> str:
        """Why it stands still, "" if it may drive."""
        return self.stopped or self.alone() or self.watchdogs.hazard() or self.pauses.why

    # ------------------------------------------------------------------------ what it does

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
        found = False
        try:
            await self._drive(SPIN_SECONDS)
            estimate = self.navigator.estimate
            found = estimate is not None and estimate.found
        finally:
            self._evidence.looked_round(found=found)
        return found

    async def look_at(self, what: str) -> None:
        """Turn the eyes to a card or a face, as the robot's profile says how."""
        await self._performer.look_at(what)

    def replan(self) -> None:
        """Look whether there is a way again to where there was none."""
        self._evidence.detour_taken()
        if self._wanted is not None and self._evidence.blocked:
            self._evidence.blocked = not self.navigator.finds_way(self._wanted)

    def drive_by_hand(self, twist: Twist, *, overrides: bool = False) -> None:
        """Drive by hand while a key is held; each command lasts a moment, and none in a hazard.

        It is slower before what the scanner sees near, and stands before what is close, or crawls
        past that where the command `overrides` it.
        """
        self.navigator.cancel()
        self.hand.tell(twist, self._clock.now(), overrides=overrides)

    async def stop(self, why: str, by: str = STAFF) -> None:
        """Stand still now, hold the arms where they are, and be quiet; it latches, for `by`.

        The base is first, and what fails in the rest changes nothing.
        """
        self._stops.hold(why, by)
        await self._halt()

    async def _halt(self) -> None:
        self.hand.end()
        try:
            await self.wheels.stop()
        finally:
            self.navigator.cancel()
            await self._performer.be_still()

    def release(self, by: str = "") -> None:
        """Release the stop of one source, or of the source that had stopped it."""
        self._stops.release(by)
        self._evidence.blocked = False
        if by in ("", FAULT):
            self.watch.frozen = 0.0

    def watch_ticks(self) -> None:
        """Watch from now on that no tick comes much too late, unless time stands still between."""
        if not self.stepped:
            self.watch.begin()
            self.pauses.begin()

    def seen_to(self) -> None:
        """Take it that staff know that its control was frozen; it stands until it is released."""
        self.watch.frozen = 0.0

    def fail(self, device: str, state: DeviceState) -> None:
        """Take a device for broken, whatever it says; "OK" takes it back."""
        self.watchdogs.fail(device, state)

    async def restart(self, device: str) -> None:
        """Switch a device off and on again."""
        await self.body.restart(device)

    async def relax(self) -> None:
        """Let the arms hang without torque."""
        await self.body.relax()

    # ------------------------------------------------------------------------ in each tick

    async def _drive(self, seconds: float) -> bool:
        """Let the navigator drive until it has arrived, or cannot; or the robot must not."""
        navigator, since = self.navigator, dict.fromkeys(("blocked", "hazard"), self._clock.now())
        self._evidence.begin()

        def lasts(what: str, there: bool) -> float:
            since[what] = since[what] if there else self._clock.now()
            return self._clock.now() - since[what]

        def over() -> bool:
            patience = self.pauses.patience(self.watchdogs.late()) or HAZARD_SECONDS
            blocked = lasts("blocked", navigator.state == "blocked") > BLOCKED_SECONDS
            waited = lasts("hazard", self.hazard != "") > patience or blocked
            return waited or self.stopped != "" or navigator.state in OVER

        await self.passing.until(over, seconds)
        arrived, hazard = navigator.state == "arrived", self.hazard
        self._was = navigator.state
        self._evidence.keep()
        if not arrived:
            navigator.cancel()
            await self.wheels.stop()
        if hazard and not arrived:
            raise Preempted(hazard)
        return arrived

    def tick(self) -> bool:
        """Look, decide, and tell the base; say whether it drives, or is about to."""
        base, laser = self.body.base, self.body.laser
        now = self._clock.now()
        passed, self._ticked = now - self._ticked, now
        self._ticks.count(now)
        if self.watch.tick():
            self._was_frozen()
        odometry, scan = base.odometry, laser.scan
        command, seen = STILL, None if scan is None else scan.value
        if odometry is not None:
            command = self.navigator.tick(odometry.value, seen, passed)
            self._evidence.note()
        by_hand = self.hand.command(seen, now, self.navigator.unseen, self.navigator.tracks)
        command = command if by_hand is None else by_hand
        self._mind()
        self._courtesies.note(self.navigator.lets, now)
        if self.hazard or (self.navigator.lets and self.navigator.drives):
            command = STILL
            self._stand()
        elif command != STILL or not self.wheels.stand:
            self.wheels.send(self.pauses.limited(command))
        return command != STILL or self.going != ""

    def _was_frozen(self) -> None:
        """Stop and abort the current command until a person releases the robot."""
        why = f"it was frozen for {self.watch.frozen:.1f} s"
        self._stops.hold(why, FAULT)
        self._tasks.append(asyncio.create_task(self._halt()))
        self.left(why)

    async def _watch(self) -> None:
        """Look for hazards between ticks, too: a robot that drives has no time to lose."""
        while True:
            await asyncio.sleep(WATCH_SECONDS)
            if self.watch.overdue and self.watch.tick():  # that explains what else is amiss
                self._was_frozen()
            self._mind()
            if (self.wheels.driven != STILL or self.navigator.drives) and self.hazard:
                self._stand()

    def _stand(self) -> None:
        """Have the base stand, and whatever drives it past us call that off, until it has."""
        self.navigator.held()
        if not self.wheels.stand or self.navigator.drives:
            self.wheels.send(STILL)

    def _mind(self) -> None:
        """Wait for late data; hold the arms and be quiet, once, when left alone for a while."""
        self.pauses.look(self.watchdogs.ages(), self.watchdogs.late())
        why, now = self.alone(), self._clock.now()
        if not why:
            self._alone_since, self._left_alone = None, False
        elif self._alone_since is None:
            self._alone_since = now
        elif not self._left_alone and now - self._alone_since > HAZARD_SECONDS:
            self._left_alone = True
            self._tasks.append(asyncio.create_task(self._performer.be_still()))
            self.left(why)
