"""Reads and writes maps as files: YAML and image, in the format of ROS's map_server.

The YAML names the image, the resolution (metres per pixel), the origin (x, y and yaw of the lower
left corner), and the thresholds of darkness above which a pixel is occupied and below which it is
free; in between it is unknown ("trinary"). Keep-out areas are a second map of this kind beside the
first.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image, UnidentifiedImageError

from tangy_hw.navigation.occupancy import FREE, OCCUPIED, UNKNOWN, Cells, OccupancyMap
from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import open_given, read_given_text
from tangy_profiles.reading import nearest, plain

BLACK, GREY, WHITE = 0, 205, 254
FREE_BELOW, OCCUPIED_ABOVE = 0.196, 0.65  # grey (205) is just darker than .196: unknown
MOST_PIXELS = 40_000_000
LARGEST = 100_000  # bytes of a YAML
LARGEST_PICTURE = 200_000_000  # bytes
FORMATS = ("PPM", "PNG", "BMP", "TIFF", "JPEG")  # by content, whatever the file's name
KEYS = ("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode")
KEEP_OUT = "-keep-out"  # suffix of the files with keep-out areas


class MapFileError(TangyError):
    """An invalid map file; one sentence with file and key."""


@dataclass(frozen=True)
class _Settings:
    image: str
    resolution: float
    origin: tuple[float, float]
    negate: bool
    occupied: float
    free: float


def read_map(path: Path) -> OccupancyMap:
    """Read a map, with its keep-out areas if NAME-keep-out.yaml exists beside NAME.yaml.

    Raises:
        MapFileError: one sentence with the problem and its place.
    """
    found = _read_one(path)
    beside = path.with_name(f"{path.stem}{KEEP_OUT}.yaml")
    if not beside.exists():
        return found
    other = _read_one(beside)
    if other.shape != found.shape or not math.isclose(other.resolution, found.resolution):
        raise MapFileError(plain(f"{beside}: is not of the size of {path.name}."))
    return replace(found, keep_out=other.cells == OCCUPIED)


def write_map(map_: OccupancyMap, path: Path) -> list[Path]:
    """Write NAME.yaml and NAME.pgm, and two more files for keep-out areas if there are any.

    Returns:
        The paths of the written files.

    Raises:
        MapFileError: a file cannot be written.
    """
    written = _write_one(map_, map_.cells, path)
    if map_.keep_out.any():
        cells = np.where(map_.keep_out, OCCUPIED, FREE).astype(np.int8)
        written += _write_one(map_, cells, path.with_name(f"{path.stem}{KEEP_OUT}.yaml"))
    return written


def _write_one(map_: OccupancyMap, cells: Cells, path: Path) -> list[Path]:
    picture = path.with_suffix(".pgm")
    rows, columns = map_.shape
    settings = (
        f"image: {picture.name}\n"
        "mode: trinary\n"
        f"resolution: {map_.resolution:.6g}\n"
        f"origin: [{map_.origin[0]:.6f}, {map_.origin[1]:.6f}, 0.0]\n"
        "negate: 0\n"
        f"occupied_thresh: {OCCUPIED_ABOVE}\n"
        f"free_thresh: {FREE_BELOW}\n"
    )
    head = f"P5\n{columns} {rows}\n255\n".encode()
    try:
        picture.write_bytes(head + grey(cells).tobytes())
        path.write_text(settings, encoding="utf-8")
    except OSError as error:
        place = error.filename or path
        raise MapFileError(plain(f"{place}: cannot be written ({error.strerror}).")) from None
    return [path, picture]


def grey(cells: Cells) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Return a map as an image (rows, columns), north up: free is white, occupied black."""
    shade = np.full(cells.shape, GREY, dtype=np.uint8)
    shade[cells == FREE] = WHITE
    shade[cells == OCCUPIED] = BLACK
    return np.ascontiguousarray(shade[::-1])


def _read_one(path: Path) -> OccupancyMap:
    settings = _settings(path)
    shade = _picture(path.parent / settings.image) / 255.0
    dark = shade if settings.negate else 1.0 - shade
    cells = np.full(dark.shape, UNKNOWN, dtype=np.int8)
    cells[dark < settings.free] = FREE
    cells[dark > settings.occupied] = OCCUPIED
    return OccupancyMap(np.ascontiguousarray(cells[::-1]), settings.resolution, settings.origin)


