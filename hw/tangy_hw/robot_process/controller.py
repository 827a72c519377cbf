"""The robot controller of the robot process: drives, speaks, shows, looks, and stops.

All motion goes through its tick, which checks whether the robot may drive, gets a command from the
navigator or a person's manual control, and sends it to the base. Whatever the program wants, the
robot stands still while an emergency stop is pressed, or while a device that driving depends on, or
the program, is silent; it stops itself if its control was frozen. A stop precedes everything and
latches; only its source can `release` it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from contextlib import suppress

from tangy_hw.device_protocols import STILL, Clock, Pose, Twist
from tangy_hw.navigation.limits import MotionLimits, laser_of, reach_of
from tangy_hw.navigation.navigator_protocol import NavigatorProtocol
from tangy_hw.navigation.odometry_history import OdometryHistory
from tangy_hw.perception.card_and_face_perception import CardAndFacePerception
from tangy_hw.perception.requests.help_request_source import DEVICE as REQUESTS
from tangy_hw.perception.requests.help_request_source import HelpRequest, RequestSource, ShownLetter
from tangy_hw.rate_estimator import RateEstimator
from tangy_hw.robot_process.body import Body
from tangy_hw.robot_process.control_loop import ControlLoop
from tangy_hw.robot_process.device_diagnostics import device_diagnostics
from tangy_hw.robot_process.drive_monitor import DriveMonitor
from tangy_hw.robot_process.driver_checks import CheckedData, start_device
from tangy_hw.robot_process.hand_drive import HandDrive
from tangy_hw.robot_process.pause_watch import PauseWatch
from tangy_hw.robot_process.performer import Performer
from tangy_hw.robot_process.stop_latch import FAULT, STAFF, Preempted, StopLatch
from tangy_hw.robot_process.tick_watchdog import TickWatch
from tangy_hw.robot_process.wait_explanations import WaitExplanations
from tangy_hw.robot_process.wheels import Wheels
from tangy_hw.watchdogs import Watchdogs
from tangy_profiles.health import DeviceState, Health
from tangy_profiles.robot import Robot
from tangy_profiles.state import FRONT

DRIVE_SECONDS = 180.0  # timeout of a drive; ten metres with three detours take 60
SPIN_SECONDS = 60.0
BLOCKED_SECONDS = 4.0  # without a path, before people are asked to clear one
HAZARD_SECONDS = 1.0
"""Duration of a hazard, or of the program's silence, after which the robot gives up its task."""
OVER = ("arrived", "failed", "idle")
WATCH_SECONDS = 0.02  # between two checks for hazards


