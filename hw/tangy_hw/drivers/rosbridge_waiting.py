"""Pending requests to a rosbridge server: services and goals."""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable, Mapping
from contextlib import suppress
from itertools import count
from typing import Any

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.reading import plain

Message = Mapping[str, Any]

UNKNOWN, SUCCEEDED, CANCELED = 0, 4, 5  # by their number in action_msgs/GoalStatus


class LinkLost(DeviceError):
    """No answer, because the link was lost."""


class Goal:
    """A goal of a ROS 2 action in progress."""

    def __init__(self, key: str, action: str, feeds: Callable[[Message], None] | None) -> None:
        """Store the callback for feedback."""
        self.key, self.action, self.feeds = key, action, feeds
        self.given_up = False
        """Whether it was cancelled."""
        self.over: asyncio.Future[Message] = asyncio.get_running_loop().create_future()
        """Result values, or a `DeviceError`."""
        self.over.add_done_callback(lambda over: over.cancelled() or over.exception())


class PendingRequests:
    """Pending requests by their id."""

    def __init__(self) -> None:
        """Start without requests."""
        # Some bridges keep the goals of all clients in one place.
        self._mark = f"tangy {secrets.token_hex(4)}"
        self._numbers = count(1)
        self._calls: dict[str, tuple[str, asyncio.Future[Message]]] = {}
        self._goals: dict[str, Goal] = {}

    def call(self, service: str) -> tuple[str, asyncio.Future[Message]]:
        """Return an id and a future for a service call."""
        key = f"{self._mark} {next(self._numbers)}"
        future: asyncio.Future[Message] = asyncio.get_running_loop().create_future()
        self._calls[key] = service, future
        return key, future

    def goal(self, action: str, feeds: Callable[[Message], None] | None) -> Goal:
        """Note a goal of a ROS action, with a callback for its feedback."""
        goal = Goal(f"{self._mark} {next(self._numbers)}", action, feeds)
        self._goals[goal.key] = goal
        return goal

    def forget(self, key: str) -> None:
        """Stop waiting for an answer."""
        self._calls.pop(key, None)

    def take(self, message: Message) -> None:
        """Handle an answer; ignore one without a pending request."""
        key, values = message.get("id"), message.get("values")
        if not isinstance(key, str):
            return
        if message["op"] == "service_response" and key in self._calls:
            service, future = self._calls.pop(key)
            if future.done():
                return
            if message.get("result", True):
                future.set_result(values if isinstance(values, Mapping) else {})
            else:
                future.set_exception(DeviceError(_says(f"{service} refused", values)))
        elif message["op"] == "action_feedback" and key in self._goals:
            feeds = self._goals[key].feeds
            if feeds is not None and isinstance(values, Mapping):
                with suppress(Exception):  # ignore unreadable feedback
                    feeds(values)
        elif message["op"] == "action_result" and key in self._goals:
            self._end(self._goals.pop(key), message)

    def lose(self, reason: str) -> None:
        """Fail all pending requests with the loss of the link."""
        for name, future in self._calls.values():
            if not future.done():
                future.set_exception(LinkLost(plain(f"{name}: {reason}")))
        for goal in self._goals.values():
            if not goal.over.done():
                goal.over.set_exception(LinkLost(plain(f"{goal.action}: {reason}")))
        self._calls.clear()
        self._goals.clear()

    @staticmethod
    def _end(goal: Goal, message: Message) -> None:
        """Report the result of a goal; its status may be inside the values, or missing."""
        values = message.get("values")
        inside = values.get("status") if isinstance(values, Mapping) else None
        status = message.get("status", inside)
        if goal.over.done():
            return
        if status == SUCCEEDED or (status is None and message.get("result") and not goal.given_up):
            goal.over.set_result(values if isinstance(values, Mapping) else {})
            return
        cancelled = status == CANCELED or (status in (None, UNKNOWN) and goal.given_up)
        what = "was cancelled" if cancelled else "did not succeed"
        goal.over.set_exception(DeviceError(_says(f"{goal.action} {what}", values)))


def _says(what: str, values: object) -> str:
    reason = values if isinstance(values, str) else ""
    return plain(f"{what}: {reason}" if reason else f"{what}.")
