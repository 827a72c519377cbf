"""Calling the expert, and staff, about what halts the robot: who was tried, and who answered.

A person counts as reached only when they have answered: by what called them, or by a button on the
robot's chest screen. Every try, and what came of it, is logged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any, Protocol

from tangy_hw.calling import CallNews, call
from tangy_profiles.contacts import EXPERT, STAFF_ROLE, Contact, Role
from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.game_records import CallMade, CallStage
from tangy_profiles.robot import Robot
from tangy_tui.monitoring.fault import Fault

ANSWER_SECONDS = 300.0
"""How long an answer is waited for."""
FIRST_SECONDS = 3.0
"""How long staff wait before they are told how it stands."""

Way = Callable[[Contact, Mapping[str, Any], float, Callable[[CallNews], None]], None]


AT_ROBOT = "chest screen"
"""The way by which a call is answered at the robot."""


class CallButtons(Protocol):
    """Buttons on a robot's chest screen, by which people say that they come."""

    on_answer: Callable[[str], object]
    """Is called with the key of a button that was pressed, on any thread."""

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        """Show a button for each open call: who is called, by its key."""


@dataclass(frozen=True, slots=True)
class CallState:
    """How a call stands: whom it is for, and what they said, or why it failed.

    If the person was reached by other means, `said` is who says so. `way` is how they answered, if
    it was not what called them.
    """

    role: Role
    contact: Contact
    stage: CallStage
    said: str = ""
    way: str = ""

    @property
    def over(self) -> bool:
        """Whether the person knows of the fault."""
        return self.stage in ("answered", "reached")


class Calls:
    """The calls about what halts a robot in the present game."""

    def __init__(
        self,
        robot: Robot,
        log: Callable[[EventRecord], object],
        way: Way = call,
        *,
        buttons: CallButtons | None = None,
    ) -> None:
        """Prepare.

        Args:
            robot: whose file names whom to call.
            log: keeps what was tried.
            way: sends a message and waits for an answer.
            buttons: those of the robot's chest screen, if it has one.
        """
        self._contacts = {EXPERT: robot.expert, STAFF_ROLE: robot.staff}
        self._title = robot.title
        self._log = log
        self._way = way
        self._states: dict[Role, CallState] = {}
        self._fault: Fault | None = None
        self._lock = threading.Lock()
        self._buttons = buttons
        if buttons is not None:
            buttons.on_answer = self._answered_at_robot

    def state(self, role: Role) -> CallState | None:
        """Return how the call to somebody about the present fault stands, None if none was made."""
        return self._states.get(role)

    def to_call(self, role: Role) -> Contact | None:
        """Return who would be called now: nobody if it is under way, was answered, or cannot be."""
        contact, there = self._contacts[role], self._states.get(role)
        if contact is None or not contact.reachable:
            return None
        return contact if there is None or there.stage == "failed" else None

    def begin(self, fault: Fault) -> None:
        """Take it that another fault halts the robot: staff are called, if that can be done."""
        with self._lock:
            self._fault = fault
            self._states.clear()
        self.call(STAFF_ROLE, fault)

    def end(self) -> None:
        """Take it that nothing halts the robot any more: nobody needs to answer."""
        with self._lock:
            self._fault = None
            self._states.clear()
        self._offer()

    def call(self, role: Role, fault: Fault, wait: float = 0.0) -> CallState | None:
        """Call somebody about a fault, unless that is under way or was answered.

        Args:
            role: whom.
            fault: about what.
            wait: for how many s the first news is waited for.

        Returns:
            How it stands, None if the robot's file names nobody who can be called.
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
        """Take it from staff that somebody was reached; return whether anybody is named."""
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
            "text": f"{self._title}: {fault.unnamed}",
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
        """Show a button for each call that nobody has answered."""
        if self._buttons is not None:
            with self._lock:
                waits = [one for one in self._states.values() if not one.over]
                offered = {self._key(one.role): one.contact.name for one in waits}
            self._buttons.offer_calls(offered)

    def _key(self, role: Role) -> str:
        """Return the key of the button for a call about the present fault."""
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
        with suppress(TangyError):  # a log that is full keeps nobody from being called
            self._log(made)


def _way_of(contact: Contact) -> str:
    """Say by what somebody is called, without what an address may hold of passwords."""
    return "command" if contact.command else contact.url.partition(":")[0] or "telephone"
