"""Live games without a screen: what is said while they are played."""

from __future__ import annotations

from typing import cast

from tangy_hw.robot_link import RobotLink
from tangy_hw.world import LiveWorld
from tangy_tui.house import House
from tangy_tui.learning.policy import Policy
from tangy_tui.live.playing import LiveGames
from tangy_tui.monitoring.supervision import Event
from tests.hw.links import FakeLink, LaidCard

PEOPLE = ("user1", "user2", "user3", "user4")


def test_it_is_said_once_in_each_game_who_sits_where_somebody_else_does(
    house: House, learnt: Policy
) -> None:
    link = FakeLink(PEOPLE)
    link.cards["user2"] = LaidCard(7)
    link.faces["user2"] = "user4"
    world = LiveWorld(
        house.activity,
        PEOPLE,
        cast(RobotLink, link),
        house.robot,
        house.room,
        seed=1,
        names=house.names,
        knows_faces=True,
    )
    game = house.supervision(learnt, 1, world=world)
    played = LiveGames(house, game)
    lines: list[str] = []

    def tell(events: list[Event]) -> None:
        lines.extend(played.lines(events))
        if game.steps in (2, 12):
            link.sign(2)
        elif world.tracker.place == "user2":
            link.sign()  # no sign is up any more

    played.play(range(2), expert=False, tell=tell)
    said = [line for line in lines if "sits at" in line]
    assert len([line for line in lines if "navigate to user (User 2)" in line]) == 4
    assert said == ["User 4 sits at User 2's place: Tangy speaks to User 4."] * 2
