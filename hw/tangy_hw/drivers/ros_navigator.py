"""Robots that find their way themselves: move_base in ROS 1, Nav2's NavigateToPose in ROS 2."""

from __future__ import annotations

import asyncio
import math
import secrets
from contextlib import suppress
from itertools import count
from typing import Any, Literal

from tangy_hw.device_protocols import DeviceError, Pose, Stamped
from tangy_hw.drivers.ros_messages import (
    Message,
    header,
    number,
    pose_message,
    pose_of,
    seen_from,
    time_message,
    within,
)
from tangy_hw.drivers.ros_newest import Newest, awaited
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.rosbridge_waiting import Goal, LinkLost
from tangy_hw.navigation.localisation import WIDE
from tangy_profiles.health import OK, STALE, DeviceState, Reading
from tangy_profiles.reading import plain

DRIVE_SECONDS = 180.0
TAKEN_SECONDS = 3.0  # in which a goal has been taken, or nobody takes goals there
AGAIN_SECONDS = 0.5  # until a goal that nobody took is sent again: topics of ROS 1 begin late
CANCEL_SECONDS = 2.0  # for which the end of what was cancelled is waited for

TOLD = (0.25, *(0.0,) * 6, 0.25, *(0.0,) * 27, 0.07)  # m2 and rad2, (6, 6): how sure staff are

OURS = "tangy-"  # with which the id of a goal of ROS 1 begins
UNDER_WAY = (0, 1)  # as actionlib_msgs/GoalStatus numbers them
SUCCEEDED = 3
OVER = {2: "was cancelled", 4: "found no way", 5: "refused", 8: "was cancelled", 9: "lost the goal"}

State = Literal["idle", "driving", "arrived", "failed"]
Path = Literal["clear", "replanned", "none"]