class LiveRobot:
    """A robot that is switched on. Call `start`, and at the end `close`, which stops it."""

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
        wait_explanations: Mapping[str, str] | None = None,
    ) -> None:
        """Assemble the controller.

        Args:
            robot: the robot's profile.
            body: its devices.
            navigator: localisation and path following.
            clock: its clock.
            senses: readers of its images.
            requests: source of requests for help.
            stepped: whether its time stands still while nothing is done.
            wait_explanations: sentences for people whom it waits for (see `WaitExplanations`).
        """
        self.robot = robot
        self.navigator = navigator
        self.senses, self.requests = senses, requests
        self.alone: Callable[[], str] = str
        """Returns why the program counts as absent, "" if it does not."""
        self.left: Callable[[str], None] = lambda why: None
        """Called with the reason when all tasks in progress are to be aborted."""
        self.going = ""
        """Name of the place that it is driving to."""
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
        self._wait_explanations = WaitExplanations(
            wait_explanations or {}, lambda text: self.perform(text=text)
        )
        self._moved, self._data = OdometryHistory(), CheckedData(body, clock.now, reach_of(robot))
        self._wanted: Pose | None = None
        self._was = ""  # state at the end of the last drive
        self._evidence = DriveMonitor(navigator, clock.now)
        self._ticked, self._ticks = clock.now(), RateEstimator()
        reports = device_diagnostics(
            robot,
            body,
            self._evidence,
            lambda: clock.now() - self._ticked,
            lambda: self._ticks.rate(clock.now()),
            report=self._data.report,
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
        """Switch its devices on; `starts` is called with the name of each before."""
        for device in self.body.all:
            starts(device.name)
            await start_device(device)
        if self.requests is not None:
            starts(REQUESTS)
            await self.requests.start()
        self._tasks = [asyncio.create_task(self.passing.run())]
        if not self.stepped:
            self._tasks.append(asyncio.create_task(self._watch()))
        for task in self._tasks:
            task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        """Stop for good if its control has ended other than by closing."""
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
            with suppress(Exception):  # the others must be closed as well
                await device.close()

    # ------------------------------------------------------------------------ state

    def health(self) -> Health:
        """Return the newest reading of every device."""
        return self.watchdogs.health()

    @property
    def pose(self) -> Pose:
        """Estimated pose."""
        estimate = self.navigator.estimate
        return Pose(0.0, 0.0, 0.0) if estimate is None else estimate.pose

    @property
    def asking(self) -> tuple[HelpRequest, ...]:
        """Requests for help, the longest waiting first."""
        return () if self.requests is None else self.requests.asking

    @property
    def showing(self) -> tuple[ShownLetter, ...]:
        """Who shows an answer sign, the first to do so first."""
        return () if self.requests is None else self.requests.showing

    @property
    def stopped(self) -> str:
        """Why it was stopped, until all sources have released it."""
        return self._stops.why

    @property
    def failed(self) -> str:
        """Permanent failure of its control; "" if there is none."""
        return self._stops.failed

    @property
    def _halted(self) -> str:
        """Why nothing may move, "" if it may."""
        return self.stopped or (self.alone() if self._left_alone else "")

    @property
    def hazard(self) -> str:
        """Why it stands still, "" if it may drive."""
        return self.stopped or self.alone() or self.watchdogs.hazard() or self.pauses.why

    # ------------------------------------------------------------------------ tasks

    async def go(self, goal: Pose, name: str = "") -> bool:
        """Drive to a pose; return whether it has arrived (False: no path, or stuck).

        Raises:
            Preempted: it has to stop; with the reason.
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
        """Turn on the spot to localise; return whether it is localised.

        Raises:
            Preempted: it has to stop; with the reason.
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
        """Turn the head to a card or a face, by the robot's profile."""
        await self._performer.look_at(what)

    def replan(self) -> None:
        """Check whether a blocked path is free again, and drop the symptom of a detour."""
        self._evidence.detour_taken()
        self._look_for_way()

    def _look_for_way(self) -> None:
        if self._wanted is not None and self._evidence.blocked:
            self._evidence.blocked = not self.navigator.finds_way(self._wanted)

    def drive_by_hand(self, twist: Twist, *, overrides: bool = False) -> None:
        """Drive manually; each command lasts a moment, and has no effect in a hazard.

        The robot slows down near obstacles, and stops before close ones, or creeps past them if the
        command `overrides` this.
        """
        self.navigator.cancel()
        self.hand.tell(twist, self._clock.now(), overrides=overrides)

    async def stop(self, why: str, by: str = STAFF) -> None:
        """Stop now, hold the arms at their position, and be quiet; it latches for `by`.

        The base comes first; failures of the rest change nothing.
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
        """Release the stop of one source, or of the source that stopped the robot."""
        self._stops.release(by)
        self._look_for_way()  # what stood in the way may still be there
        if by in ("", FAULT):
            self.watch.frozen = 0.0

    def watch_ticks(self) -> None:
        """Detect late ticks from now on, except on a stepped bench."""
        if not self.stepped:
            self.watch.begin()
            self.pauses.begin()

    def seen_to(self) -> None:
        """Record that staff know about a freeze; the robot stands until it is released."""
        self.watch.frozen = 0.0

    def fail(self, device: str, state: DeviceState) -> None:
        """Override the state of a device; OK removes the override."""
        self.watchdogs.fail(device, state)

    async def restart(self, device: str) -> None:
        """Switch a device off and on again."""
        await self.body.restart(device)

    async def relax(self) -> None:
        """Switch the torque of the arms off."""
        await self.body.relax()

    # ------------------------------------------------------------------------ in each tick

    async def _drive(self, seconds: float) -> bool:
        """Let the navigator drive until it has arrived or failed, or the robot must stop."""
        navigator, since = self.navigator, dict.fromkeys(("blocked", "hazard"), self._clock.now())
        self._evidence.begin()

        def lasts(what: str, there: bool) -> float:
            since[what] = since[what] if there else self._clock.now()
            return self._clock.now() - since[what]

        def over() -> bool:
            if self.watch.overdue:
                return False  # the next tick tells that it was frozen, which explains the rest
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
        """Sense, decide, and command the base; return whether it drives, or is about to."""
        now = self._clock.now()
        passed, self._ticked = now - self._ticked, now
        self._ticks.count(now)
        if self.watch.tick():
            self._was_frozen()
        odometry, scan = self._data.odometry, self._data.scan
        command, seen = STILL, None if scan is None else scan.value
        if odometry is not None:
            self._moved.note(odometry)
            at_scan = None if scan is None else self._moved.at(scan.time)
            command = self.navigator.tick(odometry.value, seen, passed, at_scan)
            self._evidence.note()
        by_hand = self.hand.command(seen, now, self.navigator.unseen, self.navigator.tracks)
        command = command if by_hand is None else by_hand
        self._mind()
        self._wait_explanations.note(self.navigator.yields_to, now)
        if self.hazard or (self.navigator.yields_to and self.navigator.drives):
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
        self._alone_since = None  # nobody could be heard meanwhile
        self.left(why)

    async def _watch(self) -> None:
        """Check for hazards between ticks too: a driving robot must react quickly."""
        while True:
            await asyncio.sleep(WATCH_SECONDS)
            if self.watch.overdue and self.watch.tick():  # this explains other symptoms
                self._was_frozen()
            self._mind()
            if (self.wheels.driven != STILL or self.navigator.drives) and self.hazard:
                self._stand()

    def _stand(self) -> None:
        """Stop the base, and cancel an external drive until it has ended."""
        self.navigator.held()
        if not self.wheels.stand or self.navigator.drives:
            self.wheels.send(STILL)

    def _mind(self) -> None:
        """Update waits for late data; hold the arms and be quiet if left alone for a while."""
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
