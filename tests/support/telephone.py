"""A telephone for tests of calls: the test decides the outcome of a call."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tangy_hw.calling import CallNews
from tangy_profiles.contacts import Contact
from tests.support.waiting import wait_until

ANNA = Contact("Anna Berg", "030 901820", url="http://127.0.0.1:9/tangy")
STATION = Contact("Station 2", command=("ring",))


class Line:
    """A line for calls to people; the test decides their outcome."""

    def __init__(self) -> None:
        self.told: dict[str, Callable[[CallNews], None]] = {}
        self.messages: list[Mapping[str, Any]] = []

    def __call__(
        self,
        contact: Contact,
        message: Mapping[str, Any],
        seconds: float,
        told: Callable[[CallNews], None],
    ) -> None:
        self.messages.append(message)
        self.told[contact.name] = told

    def says(self, name: str, stage: Any, said: str = "") -> None:
        wait_until(lambda: name in self.told, "somebody is called")
        self.told[name](CallNews(stage, said))
