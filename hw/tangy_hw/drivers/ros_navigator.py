"""Robots that find their way themselves: move_base in ROS 1, Nav2's NavigateToPose in ROS 2."""

from __future__ import annotations

import asyncio
import secrets
from contextlib import suppress
from itertools import count
from typing import Any, Literal

from tangy_hw.devices import DeviceError, Pose, Stamped
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
from tangy_profiles.health import OK, Reading
from tangy_profiles.reading import plain

DRIVE_SECONDS = 180.0
TAKEN_SECONDS = 3.0  # in which a goal has been taken, or nobody takes goals there
AGAIN_SECONDS = 0.5  # until a goal that nobody took is sent again: topics of ROS 1 begin late
CANCEL_SECONDS = 2.0  # for which the end of what was cancelled is waited for

SUCCEEDED = 3  # as actionlib_msgs/GoalStatus numbers them
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
    ) -> None:
        """Name its action and topics.

        Args:
            action: "" is /move_base in ROS 1, and /navigate_to_pose in ROS 2.
            frame: of the robot's map.
            origin: where in the robot's map the room's frame is.
            place: where the robot says by geometry_msgs/PoseWithCovarianceStamped that it is.
        """
        self.name = name
        self.state: State = "idle"
        self._bridge, self._frame, self._origin, self._place = bridge, frame, origin, place
        self._action = action or ("/move_base" if bridge.ros == 1 else "/navigate_to_pose")
        self._newest: Newest[None] = Newest(bridge.clock)
        self._pose: Newest[Pose] = Newest(bridge.clock)
        self._path: Path = "clear"
        self._mark, self._numbers = f"tangy-{secrets.token_hex(4)}", count(1)
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
            return Reading(self.name, age, self._bridge.reading().state, {"path": self._path})
        return self._newest.reading(self.name, OK, {"path": self._path})

    async def go(self, goal: Pose, seconds: float = DRIVE_SECONDS) -> None:
        """Drive somewhere in the room, and wait until it is there; cancelling this cancels that.

        Raises:
            DeviceError: nobody takes goals, there is no way, it took longer, another goal came, or
                the link was lost (the goal is cancelled when it is back).
        """
        await self.cancel(wait=False)
        place = within(goal, self._origin)
        target = {"header": header(self._frame, self._bridge.ros), "pose": pose_message(place)}
        drive = self._drive = _Drive(f"{self._mark}-{next(self._numbers)}")
        self._known[drive.key] = drive
        self.state, self._path = "driving", "clear"
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
        while clock() < until and not drive.over.done():
            self._bridge.publish(f"{self._action}/goal", goal)
            if await awaited(drive.taken, min(until, clock() + AGAIN_SECONDS), clock, self._linked):
                return
        if not drive.over.done():
            raise DeviceError(f"{self.name}: nobody takes goals at {self._action}.")

    async def _seek(self, drive: _Drive, target: Message) -> None:
        """Send a goal as an action, over a link of its own."""
        await self._goals.wait_connected(TAKEN_SECONDS)
        goal = self._goals.send_goal(
            self._action,
            "nav2_msgs/NavigateToPose",
            {"pose": target, "behavior_tree": ""},
            self._feed,
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
        """Cancel at the robot; what cannot be cancelled now is as soon as there is a link."""
        if drive.over.done() and not drive.lost:
            return
        if not self._linked():
            self._orphan = drive
        elif drive.goal is not None:
            self._bridge.cancel_goal(drive.goal)
        elif self._bridge.ros == 1:
            identity = {"stamp": time_message(0, 1), "id": drive.key}
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
        """Hear what became of a goal; of those of others nothing is done."""
        drive = self._known.get(status["goal_id"]["id"])
        if drive is None:
            return
        if not drive.taken.done():
            drive.taken.set_result(None)
        code = status["status"]
        if code == SUCCEEDED:
            drive.end()
        elif code in OVER:
            said = str(status.get("text", ""))
            drive.end(plain(f"{self.name} {OVER[code]}{': ' if said else '.'}{said}"))
            if code == 4:
                self._path = "none"

    def _feed(self, values: Message) -> None:
        """Hear where the robot is on its way."""
        self._newest.take(None)
        if number(values.get("number_of_recoveries", 0)) > 0:
            self._path = "replanned"
        at: Any = values.get("base_position") or values.get("current_pose")
        self._pose.take(seen_from(pose_of(at["pose"]), self._origin))

    def _hear_place(self, message: Message) -> None:
        self._pose.take(seen_from(pose_of(message["pose"]["pose"]), self._origin))


class _Drive:
    """A goal on its way: whether it was taken, and what became of it."""

    def __init__(self, key: str) -> None:
        self.key = key
        self.goal: Goal | None = None
        self.lost = False
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
