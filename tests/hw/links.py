"""A fake robot process: it records requests, and answers them at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import dataclass, replace
from typing import Any

from tangy_hw.device_protocols import Pose
from tangy_hw.robot_client.robot_state import RobotState
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_profiles.activity import load_activity
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.cards import judge
from tangy_profiles.health import Health, Reading
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room

SECONDS = {"perform": 3.0, "go": 8.0, "card": 0.5, "face": 0.5}
BINGO = load_activity("bingo")


@dataclass
class LaidCard:
    """A card on the table: its number, its marks, and whether it is seen and identified.

    `others` are other cards in sight.
    """

    number: int
    marked: int = 0
    seen: bool = True
    others: tuple[int, ...] = ()
    sure: bool = True


class FakeLink:
    """Stands in for `RobotLink`: `done` are the requests to the robot, in order."""

    def __init__(self, people: tuple[str, ...]) -> None:
        self.setup = RobotSetup("tangy", "bingo", people)
        front = load_room().front
        self.state = RobotState(
            number=1,
            pose=Pose(front.x, front.y, 1.57),
            health=tuple(Reading(d) for d in load_robot().devices),
        )
        self.time = 0.0
        self.done: list[tuple[str, dict[str, Any]]] = []
        self.told: list[str] = []
        self.silent = ""
        self.screen = self.code = self.tablet_page = ""
        self.cards: dict[str, LaidCard] = {}
        self.faces: dict[str, str | None] = {}
        self.place = "front"
        self.breaks: dict[str, str] = {}
        """The reason why the next task is broken off, by task."""
        self.speaks = True
        """Whether its voice works."""
        self.missed: set[str] = set()
        """Places that it fails to reach."""
        self.slow: dict[str, int] = {}
        """How many waits for a task time out, by task, unless the task is cancelled."""
        self._doing: tuple[str, dict[str, Any], Future[dict[str, Any]]] | None = None
        self._called_off = ""
        self.meanwhile: Callable[[str, float], None] = lambda do, time: None
        """Called with a finished task: people act then."""
        self.offered: dict[str, str] = {}
        """The buttons of its chest screen for open calls: the called people, by their keys."""
        self.on_answer: Callable[[str], object] = lambda key: None

    @property
    def said(self) -> list[str]:
        return [what["text"] for do, what in self.done if do == "perform" and what.get("text")]

    def sign(self, *seats: int) -> None:
        asks = tuple((seat, self.time + seat / 100) for seat in seats)
        self.state = replace(self.state, asks=asks)

    def health(self) -> Health:
        return self.state.health

    def ask(self, do: str, **what: Any) -> Future[dict[str, Any]]:
        self.done.append((do, what))
        answer: Future[dict[str, Any]] = Future()
        if do in self.breaks:
            answer.set_exception(Preempted(self.breaks.pop(do)))
            return answer
        if do == "cancel" and self._doing is not None:
            self._called_off = what["why"]
            self.slow[self._doing[0]] = min(2, self.slow[self._doing[0]])  # the task needs a moment
        if do in self.slow:
            self._doing = do, what, answer
        else:
            self._end(do, what, answer)
        return answer

    def _end(self, do: str, what: dict[str, Any], answer: Future[dict[str, Any]]) -> None:
        self.time += what["seconds"] if do == "wait" else SECONDS.get(do, 0.0)
        self.time += what.get("after", 0.0)
        self.meanwhile(do, self.time)
        answer.set_result(self._answer(do, what))

    def do(self, do: str, **what: Any) -> dict[str, Any]:
        return self.ask(do, **what).result()

    def wait(self, asked: Future[dict[str, Any]], seconds: float = 0.0) -> bool:
        if self._doing is not None and asked is self._doing[2]:
            do, what, _ = self._doing
            if self.slow[do] > 0:
                self.slow[do] -= 1
                return False
            self._doing = None
            if self._called_off:
                asked.set_exception(Preempted(self._called_off))
                self._called_off = ""
            else:
                self._end(do, what, asked)
        return asked.done()

    def beat(self) -> RobotState:
        return self.state

    def tell(self, do: str, **_: Any) -> None:
        self.told.append(do)

    def offer_calls(self, calls: Mapping[str, str]) -> None:
        self.offered = dict(calls)

    def stop(self, why: str, by: str = "staff") -> None:
        self.told.append(f"stop: {why}")

    def release(self, by: str = "") -> None:
        self.told.append("release")

    def _answer(self, do: str, what: dict[str, Any]) -> dict[str, Any]:
        if do == "go":
            arrived = what["name"] not in self.missed
            if arrived:
                self.place = what["name"]
                self.state = replace(self.state, pose=Pose(*what["to"]))
            return {"arrived": arrived}
        if do == "perform":
            return {"said": self.speaks and bool(what["text"]), "shown": True}
        if do == "spin":
            return {"found": True}
        if do == "face":
            return {"person": self.faces.get(self.place, self.place)}
        if do == "card":
            return self._card(set(what["called"]))
        return {}

    def _card(self, called: set[int]) -> dict[str, Any]:
        card = self.cards.get(self.place)
        there = () if card is None or not card.seen else (card.number, *card.others)
        if card is None or len(there) != 1:
            unread = {"card": None, "marked": 0, "hidden": 0, "state": "occluded", "problem": "?"}
            return {**unread, "cards": sorted(there), "sure": False}
        numbers = numbers_of(BINGO.deck, card.number, self.setup.deck_seed)
        cells = called_cells(BINGO.deck, numbers, called)
        state = judge(BINGO.card_states, BINGO.deck, card.marked, cells)
        return {
            "card": card.number,
            "marked": card.marked,
            "hidden": 0,
            "state": state,
            "problem": "",
            "cards": [card.number],
            "sure": card.sure,
        }
