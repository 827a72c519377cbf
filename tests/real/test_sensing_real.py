"""The cameras of the robot process: their state, small pictures, and the last card."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest

from tangy_hw.robot_client.client import RobotLink
from tangy_profiles.activity import load_activity
from tangy_profiles.robot import load_robot
from tangy_tui.app.device_simulator import DeviceSimulator
from tangy_tui.app.sensing import LinkedSensors
from tests.real.bench_setup import setup_on
from tests.support.waiting import until

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("robot")]


@pytest.fixture
def link() -> Iterator[RobotLink]:
    people = {"user1": "Ann", "user2": "Ben"}
    bench = DeviceSimulator(seed=1, people=people, stepped=False, activity="bingo", robot="tangy")
    link = RobotLink(setup_on(bench, eyes=True))
    try:
        link.start()
        yield link
    finally:
        link.close()
        bench.close()


async def test_camera_states_pictures_and_cards_arrive_over_the_link(link: RobotLink) -> None:
    robot = load_robot()
    sensors = LinkedSensors(link, robot, load_activity("bingo").deck)
    assert (sensors.cameras, sensors.card_device) == (("camera",), "camera")
    shown = {"link", "base", "laser", "camera"}
    await until(lambda: shown <= {one.device for one in sensors.health()})  # its first report
    assert "arms" not in {one.device for one in sensors.health()}  # this robot has none
    async with sensors:
        await until(lambda: sensors.sight("camera").state == "OK")
        assert sensors.source("camera") == link.setup.cameras["camera"]

        first = await sensors.picture("camera", (40, 30))
        assert first is not None
        assert first.width <= 40 and first.height <= 30 and max(first.width, first.height) >= 30
        assert len(first.pixels) == first.width * first.height * 3
        second = await sensors.picture("camera", (40, 30), after=first.seq)
        assert second is not None and second.seq > first.seq
        assert await sensors.picture("arms", (40, 30)) is None

        assert sensors.cards.stamp is None
        await asyncio.to_thread(link.do, "card", called=[])
        await until(lambda: sensors.cards.stamp is not None)
        assert sensors.cards.problem or sensors.cards.last is not None

        link.close()
        await until(lambda: sensors.sight("camera").state == "DISCONNECTED")
        assert "robot process has ended" in sensors.sight("camera").why
        assert await sensors.picture("camera", (40, 30)) is None
