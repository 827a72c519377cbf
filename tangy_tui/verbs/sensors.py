"""`tangy sensors`: show the state of the robot's devices, and the pictures of its cameras."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.defaults import USUAL_ROBOT
from tangy_tui.text.cameras import NO_SOURCE
from tangy_tui.verbs.cards import DeckSeed
from tangy_tui.verbs.common import (
    REGISTERED,
    ActivityName,
    Ascii,
    Data,
    Json,
    Lines,
    Seed,
    print_json,
)
from tangy_tui.verbs.opening import full_screen, open_workspace

if TYPE_CHECKING:
    from tangy_hw.perception.camera_hub import CameraHub
    from tangy_tui.app.workspace import Workspace
    from tangy_tui.text.sensors import DeviceSummary

Cameras = Annotated[
    list[str] | None,
    typer.Option(
        "--camera",
        metavar="DEVICE=SOURCE",
        help="Where the pictures of a camera of the robot come from, as in camera=0: a camera of "
        "this machine, http://... or rtsp://..., a video, or a folder of pictures. Repeatable.",
    ),
]

RobotName = Annotated[
    str, typer.Option("--robot", help="A robot, or its TOML, which may name sources of cameras.")
]


def sensors(
    camera: Cameras = None,
    robot: RobotName = USUAL_ROBOT,
    seconds: Annotated[
        float, typer.Option(min=0.1, help="How long to watch, without a screen.")
    ] = 3.0,
    plain_lines: Lines = False,
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = "",
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
    ascii_only: Ascii = False,
) -> None:
    """Show the robot's devices and its cameras' pictures.

    By lines the status is 0 if all cameras that have a source work, and 1 if one does not.
    """
    from tangy_hw.perception.camera_hub import sensors_of

    screen = full_screen() and not (plain_lines or as_json)
    with open_workspace(data, activity, REGISTERED, write=False, robot=robot) as workspace:
        deck, folder = workspace.activity.deck, workspace.store.folder
        opened = sensors_of(workspace.robot, deck, folder, camera or (), deck_seed=deck_seed)
        if screen:
            from tangy_tui.ui.run import run_sensors

            raise typer.Exit(run_sensors(workspace, opened, ascii_only=ascii_only))
        found, card = asyncio.run(_look(workspace, opened, seconds))
    live = [told for told in found if told.live]
    works = all(told.well for told in live)
    if as_json:
        from tangy_tui.text.sensors import sensor_document

        devices = [sensor_document(told) for told in found]
        print_json({"works": works, "devices": devices, "card": card["document"]})
    else:
        from tangy_tui.text.sensors import sensor_line

        width = max(len(told.device.label) for told in found)
        for told in found:
            print(sensor_line(told, width))
        for line in card["words"]:
            print(line)
        if not live:
            print(NO_SOURCE)
    if not works:
        raise typer.Exit(1)


async def _look(
    workspace: Workspace, sensors: CameraHub, seconds: float
) -> tuple[list[DeviceSummary], dict[str, Any]]:
    """Watch all devices for some s; return their descriptions, and the last card."""
    from tangy_tui.text.sensors import DeviceSummaries, card_document, card_words

    async with sensors:
        with sensors.reading_cards():
            await asyncio.sleep(seconds)
        found = DeviceSummaries(workspace.robot, sensors).current()
        if not sensors.card_device:
            return found, {"document": None, "words": []}
        cards = sensors.cards
        words = [word for word in card_words(cards) if word]
        return found, {"document": card_document(cards), "words": words}
