"""The robot's own navigation: move_base in ROS 1, Nav2's NavigateToPose in ROS 2."""

from __future__ import annotations

import asyncio
import math
import secrets
from contextlib import suppress
from itertools import count
from typing import Any, Literal

from tangy_hw.device_protocols import DeviceError, Pose, Stamped
from tangy_hw.drivers.completion import Completion
from tangy_hw.drivers.latest_value import LatestValue, awaited
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
from tangy_hw.drivers.rosbridge import Rosbridge
from tangy_hw.drivers.rosbridge_waiting import Goal, LinkLost
from tangy_hw.navigation.localisation import WIDE
from tangy_profiles.health import OK, STALE, DeviceState, Reading
from tangy_profiles.reading import plain

DRIVE_SECONDS = 180.0
TAKEN_SECONDS = 3.0  # until a goal must be accepted
AGAIN_SECONDS = 0.5  # until an unaccepted goal is sent again: ROS 1 topics connect late
CANCEL_SECONDS = 2.0  # timeout for the end of a cancelled goal

TOLD = (0.25, *(0.0,) * 6, 0.25, *(0.0,) * 27, 0.07)  # m2, rad2 (6, 6): of staff's poses

OURS = "tangy-"  # prefix of the ids of ROS 1 goals
UNDER_WAY = (0, 1)  # by their number in actionlib_msgs/GoalStatus
SUCCEEDED = 3
OVER = {2: "was cancelled", 4: "found no way", 5: "refused", 8: "was cancelled", 9: "lost the goal"}

State = Literal["idle", "driving", "arrived", "failed"]
Path = Literal["clear", "replanned", "none"]


