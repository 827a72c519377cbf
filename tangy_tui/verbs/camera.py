"""`tangy camera` and `tangy capture`: check a camera, and record its pictures."""

from __future__ import annotations

import asyncio
import sys
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from tangy_profiles.card_face import USUAL_SEED
from tangy_profiles.defaults import DEFAULT_ACTIVITY
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text.cameras import no_picture, pictures_in, rate_words
from tangy_tui.text.sensors import CAMERA_STATES
from tangy_tui.verbs.cards import DeckSeed
from tangy_tui.verbs.common import ActivityName, Data, Json, Seed, print_json

if TYPE_CHECKING:
    from tangy_hw.drivers.camera import Frame
    from tangy_hw.drivers.camera_recorder import Reader
    from tangy_hw.drivers.camera_source import CameraSource
    from tangy_hw.drivers.camera_state import Sight

SOURCES = "0 or /dev/video0, http://... or rtsp://..., a video, a picture or a folder of them"


def camera(
    source: Annotated[str, typer.Argument(help=f"{SOURCES}.")],
    seconds: Annotated[float, typer.Option(min=0.1, help="How long to watch it.")] = 5.0,
    picture: Annotated[
        Path | None, typer.Option(metavar="FILE.png", help="Keep its last picture there.")
    ] = None,
    log: Annotated[Path | None, typer.Option(help="Where its driver's messages go.")] = None,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Watch a camera, and say what state it is in, and why.

    The status is 0 if pictures came and it works in the end, and 1 if it does not.
    """
    from tangy_hw.drivers.camera_source import find_camera

    if picture is not None and picture.suffix.lower() not in (".png", ".jpg"):
        raise TangyError(plain(f"--picture {picture}: name it .png or .jpg."))
    found = asyncio.run(_watch(find_camera(source), seconds, log, tell=not as_json))
    frame: Frame | None = found.pop("frame")
    if picture is not None and frame is not None:
        _write(frame, picture)
    if as_json:
        print_json(found)
    elif found["frames"]:
        print(rate_words(found["width"], found["height"], found["rate"]))
    if not found["works"]:
        raise typer.Exit(1)


async def _watch(
    source: CameraSource, seconds: float, log: Path | None, *, tell: bool
) -> dict[str, Any]:
    from tangy_hw.drivers.camera import Camera

    began = time.monotonic()
    states: list[dict[str, Any]] = []
    frame: Frame | None = None

    def changed(sight: Sight) -> None:
        at = time.monotonic() - began
        row = {"at": round(at, 2), "state": sight.state, "why": sight.why, **sight.evidence()}
        states.append(row)
        if tell and (sight.state != "ENDED" or frame is not None):
            print(f"{at:5.1f} s  {CAMERA_STATES[sight.state]}{_reason(sight)}", flush=True)

    camera = Camera(source, log=log)
    camera.changed = changed
    stamps: list[float] = []
    first = 0
    async with camera:
        while not camera.over and (left := began + seconds - time.monotonic()) > 0:
            newest = await camera.frame(wait=left)
            if newest is None:
                continue
            if frame is None:
                first = newest.seq
            frame = newest
            stamps.append(newest.stamp)
        sight = camera.sight
    lasted = stamps[-1] - stamps[0] if stamps else 0.0
    well = [row["state"] for row in states if row["state"] != "ENDED"]
    return {
        "source": source.name,
        "works": bool(frame) and bool(well) and well[-1] == "OK",
        "state": sight.state,
        "why": sight.why,
        "evidence": sight.evidence(),
        "frames": len(stamps),
        "width": frame.width if frame else None,
        "height": frame.height if frame else None,
        "rate": round((frame.seq - first) / lasted, 2) if frame and lasted > 0 else 0.0,
        "states": states,
        "frame": frame,
    }


def _reason(sight: Sight) -> str:
    if sight.state == "OK":
        measures = [("brightness", sight.brightness), ("contrast", sight.contrast),
                    ("sharpness", sight.sharpness)]  # fmt: skip
        return ": " + ", ".join(f"{name} {one:.2f}" for name, one in measures if one is not None)
    return f": {sight.why}" if sight.why else ""


def _write(frame: Frame, path: Path) -> None:
    import cv2

    encoded = cv2.imencode(path.suffix.lower(), frame.image())[1].tobytes()
    try:
        path.write_bytes(encoded)
    except OSError as error:
        raise TangyError(plain(f"{path}: cannot be written ({error.strerror}).")) from None


def capture(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Where the pictures go.")],
    source: Annotated[str, typer.Option("--from", metavar="SOURCE", help=f"{SOURCES}.")],
    count: Annotated[int | None, typer.Option(min=1, help="At most this many pictures.")] = None,
    seconds: Annotated[float | None, typer.Option(min=0.1, help="For at most this long.")] = None,
    every: Annotated[
        float | None,
        typer.Option(min=0.0, help="Seconds between pictures: 1, or 0 (all) for a file or folder."),
    ] = None,
    cards: Annotated[
        bool, typer.Option("--cards", help="Read the card in each picture, as read-card does.")
    ] = False,
    deck_seed: DeckSeed = USUAL_SEED,
    activity: ActivityName = DEFAULT_ACTIVITY,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Record pictures of a camera, to label them.

    Ctrl+C ends it.

    Beside each picture is a JSON file with the camera's state, what was "seen" (with --cards) and
    an empty "label": write true there if it was seen rightly, or what is really in the picture.
    Then `tangy read-card --bench DIR` counts. Pictures show people: record them with their consent
    only, and delete them when they are no longer needed.
    """
    from tangy_hw.drivers.camera_source import find_camera

    found = find_camera(source)
    reader = _card_reader(activity, deck_seed) if cards else None
    between = (1.0 if found.live else 0.0) if every is None else every
    if not found.live and between == 0:
        found = find_camera(source, each=True)
    kept: list[dict[str, Any]] = []
    with suppress(KeyboardInterrupt):
        asyncio.run(
            _capture(kept, found, folder, count, seconds, between, reader, tell=not as_json)
        )
    if as_json:
        print_json(kept)
    elif kept:
        print(pictures_in(plain(str(folder))))
    if not kept:
        print(no_picture(found.name), file=sys.stderr)
        raise typer.Exit(1)


async def _capture(
    kept: list[dict[str, Any]],
    source: CameraSource,
    folder: Path,
    count: int | None,
    seconds: float | None,
    every: float,
    reader: Reader | None,
    *,
    tell: bool,
) -> None:
    from tangy_hw.drivers.camera import Camera
    from tangy_hw.drivers.camera_recorder import capture as record

    async with Camera(source) as camera:
        async for known in record(
            camera, folder, count=count, seconds=seconds, every=every, reader=reader
        ):
            kept.append(known)
            if tell:
                print(f"{known['file']}  {CAMERA_STATES[known['state']]}{_card(known)}", flush=True)


def _card_reader(activity: str, deck_seed: int) -> Reader:
    """Return a function that reads the card in a picture, as `tangy read-card --json` does."""
    from tangy_hw.perception.cards.reader import CardReader
    from tangy_profiles.activity import load_activity

    reader = CardReader(load_activity(activity).deck, deck_seed)
    return lambda picture: reader.document(reader.read(picture))


def _card(known: dict[str, Any]) -> str:
    """Describe the card that was read."""
    seen = known["seen"]
    if seen is None:
        return ""
    if seen["card"] is None:
        return ", no card"
    hidden = f", {len(seen['hidden'])} not to be told" if seen["hidden"] else ""
    return f", card {seen['card']}: {len(seen['marked'])} marked{hidden}"
