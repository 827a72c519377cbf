"""Calls to the expert and to staff about a fault that halts the robot.

A person counts as reached only after answering, by the same channel or by a button on the robot's
chest screen. Every attempt and its result is logged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import Any, Protocol

from tangy_hw.calling import CallNews, call
from tangy_profiles.contacts import EXPERT, STAFF_ROLE, Contact, Role
from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import CallMade, CallStage
from tangy_profiles.robot import Robot
from tangy_tui.monitoring.fault import Fault

ANSWER_SECONDS = 300.0
"""Timeout (s) of an answer."""
FIRST_SECONDS = 3.0
"""How long (s) staff wait for the first news of a call."""

Way = Callable[[Contact, Mapping[str, Any], float, Callable[[CallNews], None]], None]


AT_ROBOT = "chest screen"
"""The `way` of a call answered at the robot."""


class CallButtons(Protocol):
    """Buttons on a robot's chest screen to answer a call."""

    on_answer: Callable[[str], object]
    """Called with the key of the pressed button, on any thread."""

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call (key -> person's name)."""


@dataclass(frozen=True, slots=True)
class CallState:
    """The state of a call: whom it is for, and their answer or the error.

    If the person was reached by other means, `said` is who says so. `way` is how they answered, if
    not by the channel of the call.
    """

    role: Role
    contact: Contact
    stage: CallStage
    said: str = ""
    way: str = ""

    @property
    def over(self) -> bool:
        """Whether the person knows about the fault."""
        return self.stage in ("answered", "reached")


class Calls:
    """The calls about the fault that halts a robot in the current game."""

    def __init__(
        self,
        robot: Robot,
        log: Callable[[EventRecord], object],
        way: Way = call,
        *,
        buttons: CallButtons | None = None,
        notice: str = "",
    ) -> None:
        """Prepare for a robot.

        Args:
            robot: its profile names the contacts.
            log: appends a record to the log.
            way: sends a message and waits for an answer.
            buttons: those of the robot's chest screen, if it has one.
            notice: begins the text of each message.
        """
        self._contacts = {EXPERT: robot.expert, STAFF_ROLE: robot.staff}
        self._title = robot.title
        self._notice = notice
        self._news: SimpleQueue[CallMade] = SimpleQueue()
        self._log = log
        self._way = way
        self._states: dict[Role, CallState] = {}
        self._fault: Fault | None = None
        self._lock, self._offering = threading.Lock(), threading.Lock()
        self._buttons = buttons
        if buttons is not None:
            buttons.on_answer = self._answered_at_robot

    def state(self, role: Role) -> CallState | None:
        """Return the state of a call about the current fault; None if nobody was called."""
        return self._states.get(role)

    def to_call(self, role: Role) -> Contact | None:
        """Return the contact to call now; None if reached, being called, or unreachable."""
        contact, there = self._contacts[role], self._states.get(role)
        if contact is None or not contact.reachable:
            return None
        return contact if there is None or there.stage == "failed" else None

    def take_news(self) -> list[CallMade]:
        """Return the outcomes since the last time, in order."""
        told = []
        with suppress(Empty):
            while True:
                told.append(self._news.get_nowait())
        return told

    def begin(self, fault: Fault) -> None:
        """Start with a new fault that halts the robot, and call staff if possible."""
        with self._lock:
            self._fault = fault
            self._states.clear()
        self.call(STAFF_ROLE, fault)

    def end(self) -> None:
        """Discard all calls, because the robot is no longer halted."""
        with self._lock:
            self._fault = None
            self._states.clear()
        self._offer()

    def call(self, role: Role, fault: Fault, wait: float = 0.0) -> CallState | None:
        """Call a contact about a fault, unless a call is under way or was answered.

        Args:
            role: the contact's role.
            fault: the fault.
            wait: how long (s) to wait for the first news.

        Returns:
            The state of the call; None if the robot's profile has no reachable contact.
        """
        contact = self._contacts[role]
        if contact is None or not contact.reachable:
            return None
        with self._lock:
            there = self._states.get(role)
            if there is not None and self._fault is fault and there.stage != "failed":
                return there
            self._fault = fault
            self._states[role] = CallState(role, contact, "tried")
        self._keep(fault, self._states[role])
        self._offer()
        first = threading.Event()

        def told(news: CallNews) -> None:
            self._take(fault, CallState(role, contact, news.stage, news.said))
            first.set()

        arguments = (contact, self._message(role, fault), ANSWER_SECONDS, told)
        threading.Thread(target=self._way, args=arguments, daemon=True).start()
        first.wait(wait)
        return self._states.get(role)

    def reached(self, role: Role, fault: Fault, by: str) -> bool:
        """Record that staff reached a contact by other means; return whether the contact exists."""
        contact = self._contacts[role]
        if contact is None:
            return False
        self._take(fault, CallState(role, contact, "reached", by))
        return True

    def _message(self, role: Role, fault: Fault) -> dict[str, Any]:
        return {
            "for": role,
            "robot": self._title,
            "fault": fault.code,
            "text": f"{self._notice} {self._title}: {fault.unnamed}".strip(),
            "advice": list(fault.texts[2:]),
        }

    def _take(self, fault: Fault, state: CallState) -> None:
        with self._lock:
            before = self._states.get(state.role)
            current = self._fault is fault
            if current and before is not None and before.over:
                return
            if current:
                self._states[state.role] = state
        self._offer()
        self._keep(fault, state)

    def _offer(self) -> None:
        """Show a button for each call without an answer."""
        if self._buttons is None:
            return
        with self._offering:  # so that the newest offer is the last to arrive
            with self._lock:
                waits = [one for one in self._states.values() if not one.over]
                offered = {self._key(one.role): one.contact.name for one in waits}
            self._buttons.offer_calls(offered)

    def _key(self, role: Role) -> str:
        """Return the button's key for a call about the current fault."""
        return role if self._fault is None else f"{role} {self._fault.id}"

    def _answered_at_robot(self, key: str) -> None:
        with self._lock:
            fault = self._fault
            there = next((s for role, s in self._states.items() if self._key(role) == key), None)
        if fault is not None and there is not None:
            self._take(fault, CallState(there.role, there.contact, "answered", way=AT_ROBOT))

    def _keep(self, fault: Fault, state: CallState) -> None:
        made = CallMade(
            game=fault.game,
            fault=fault.id,
            role=state.role,
            way=state.way or ("key" if state.stage == "reached" else _way_of(state.contact)),
            stage=state.stage,
            said=state.said,
        )
        self._news.put(made)
        with suppress(TangyError):  # a full log must not prevent a call
            self._log(made)


def _way_of(contact: Contact) -> str:
    """Return the channel of a call, without the address, which may contain passwords."""
    return "command" if contact.command else contact.url.partition(":")[0] or "telephone"