class RosNavigator:
    """Drives to poses with the robot's own navigation; a new goal replaces the previous one."""

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
        """Set its action and topics.

        Args:
            bridge: the link to the robot.
            name: its name in the robot's profile.
            action: name of the action; "": /move_base in ROS 1, /navigate_to_pose in ROS 2.
            frame: frame of the robot's map.
            origin: pose of the room's frame in the robot's map.
            place: topic of the robot's pose, geometry_msgs/PoseWithCovarianceStamped.
            initial: topic for the initial pose.
        """
        self.name = name
        self.state: State = "idle"
        self._bridge, self._frame, self._origin = bridge, frame, origin
        self._place, self._initial = place, initial
        self._action = action or ("/move_base" if bridge.ros == 1 else "/navigate_to_pose")
        self._newest: LatestValue[None] = LatestValue(bridge.clock)
        self._pose: LatestValue[Pose] = LatestValue(bridge.clock)
        self._spread = 0.0
        self._since = bridge.clock()  # start of the latest drive
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
        # Some bridges process no other message of a link while it has an active goal, not even a
        # stop.
        self._goals = (
            bridge if bridge.ros == 1 else Rosbridge(bridge.url, clock=bridge.clock, ros=2)
        )
        self._begun = False
        bridge.on_connect(self._give_up_orphan)

    @property
    def pose(self) -> Stamped[Pose] | None:
        """Pose in the room that the robot reports; None before the first."""
        return self._pose.stamped

    async def start(self) -> None:
        """Subscribe to the progress of driving."""
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
        """Cancel the goal, and unsubscribe."""
        await self.cancel()
        self._begun = False
        self._bridge.unsubscribe(self._place, self._hear_place)
        if self._bridge.ros == 1:
            for topic, (_, hears) in self._topics.items():
                self._bridge.unsubscribe(topic, hears)
        else:
            await self._goals.close()

    def reading(self) -> Reading:
        """Return the age of the newest message, and the state of the path.

        ROS 2 navigation is silent without a goal; its age is then that of the link.
        """
        age = self._newest.age
        if self._bridge.ros == 2:
            age = min(age, self._bridge.reading().age) if self.state != "driving" else age
            state, facts = self._bridge.reading().state, {"path": self._path}
            return Reading(self.name, age, state, facts, self._newest.rate)
        return self._newest.reading(self.name, OK, {"path": self._path})

    def localisation(self) -> Reading:
        """Return the age of the pose, and its uncertainty.

        The robot may report its pose only while it moves, so at rest the age is that of the link.
        The fit is not reported: it is 1, or 0 if several places are possible.
        """
        age, link = self._pose.age, self._bridge.reading().age
        age = min(age, self._bridge.clock() - self._since if self.state == "driving" else link)
        fit = 0.0 if self._spread > WIDE else 1.0
        state: DeviceState = STALE if self.pose is None else OK
        facts = {"fit": fit, "spread": self._spread}
        return Reading("localisation", age, state, facts, self._pose.rate)

    def place(self, pose: Pose) -> None:
        """Send the robot its pose, with an uncertainty of some 50 cm.

        Raises:
            DeviceError: there is no link.
        """
        there = {"pose": pose_message(within(pose, self._origin)), "covariance": list(TOLD)}
        head = header(self._frame, self._bridge.ros)
        self._bridge.publish(self._initial, {"header": head, "pose": there})

    async def go(self, goal: Pose, seconds: float = DRIVE_SECONDS) -> None:
        """Drive to a pose, and wait, with a timeout in s; cancelling the wait cancels the goal.

        Raises:
            DeviceError: no server accepts goals, there is no path, a timeout, a new goal, or a lost
                link (the goal is cancelled when it is back).
        """
        await self.cancel(wait=False)
        place = within(goal, self._origin)
        target = {"header": header(self._frame, self._bridge.ros), "pose": pose_message(place)}
        drive = self._drive = _Drive(f"{self._mark}-{next(self._numbers)}")
        self._known[drive.key] = drive
        self.state, self._path, self._since = "driving", "clear", self._bridge.clock()
        if self._bridge.ros == 2:  # it is silent without a goal, so earlier messages are old
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
        """Cancel the goal, and wait a moment for its end; never raises."""
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
        """Publish a goal until it is accepted; actionlib ignores duplicates."""
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
        """Send a goal as a ROS 2 action, over a separate link."""
        await self._goals.wait_connected(TAKEN_SECONDS)
        if drive.given_up:  # while waiting
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
        """Cancel a goal at the robot, or as soon as there is a link.

        A lost cancellation is repeated when the goal is reported again.
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
        """Handle the status of a goal; ignore goals of other clients.

        A goal of ours that is no longer wanted is cancelled again, because a cancellation can be
        lost, and a killed process cannot cancel its goals.
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
        """Handle feedback on a goal of ROS 2."""
        now = self._bridge.clock()
        if not drive.given_up:
            self._feed(values)
        elif drive.goal is not None and now > drive.told + AGAIN_SECONDS:
            drive.told = now
            self._bridge.cancel_goal(drive.goal)

    def _feed(self, values: Message) -> None:
        """Handle the robot's progress."""
        self._newest.take(None)
        if number(values.get("number_of_recoveries", 0)) > 0:
            self._path = "replanned"
        at: Any = values.get("base_position") or values.get("current_pose")
        self._pose.take(seen_from(pose_of(at["pose"]), self._origin))

    def _hear_place(self, message: Message) -> None:
        covariance = message["pose"].get("covariance") or (0.0,) * 36
        self._spread = math.sqrt(max(number(covariance[0]) + number(covariance[7]), 0.0))
        self._pose.take(seen_from(pose_of(message["pose"]["pose"]), self._origin))


class _Drive(Completion):
    """A goal in progress: whether it was accepted, and its result."""

    def __init__(self, key: str) -> None:
        super().__init__()
        self.key = key
        self.goal: Goal | None = None
        self.lost = self.given_up = False
        self.told = -math.inf  # time of the last repeated cancellation
        self.taken: asyncio.Future[None] = asyncio.get_running_loop().create_future()