def _picture(path: Path) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    name = plain(str(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about its size, which is checked here
            with (
                open_given(path, LARGEST_PICTURE, MapFileError) as given,
                Image.open(given, formats=FORMATS) as file,
            ):
                if file.width * file.height > MOST_PIXELS:
                    raise _too_large(name)
                if file.mode not in ("L", "RGB", "1", "P", "RGBA", "LA"):
                    raise MapFileError(f"{name}: has more than 255 shades; save it with 8 bits.")
                return np.asarray(file.convert("L"), dtype=np.float64)
    except Image.DecompressionBombError:  # already when it is opened, if it is far larger
        raise _too_large(name) from None
    except UnidentifiedImageError:
        raise MapFileError(f"{name}: is not a picture of a map (PGM or PNG).") from None
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        reason = getattr(error, "strerror", None)
        told = f"cannot be read ({reason})" if reason else "breaks off or is damaged"
        raise MapFileError(f"{name}: {told}.") from None


def _too_large(name: str) -> MapFileError:
    return MapFileError(f"{name}: has more than {MOST_PIXELS // 10**6} million pixels.")


def _settings(path: Path) -> _Settings:
    name = plain(str(path))
    values = _yaml(read_given_text(path, LARGEST, MapFileError), name)
    image = _one(values, "image", name)
    mode = _one(values, "mode", name, "trinary")
    if mode != "trinary":
        raise MapFileError(plain(f"{name}: mode {mode[:20]!r} is not known here; use trinary."))
    resolution = _number(_one(values, "resolution", name), "resolution", name)
    if not 0.001 <= resolution <= 10:
        raise MapFileError(f"{name}: resolution must be .001 to 10 metres to a pixel.")
    origin = [_number(word, "origin", name) for word in values.get("origin", [])]
    if len(origin) not in (2, 3):
        raise MapFileError(f"{name}: origin must be [x, y, yaw].")
    if len(origin) == 3 and abs(origin[2]) > 1e-9:
        raise MapFileError(f"{name}: origin has a yaw of {origin[2]:g}; turn the picture instead.")
    negate = _one(values, "negate", name, "0").lower()
    if negate not in ("0", "1", "true", "false"):
        raise MapFileError(f"{name}: negate must be 0 or 1.")
    occupied = _number(_one(values, "occupied_thresh", name, "0.65"), "occupied_thresh", name)
    free = _number(_one(values, "free_thresh", name, "0.196"), "free_thresh", name)
    if not 0 <= free <= occupied <= 1:
        raise MapFileError(
            f"{name}: free_thresh must not be above occupied_thresh, nor either off 0 to 1."
        )
    return _Settings(
        image, resolution, (origin[0], origin[1]), negate in ("1", "true"), occupied, free
    )


def _yaml(text: str, name: str) -> dict[str, list[str]]:
    """Parse `key: value`, `key: [a, b]` and `key:` with `- a` lines: all that map files use."""
    values: dict[str, list[str]] = {}
    key = ""
    for number, line in enumerate(text.splitlines(), 1):
        words = _without_comment(line).strip()
        if not words or words in ("---", "..."):
            continue
        if words.startswith("- ") and key:
            values[key].append(_unquoted(words[2:]))
            continue
        key, colon, value = words.partition(":")
        key = _unquoted(key)
        if not colon or key not in KEYS:
            what = nearest(key[:30], KEYS)
            raise MapFileError(plain(f"{name}, line {number}: {key[:30]!r} is not known: {what}"))
        if key in values:
            raise MapFileError(f"{name}, line {number}: {key} stands there twice.")
        value = value.strip()
        listed = value[1:-1].split(",") if value[:1] == "[" and value[-1:] == "]" else [value]
        values[key] = [_unquoted(word) for word in listed if word.strip()]
    return values


def _without_comment(line: str) -> str:
    """Return a line without its comment, a # at its start or after a space."""
    if line.lstrip().startswith("#"):
        return ""
    return line.split(" #", 1)[0]


def _unquoted(word: str) -> str:
    word = word.strip()
    return word[1:-1] if len(word) > 1 and word[0] == word[-1] and word[0] in "'\"" else word


def _one(values: dict[str, list[str]], key: str, name: str, usual: str | None = None) -> str:
    found = values.get(key)
    if not found:
        if usual is None:
            raise MapFileError(f"{name}: {key} is missing.")
        return usual
    if len(found) > 1:
        raise MapFileError(f"{name}: {key} must be one value.")
    return found[0]


def _number(word: str, key: str, name: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise MapFileError(plain(f"{name}: {key} has {word[:20]!r}, which is not a number."))
    return number
