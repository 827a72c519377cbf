"""All cameras of a robot at once: their states, pictures, cards, and their end."""

from __future__ import annotations

import asyncio
import os
from pathlib import Path

import cv2
import numpy as np
import pytest

from tangy_hw.drivers.camera_source import CameraError
from tangy_hw.perception.camera_hub import CameraHub, camera_sources
from tangy_profiles.activity import Activity
from tangy_profiles.card_face import numbers_of
from tangy_profiles.robot import load_robot
from tangy_sim.rendering.card_frames import CardCamera, View
from tests.hw.pictures import room, seen
from tests.real.camera_server import CameraServer
from tests.support.terminal import PATIENCE
from tests.support.waiting import until

MARKED = 0b00100_01010_10001_00000_11111


@pytest.fixture(scope="module")
def cards(tmp_path_factory: pytest.TempPathFactory, activity: Activity) -> Path:
    """A folder of pictures of card 17 from a camera whose picture always varies."""
    folder = tmp_path_factory.mktemp("cards")
    camera = CardCamera(activity.deck, title=activity.title)
    random = np.random.default_rng(5)
    view = View(pixels=30, noise=1, quality=95, size=(640, 480))
    taken = camera.take(17, camera.chips(random, MARKED), view, random)
    for number in range(6):
        cv2.imwrite(str(folder / f"{number}.png"), seen(taken.picture, random, noise=2))
    return folder


@pytest.mark.slow
async def test_cards_are_read_only_while_they_are_shown(cards: Path, activity: Activity) -> None:
    robot = load_robot()
    sources = camera_sources(robot, [f"camera={cards}"])
    async with CameraHub(robot, sources, activity.deck) as sensors:
        await sensors.settled(PATIENCE)
        assert sensors.cards.stamp is None  # nobody has looked
        with sensors.reading_cards():
            await until(lambda: sensors.cards.last)
        last = sensors.cards.last
        assert last is not None and sensors.cards.problem == ""
        assert (last.card, last.marked, last.hidden) == (17, MARKED | activity.deck.free, 0)
        assert last.numbers == numbers_of(activity.deck, 17)


@pytest.mark.slow
async def test_a_picture_without_a_card_keeps_the_last_card(
    cards: Path, activity: Activity, tmp_path: Path
) -> None:
    for number in range(8):
        if number < 2:
            (tmp_path / f"{number}.png").write_bytes((cards / f"{number}.png").read_bytes())
        else:
            cv2.imwrite(str(tmp_path / f"{number}.png"), room(number, 640, 480))
    robot = load_robot()
    sources = camera_sources(robot, [f"camera={tmp_path}"])
    async with CameraHub(robot, sources, activity.deck) as sensors:
        with sensors.reading_cards():
            await until(lambda: sensors.cards.last)
            await until(lambda: sensors.cards.problem)
        assert sensors.cards.last is not None and sensors.cards.last.card == 17
        assert sensors.cards.problem == "no card in sight"


@pytest.mark.slow
async def test_each_camera_has_a_state_and_small_pictures() -> None:
    robot = load_robot()
    with CameraServer(1) as one, CameraServer(2) as other:
        other.mode = "covered"
        sources = camera_sources(robot, [f"camera={one.url}", f"requests={other.url}"])
        async with CameraHub(robot, sources) as sensors:
            await until(lambda: sensors.sight("requests").state == "COVERED")
            await until(lambda: sensors.sight("camera").state == "OK")
            readings = {reading.device: reading for reading in sensors.health()}
            assert readings["camera"].state == "OK" and readings["requests"].state == "WARN"
            small = await sensors.picture("camera", (40, 40))
            assert small is not None and (small.width, small.height) == (40, 30)
            later = await sensors.picture("camera", (40, 40), after=small.seq)
            assert later is not None and later.seq > small.seq
            other.mode = "live"
            await until(lambda: sensors.sight("requests").state == "OK")


@pytest.mark.slow
async def test_cameras_close_with_their_last_user() -> None:
    robot = load_robot()
    before = asyncio.all_tasks()
    with CameraServer() as server:
        sensors = CameraHub(robot, camera_sources(robot, [f"camera={server.url}"]))
        async with sensors:
            async with sensors:
                await sensors.settled(PATIENCE)
            assert sensors.sight("camera").state == "OK"
            child = sensors.streams["camera"].pid
            assert child is not None
        with pytest.raises(ProcessLookupError):
            os.kill(child, 0)
        assert asyncio.all_tasks() == before
        async with sensors:
            await until(lambda: sensors.sight("camera").state == "OK")
            await sensors.close()
        assert asyncio.all_tasks() == before


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["camera"], "--camera camera: write DEVICE=SOURCE, as in camera=0."),
        (["camra=0"], "Tangy has no device 'camra'; did you mean 'camera'?"),
        (["camera=0", "camera=1"], "camera was given a source already"),
        (["camera=none.avi"], "none.avi: there is no such file"),
    ],
)
def test_an_invalid_source_is_refused_in_one_sentence(given: list[str], said: str) -> None:
    with pytest.raises(CameraError) as caught:
        camera_sources(load_robot(), given)
    assert said in str(caught.value)


def test_the_profile_names_the_source_of_a_camera(tmp_path: Path) -> None:
    text = load_robot().file.read_text(encoding="utf-8")
    mine = tmp_path / "mine.toml"
    mine.write_text(text.replace("# source = ", "source = "), encoding="utf-8")
    assert camera_sources(load_robot(str(mine)))["camera"].target == "/dev/video0"
    given = camera_sources(load_robot(str(mine)), ["camera=2"])
    assert given["camera"].target == "/dev/video2"
    (tmp_path / "taken").mkdir()
    cv2.imwrite(str(tmp_path / "taken" / "1.png"), room(1, 80, 60))
    for source, found in (("taken", str(tmp_path / "taken")), ("nowhere", None)):
        mine.write_text(text.replace('# source = "/dev/video0"', f'source = "{source}"'))
        if found is not None:
            assert camera_sources(load_robot(str(mine)))["camera"].target == found
        else:
            with pytest.raises(CameraError) as caught:
                camera_sources(load_robot(str(mine)))
            assert str(caught.value).startswith("mine.toml: devices[camera].source = 'nowhere': ")
    assert camera_sources(load_robot()) == {}
