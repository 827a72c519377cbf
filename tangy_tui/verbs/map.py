"""`tangy map`: draw the map for a robot's localisation and navigation."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from tangy_profiles.defaults import USUAL_ROBOT
from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.text import maps
from tangy_tui.verbs.common import Ascii, Data, Json, Seed, print_json
from tangy_tui.verbs.map_drive import drive_for_map
from tangy_tui.verbs.sensors import RobotName

if TYPE_CHECKING:
    from tangy_hw.navigation.agreement import Verdict
    from tangy_hw.navigation.occupancy import OccupancyMap
    from tangy_hw.navigation.revisits import Revisits

YAML = (".yaml", ".yml")


def draw_map(
    source: Annotated[
        Path | None,
        typer.Argument(metavar="[LOG|MAP.yaml]", help="A log of scans (CARMEN), or a map to show."),
    ] = None,
    room: Annotated[
        str | None, typer.Option(metavar="NAME|FILE", help="A room's profile, instead of a log.")
    ] = None,
    people: Annotated[
        int | None, typer.Option(min=0, max=24, help="With --room: how many people sit there.")
    ] = None,
    yaml: Annotated[
        Path | None,
        typer.Option("--yaml", metavar="FILE", help="Write this YAML, and a PGM beside it."),
    ] = None,
    png: Annotated[
        Path | None, typer.Option("--png", metavar="FILE", help="Write a picture to look at.")
    ] = None,
    resolution: Annotated[float, typer.Option(min=0.01, max=0.5, help="Metres to a cell.")] = 0.05,
    match: Annotated[
        bool,
        typer.Option("--match", help="Correct the log's wheel odometry by matching scans."),
    ] = False,
    drive: Annotated[
        bool,
        typer.Option(
            "--drive", help="Drive the robot with the arrow keys, and draw the map of that."
        ),
    ] = False,
    robot: RobotName = USUAL_ROBOT,
    bench: Annotated[
        bool, typer.Option("--bench", help="With --drive: simulate the robot's devices.")
    ] = False,
    ascii_only: Ascii = False,
    seed: Seed = None,
    data: Data = None,
    as_json: Json = False,
) -> None:
    """Draw a map from scans, a drive, or a room's file.

    It writes the map in the format of ROS.

    A log gives the poses that stand in it; `--match` is for logs in which only the wheels counted
    them: it matches the scans, and closes loops. A map that does not close is refused. What
    stands on the floor for the robot but not for its laser, as a table's top, is written beside
    the map, as FILE-keep-out.yaml.

    With `--drive` you drive the robot with the arrow keys, beginning at the front. Tangy records
    the scans in FILE-scans.log, and draws the map from them as with `--match`.
    """
    if drive and (match or source is not None or room is not None):
        raise TangyError(maps.DRIVE_ALONE)
    if not drive and (source is None) == (room is None):
        raise TangyError("Say what to draw: a log of scans or a map, --room NAME, or --drive.")
    if yaml is not None and yaml.suffix not in YAML:
        raise TangyError(plain(f"--yaml {yaml}: name it .yaml."))
    if png is not None and png.suffix.lower() != ".png":
        raise TangyError(plain(f"--png {png}: name it .png."))
    if drive:
        source = drive_for_map(
            yaml, robot=robot, bench=bench, seed=seed or 1, data=data, ascii_only=ascii_only
        )
        match = True
    found: dict[str, Any]
    if room is not None:
        map_, found = _of_room(room, resolution, people)
    elif source is not None and source.suffix in YAML:
        map_, found = _of_file(source)
    elif source is not None:
        tell = not as_json and sys.stderr.isatty()
        map_, found = _of_log(source, resolution, match, png, tell=tell)
    width, depth = map_.size
    found |= {
        "resolution": map_.resolution,
        "origin": [round(corner, 6) for corner in map_.origin],
        "width_m": round(width, 3),
        "depth_m": round(depth, 3),
        "free_m2": round(float((map_.cells == 0).sum()) * map_.resolution**2, 2),
        "occupied_cells": int((map_.cells == 100).sum()),
        "written": _written(map_, yaml, png),
    }
    if as_json:
        print_json(found)
        return
    _show(map_, found, ascii_only)


def _of_room(
    room: str, resolution: float, people: int | None
) -> tuple[OccupancyMap, dict[str, Any]]:
    from tangy_hw.navigation.occupancy import map_of_room
    from tangy_profiles.room import load_room

    loaded = load_room(room)
    return map_of_room(loaded, resolution, people), {"source": "room", "room": loaded.name}


def _of_file(path: Path) -> tuple[OccupancyMap, dict[str, Any]]:
    from tangy_hw.navigation.map_files import read_map

    return read_map(path), {"source": "map", "file": str(path)}


def _of_log(
    path: Path, resolution: float, match: bool, png: Path | None, *, tell: bool
) -> tuple[OccupancyMap, dict[str, Any]]:
    from tangy_hw.navigation.alignment import aligned
    from tangy_hw.navigation.mapping import PlacedScan, sparse
    from tangy_hw.navigation.matched_map import judged, with_loops_closed
    from tangy_hw.navigation.scan_log import read_log

    logged = read_log(path)
    scans = sparse(PlacedScan(one.scan, one.odometry if match else one.pose) for one in logged)

    def done(count: int) -> None:
        if tell and (count % 50 == 0 or count == len(scans)):
            end = "\n" if count == len(scans) else ""
            print(f"\r{count} of {len(scans)} scans matched", end=end, file=sys.stderr, flush=True)

    if match:
        scans = aligned(scans, done)
    drawn = judged(scans, resolution)
    if match:
        drawn = with_loops_closed(drawn, resolution)
    found = drawn.found
    if match and drawn.closes in ("torn", "unknown"):
        _written(drawn.map, None, png)
        _refuse(path, drawn.closes, drawn.share, found, "" if png is None else png.name)
    document = {"source": "log", "file": str(path), "scans": len(logged), "used": len(scans)}
    loops = {"verdict": drawn.closes, "loops_closed": found.closed, "loops_torn": found.torn}
    share = {"contradicted": round(drawn.share, 4), "pose_graph": drawn.by_graph}
    return drawn.map, {**document, "matched": match, **share, **loops}


def _refuse(path: Path, closes: Verdict, share: float, found: Revisits, picture: str) -> NoReturn:
    """Tell why a matched map is rejected, and which picture shows it.

    Raises:
        TangyError: always.
    """
    from tangy_hw.navigation.agreement import TORN

    if closes == "unknown":
        why = maps.unknown_words()
    elif found.tears:
        why = maps.apart_words(found.off, found.torn, found.closed)
    else:
        why = maps.contradicted_words(share, TORN)
    raise TangyError(maps.refusal(str(path), why, picture))


def _written(map_: OccupancyMap, yaml: Path | None, png: Path | None) -> list[str]:
    from tangy_hw.navigation.map_files import grey, write_map

    written = [] if yaml is None else write_map(map_, yaml)
    if png is not None:
        from PIL import Image

        try:
            Image.fromarray(grey(map_.cells)).save(png)
        except OSError as error:
            raise TangyError(plain(f"{png}: cannot be written ({error.strerror}).")) from None
        written.append(png)
    return [str(path) for path in written]


def _show(map_: OccupancyMap, found: dict[str, Any], ascii_only: bool) -> None:
    from tangy_hw.navigation.map_drawing import map_lines

    columns = min(shutil.get_terminal_size().columns, 160)
    encoding = (sys.stdout.encoding or "ascii").lower()
    for line in map_lines(map_, columns, ascii_only=ascii_only or "utf" not in encoding):
        print(line)
    told = (
        f"{found['width_m']:.1f} x {found['depth_m']:.1f} m, {found['free_m2']:.1f} m2 of it free"
    )
    if "scans" in found:
        told += f"; {found['used']} of {found['scans']} scans drawn"
        told += f"; {found['contradicted']:.0%} of the beams contradict the map"
        told += f"; loops: {found['loops_closed']} closed, {found['loops_torn']} torn"
    print(f"{told}.")
    if found["written"]:
        print(plain("Written: " + ", ".join(found["written"])))
