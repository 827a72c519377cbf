"""Picture files that people hand over: read as colour, or refused in one sentence."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Picture = NDArray[np.uint8]

SMALLEST = 60  # pixels to a side
LARGEST = 50_000_000  # pixels
ENDINGS = {
    "PNG": (".png",),
    "JPEG": (".jpg", ".jpeg", ".jpe", ".jfif"),
    "MPO": (".jpg", ".jpeg", ".mpo"),  # as some telephones write them
    "WEBP": (".webp",),
    "BMP": (".bmp", ".dib"),
    "TIFF": (".tif", ".tiff"),
    "PPM": (".ppm", ".pnm"),
}


class PictureError(TangyError):
    """A file gives no picture that can be used; one sentence that names it."""


def read_picture(path: Path) -> Picture:
    """Read a picture file as colour (blue, green, red), turned the way it was taken.

    Raises:
        PictureError: it is missing, no picture, broken off, named as another kind, too small or
            too large, grey, or has transparent parts.
    """
    import numpy as np
    from PIL import Image, ImageOps, UnidentifiedImageError

    name = plain(str(path))
    try:
        if not path.is_file():
            raise PictureError(f"{name}: is not a file." if path.exists() else _missing(name))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of its size, which is asked about here
            with Image.open(path) as file:
                _check(file.format or "", file.size, file.mode, "transparency" in file.info, path)
                file.load()
                turned = ImageOps.exif_transpose(file).convert("RGB")
    except (UnidentifiedImageError, Image.DecompressionBombError) as error:
        if isinstance(error, Image.DecompressionBombError):
            raise PictureError(_too_large(name)) from None
        raise PictureError(f"{name}: is not a picture (PNG, JPEG, WebP, BMP or TIFF).") from None
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        reason = getattr(error, "strerror", None)
        told = f"cannot be read ({reason})" if reason else "breaks off or is damaged"
        raise PictureError(f"{name}: {told}.") from None
    return np.ascontiguousarray(np.asarray(turned, dtype=np.uint8)[..., ::-1])


def _missing(name: str) -> str:
    return f"{name}: there is no such file."


def _too_large(name: str) -> str:
    return f"{name}: has more than {LARGEST // 1_000_000} million pixels; make it smaller first."


def _check(kind: str, size: tuple[int, int], mode: str, transparent: bool, path: Path) -> None:
    """Refuse what is no usual colour picture before its pixels are unpacked."""
    name = plain(str(path))
    if kind not in ENDINGS:
        raise PictureError(f"{name}: is not a picture (PNG, JPEG, WebP, BMP or TIFF).")
    if path.suffix.lower() not in ENDINGS[kind]:
        raise PictureError(f"{name}: is {kind} inside; name it {ENDINGS[kind][0]}.")
    if min(size) < SMALLEST:
        raise PictureError(f"{name}: is only {size[0]} x {size[1]} pixels: too small to see in.")
    if size[0] * size[1] > LARGEST:
        raise PictureError(_too_large(name))
    if "A" in mode or "a" in mode or transparent:
        raise PictureError(f"{name}: has transparent parts; save it without them.")
    if mode in ("1", "L", "I", "F") or mode.startswith("I;"):
        raise PictureError(f"{name}: is grey; colours are needed to see it as Tangy does.")