class RosNavigator:
    """Drives to poses by the robot's own navigation; one at a time, the newest counts."""

    def __init__(
        self,
        bridge: Rosbridge,
        *,
        name: str = "navigator",
        action: str = "",
        frame: str = "map",
        origin: Pose = Pose(0.0, 0.0, 0.0),  # noqa: B008 - it cannot change
        place: str = "/amcl_pose",
        initial: str = "/initialpose",
    ) -> None:
        """Name its action and topics.

        Args:
            bridge: the link to the robot.
            name: of the device, as in the profile of the robot.
            action: "" is /move_base in ROS 1, and /navigate_to_pose in ROS 2.
            frame: of the robot's map.
            origin: where in the robot's map the room's frame is.
            place: where the robot says by geometry_msgs/PoseWithCovarianceStamped that it is.
            initial: the topic for the initial pose.
        """
        self.name = name
        self.state: State = "idle"
        self._bridge, self._frame, self._origin = bridge, frame, origin
        self._place, self._initial = place, initial
        self._action = action or ("/move_base" if bridge.ros == 1 else "/navigate_to_pose")
        self._newest: Newest[None] = Newest(bridge.clock)
        self._pose: Newest[Pose] = Newest(bridge.clock)
        self._spread = 0.0
        self._since = bridge.clock()  # when the newest drive began
        self._path: Path = "clear"
        self._mark, self._numbers = f"{OURS}{secrets.token_hex(4)}", count(1)
        self._drive: _Drive | None = None
        self._orphan: _Drive | None = None
        self._known: dict[str, _Drive] = {}
        self._topics = {
            f"{self._action}/status": ("actionlib_msgs/GoalStatusArray", self._hear_status),
            f"{self._action}/result": ("move_base_msgs/MoveBaseActionResult", self._hear_result),
            f"{self._action}/feedback": (
                "move_base_msgs/MoveBaseActionFeedback",
                lambda message: self._feed(message["feedback"]),
            ),
        }
        # A bridge may hear nothing else of a link on which a goal is under way: not even a stop.
        self._goals = (
            bridge if bridge.ros == 1 else Rosbridge(bridge.url, clock=bridge.clock, ros=2)
        )
        self._begun = False
        bridge.on_connect(self._give_up_orphan)

    @property
    def pose(self) -> Stamped[Pose] | None:
        """Where in the room the robot says that it is; None: it did not say so yet."""
        return self._pose.stamped

    async def start(self) -> None:
        """Begin to hear how driving goes."""
        await self._bridge.start()
        await self._goals.start()
        if self._begun:
            return
        self._begun = True
        self._newest.restart()
        self._bridge.advertise(self._initial, "geometry_msgs/PoseWithCovarianceStamped")
        if self._place:
            self._bridge.subscribe(
                self._place, "geometry_msgs/PoseWithCovarianceStamped", self._hear_place
            )
        if self._bridge.ros == 1:
            self._bridge.advertise(f"{self._action}/goal", "move_base_msgs/MoveBaseActionGoal")
            self._bridge.advertise(f"{self._action}/cancel", "actionlib_msgs/GoalID")
            for topic, (kind, hears) in self._topics.items():
                self._bridge.subscribe(topic, kind, hears)

    async def close(self) -> None:
        """Stand still, and end."""
        await self.cancel()
        self._begun = False
        self._bridge.unsubscribe(self._place, self._hear_place)
        if self._bridge.ros == 1:
            for topic, (_, hears) in self._topics.items():
                self._bridge.unsubscribe(topic, hears)
        else:
            await self._goals.close()

    def reading(self) -> Reading:
        """Return how long ago it was heard of, and how the way there is.

        Where navigation says nothing while it has nothing to do (ROS 2), its age is the link's.
        """
        age = self._newest.age
        if self._bridge.ros == 2:
            age = min(age, self._bridge.reading().age) if self.state != "driving" else age
            state, facts = self._bridge.reading().state, {"path": self._path}
            return Reading(self.name, age, state, facts, self._newest.rate)
        return self._newest.reading(self.name, OK, {"path": self._path})

    def localisation(self) -> Reading:
        """Return how long ago the robot said where it is, and how sure it is of that.

        It may say so only as it moves: while it is to stand, the age is the link's. How well the
        room fits it does not say: it does, until several places are thought possible.
        """
        age, link = self._pose.age, self._bridge.reading().age
        age = min(age, self._bridge.clock() - self._since if self.state == "driving" else link)
        fit = 0.0 if self._spread > WIDE else 1.0
        state: DeviceState = STALE if self.pose is None else OK
        facts = {"fit": fit, "spread": self._spread}
        return Reading("localisation", age, state, facts, self._pose.rate)

    def place(self, pose: Pose) -> None:
        """Tell the robot that it is there, within some 50 cm.

        Raises:
            DeviceError: there is no link.
        """
        there = {"pose": pose_message(within(pose, self._origin)), "covariance": list(TOLD)}
        head = header(self._frame, self._bridge.ros)
        self._bridge.publish(self._initial, {"header": head, "pose": there})

    async def go(self, goal: Pose, seconds: float = DRIVE_SECONDS) -> None:
        """Drive to a place, and wait (for s at most) until it is there; cancelling cancels that.

        Raises:
            DeviceError: nobody takes goals, there is no way, it took longer, another goal came, or
                the link was lost (the goal is cancelled when it is back).
        """
        await self.cancel(wait=False)
        place = within(goal, self._origin)
        target = {"header": header(self._frame, self._bridge.ros), "pose": pose_message(place)}
        drive = self._drive = _Drive(f"{self._mark}-{next(self._numbers)}")
        self._known[drive.key] = drive
        self.state, self._path, self._since = "driving", "clear", self._bridge.clock()
        if self._bridge.ros == 2:  # it speaks while it drives alone; what it said before is old
            self._newest.restart()
        try:
            if self._bridge.ros == 1:
                await self._send(drive, target)
            else:
                await self._seek(drive, target)
            clock = self._bridge.clock
            if not await awaited(drive.over, clock() + seconds, clock, self._linked):
                raise DeviceError(
                    f"{self.name} was not there within {seconds:g} s."
                    if self._linked()
                    else f"{self.name} does not know how it goes: the link was lost."
                )
            drive.over.result()
            if self._drive is drive:
                self.state = "arrived"
        except BaseException:
            if self._drive is drive:
                self.state = "failed"
            self._give_up(drive)
            raise
        finally:
            del self._known[drive.key]
            if self._drive is drive:
                self._drive = None

    async def cancel(self, *, wait: bool = True) -> None:
        """Give up where it drives to, and wait a moment until it has; never raises."""
        drive, self._drive = self._drive, None
        if drive is None:
            return
        self.state = "idle"
        self._give_up(drive)
        if wait and self._linked():
            clock = self._bridge.clock
            await awaited(drive.over, clock() + CANCEL_SECONDS, clock, self._linked)
        drive.end(f"{self.name} was told otherwise meanwhile.")

    def _linked(self) -> bool:
        return self._bridge.connected

    async def _send(self, drive: _Drive, target: Message) -> None:
        """Publish a goal until it is taken; one that came twice is the same to actionlib."""
        ros, clock = self._bridge.ros, self._bridge.clock
        stamp = time_message(0, ros)
        goal = {
            "header": header("", ros),
            "goal_id": {"stamp": stamp, "id": drive.key},
            "goal": {"target_pose": target},
        }
        until = clock() + TAKEN_SECONDS
        while clock() < until and not (drive.over.done() or drive.given_up):
            self._bridge.publish(f"{self._action}/goal", goal)
            if await awaited(drive.taken, min(until, clock() + AGAIN_SECONDS), clock, self._linked):
                return
        if not (drive.over.done() or drive.given_up):
            raise DeviceError(f"{self.name}: nobody takes goals at {self._action}.")

    async def _seek(self, drive: _Drive, target: Message) -> None:
        """Send a goal as an action, over a link of its own."""
        await self._goals.wait_connected(TAKEN_SECONDS)
        if drive.given_up:  # while it was waited for
            return
        goal = self._goals.send_goal(
            self._action,
            "nav2_msgs/NavigateToPose",
            {"pose": target, "behavior_tree": ""},
            lambda values: self._fed(drive, values),
        )
        drive.goal = goal

        def over(done: asyncio.Future[Message]) -> None:
            error = None if done.cancelled() else done.exception()
            drive.lost = isinstance(error, LinkLost)
            drive.end("" if error is None else str(error))
            if error is not None and not drive.lost and not goal.given_up:
                self._path = "none"

        goal.over.add_done_callback(over)

    def _give_up(self, drive: _Drive) -> None:
        """Cancel at the robot; what cannot be cancelled now is as soon as there is a link.

        Where it is lost it is said again, when the goal is heard of.
        """
        drive.given_up = True
        if drive.over.done() and not drive.lost:
            return
        if not self._linked():
            self._orphan = drive
        elif drive.goal is not None:
            self._bridge.cancel_goal(drive.goal)
        elif self._bridge.ros == 1:
            self._call_off(drive.key)

    def _call_off(self, key: str) -> None:
        """Cancel a goal of ROS 1."""
        identity = {"stamp": time_message(0, 1), "id": key}
        with suppress(DeviceError):
            self._bridge.publish(f"{self._action}/cancel", identity, urgent=True)

    def _give_up_orphan(self) -> None:
        drive, self._orphan = self._orphan, None
        if drive is not None:
            drive.lost = True
            self._give_up(drive)

    def _hear_status(self, message: Message) -> None:
        self._newest.take(None)
        for status in message["status_list"]:
            self._told(status)

    def _hear_result(self, message: Message) -> None:
        self._told(message["status"])

    def _told(self, status: Message) -> None:
        """Hear what became of a goal; those of others are none of our business.

        A goal of ours that nobody wants is given up again: a cancellation can be lost, and a
        process of ours that was killed could say none.
        """
        key, code = status["goal_id"]["id"], status["status"]
        drive = self._known.get(key)
        wanted = drive is not None and not drive.given_up
        if not wanted and code in UNDER_WAY and str(key).startswith(OURS):
            self._call_off(key)
        if drive is None:
            return
        if not drive.taken.done():
            drive.taken.set_result(None)
        if code == SUCCEEDED:
            drive.end()
        elif code in OVER:
            said = str(status.get("text", ""))
            drive.end(plain(f"{self.name} {OVER[code]}{': ' if said else '.'}{said}"))
            if code == 4:
                self._path = "none"

    def _fed(self, drive: _Drive, values: Message) -> None:
        """Hear of a drive in ROS 2."""
        now = self._bridge.clock()
        if not drive.given_up:
            self._feed(values)
        elif drive.goal is not None and now > drive.told + AGAIN_SECONDS:
            drive.told = now
            self._bridge.cancel_goal(drive.goal)

    def _feed(self, values: Message) -> None:
        """Hear where the robot is on its way."""
        self._newest.take(None)
        if number(values.get("number_of_recoveries", 0)) > 0:
            self._path = "replanned"
        at: Any = values.get("base_position") or values.get("current_pose")
        self._pose.take(seen_from(pose_of(at["pose"]), self._origin))

    def _hear_place(self, message: Message) -> None:
        covariance = message["pose"].get("covariance") or (0.0,) * 36
        self._spread = math.sqrt(max(number(covariance[0]) + number(covariance[7]), 0.0))
        self._pose.take(seen_from(pose_of(message["pose"]["pose"]), self._origin))


class _Drive:
    """A goal on its way: whether it was taken, and what became of it."""

    def __init__(self, key: str) -> None:
        self.key = key
        self.goal: Goal | None = None
        self.lost = self.given_up = False
        self.told = -math.inf  # when it was said again that it is given up
        loop = asyncio.get_running_loop()
        self.taken: asyncio.Future[None] = loop.create_future()
        self.over: asyncio.Future[None] = loop.create_future()
        self.over.add_done_callback(lambda over: over.cancelled() or over.exception())

    def end(self, why: str = "") -> None:
        if not self.over.done():
            if why:
                self.over.set_exception(DeviceError(why))
            else:
                self.over.set_result(None)
