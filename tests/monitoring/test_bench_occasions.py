"""When a fault on the bench could be noticed; a fault hidden by another could not."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any, cast

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_profiles.activity import load_activity
from tangy_profiles.game_records import GameBeginning, GameStep
from tangy_profiles.game_world import LIVE
from tangy_profiles.known_cards import KnownCards
from tangy_profiles.past_game import PastGame
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.tracker import Tracker
from tangy_sim.worlds.injection import KINDS
from tangy_tui.app.device_simulator import DeviceSimulator
from tangy_tui.app.simulated_devices_world import BenchedWorld
from tests.hw.links import FakeLink

BINGO, PEOPLE = load_activity("bingo"), ("user1", "user2")


class FakeBench:
    """A bench reduced to its faults."""

    asking: tuple[str, ...] = PEOPLE

    def __init__(self, **faults: str) -> None:
        self.faults = [
            {"kind": kind.replace("_", "-"), "person": who} for kind, who in faults.items()
        ]

    def do(self, what: str, **_: Any) -> dict[str, Any]:
        assert what == "truth"
        return {"truth": {"faults": self.faults, "asking": self.asking}}


def beside_somebody(**faults: str) -> BenchedWorld:
    """Return a world with the robot beside a person who asks, whose card is unread."""
    link = cast(RobotLink, FakeLink(PEOPLE))
    world = BenchedWorld(BINGO, PEOPLE, link, load_robot(), load_room(), seed=1)
    world.on(cast(DeviceSimulator, FakeBench(**faults)))
    for person in PEOPLE:
        world.tracker.ask(person)
    world.tracker.arrive("user1")
    return world


@pytest.mark.parametrize(
    ("kind", "shows", "hidden_by"),
    [
        ("card-out-of-sight", {"never_complies": "user2"}, {"never_complies": "user1"}),
        ("card-out-of-sight", {}, {"never_complies": ""}),
        ("request-withdrawn", {}, {"requests_silent": ""}),
    ],
)
def test_a_fault_hidden_by_another_cannot_show(
    kind: str, shows: dict[str, str], hidden_by: dict[str, str]
) -> None:
    action = BINGO.action(BINGO.behaviours["move card closer"], "user1", None)
    assert beside_somebody(**shows).can_show(KINDS[kind], action)
    assert not beside_somebody(**hidden_by).can_show(KINDS[kind], action)


def test_a_refusing_person_can_show_at_any_request_about_the_card() -> None:
    for name in ("move card closer", "mark numbers"):
        action = BINGO.action(BINGO.behaviours[name], "user1", None)
        world = beside_somebody()
        world.tracker.seen = None if name == "move card closer" else "missing numbers"
        assert world.can_show(KINDS["never-complies"], action)


@pytest.mark.parametrize(
    ("silent", "asking", "shows"),
    [
        ({}, PEOPLE, True),
        ({"requests_silent": ""}, PEOPLE, False),  # no sensor sees it
        ({}, ("user2",), False),  # the sign is down already
    ],
)
def test_a_stuck_sign_can_show_only_if_a_sign_is_seen(
    silent: dict[str, str],
    asking: tuple[str, ...],
    shows: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(FakeBench, "asking", asking)
    closing = next(one for one in BINGO.behaviours.values() if one.closes == "always")
    action = BINGO.action(closing, "user1", None)
    world = beside_somebody(**silent)
    world.tracker.seen = BINGO.card_states[-1].name
    assert world.can_show(KINDS["request-stuck"], action) == shows


class RecordingBench:
    """A bench that records what it is told."""

    def __init__(self) -> None:
        self.told: list[tuple[str, dict[str, Any]]] = []

    def do(self, what: str, **how: Any) -> dict[str, Any]:
        self.told.append((what, how))
        truth = {"faults": [], "asking": [], "spoken": [], "place": "front"}
        return {"truth": truth}


def test_the_people_of_a_resumed_game_keep_their_cards_and_requests() -> None:
    truth = Tracker(BINGO, PEOPLE)
    steps: list[GameStep] = []
    for number, name in enumerate(("greeting", "call number", "call number")):
        before = truth.state()
        truth.executed(BINGO.behaviours[name], succeeded=True)
        if number == 2:
            truth.ask("user2")  # while the number was called
        numbers = (7, 23)[number - 1 : number] if number else ()
        after = truth.state()
        steps.append(
            GameStep(
                game="g", behaviour=name, target=None, numbers=numbers, state=before, after=after
            )
        )
    past = PastGame(
        GameBeginning(game="g", number=1, activity="bingo", people=PEOPLE, world=LIVE),
        datetime.now(UTC),
        tuple(steps),
        cards=KnownCards(seen={"user1": 12}, given={"user2": 30}),
    )
    bench = RecordingBench()
    world = BenchedWorld(
        BINGO, PEOPLE, cast(RobotLink, FakeLink(PEOPLE)), load_robot(), load_room(), seed=1
    )
    world.on(cast(DeviceSimulator, bench))
    world.resume(past)
    rules = [how for what, how in bench.told if what == "rules"]
    cards, called = {"user1": 12, "user2": 30}, [7, 23]
    assert rules[0] == {"called": called, "cards": cards}  # before the first look at a card
    assert {**rules[-1], "called": [*rules[-1]["called"]]} == {
        "called": called, "cards": cards, "asking": ["user2"], "away": [],
        "patterns": list(BINGO.deck.patterns), "together": BINGO.deck.together,
    }  # fmt: skip
