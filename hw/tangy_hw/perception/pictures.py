"""Reads image files from people in colour, or rejects them with one sentence."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from tangy_profiles.errors import TangyError
from tangy_profiles.given_file import open_given
from tangy_profiles.reading import plain

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from PIL.Image import Image

    Picture = NDArray[np.uint8]

SMALLEST = 60  # pixels per side
LARGEST = 50_000_000  # pixels
LARGEST_FILE = 200_000_000  # bytes: LARGEST pixels need 150 million uncompressed
ENDINGS = {
    "PNG": (".png",),
    "JPEG": (".jpg", ".jpeg", ".jpe", ".jfif"),
    "MPO": (".jpg", ".jpeg", ".mpo"),  # as some phones write them
    "WEBP": (".webp",),
    "BMP": (".bmp", ".dib"),
    "TIFF": (".tif", ".tiff"),
    "PPM": (".ppm", ".pnm"),
}
FORMATS = tuple(kind for kind in ENDINGS if kind != "MPO")  # MPO files begin as JPEG files


class PictureError(TangyError):
    """A file without a usable image; one sentence that names it."""


def read_picture(path: Path, *, colours: bool = False) -> Picture:
    """Read an image file in colour (BGR), rotated as it was taken.

    Grey images get three equal channels, transparent parts a white background, and the file's name
    does not matter. With `colours` all three are rejected: they are signs of an edited image, from
    which a reading would be a guess.

    Raises:
        PictureError: it is missing, not an image, truncated, too small or too large, or without
            colours where they are required.
    """
    import numpy as np
    from PIL import Image, ImageOps, UnidentifiedImageError

    name = plain(str(path))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about its size, which is checked here
            with (
                open_given(path, LARGEST_FILE, PictureError) as given,
                Image.open(given, formats=FORMATS) as file,
            ):
                _check(file.format or "", file.size, name)
                if colours:
                    _check_colours(file, path)
                file.load()
                turned = _coloured(ImageOps.exif_transpose(file))
    except (UnidentifiedImageError, Image.DecompressionBombError) as error:
        if isinstance(error, Image.DecompressionBombError):
            raise PictureError(_too_large(name)) from None
        raise PictureError(f"{name}: is not a picture (PNG, JPEG, WebP, BMP or TIFF).") from None
    except (OSError, SyntaxError, ValueError, EOFError) as error:
        reason = getattr(error, "strerror", None)
        told = f"cannot be read ({reason})" if reason else "breaks off or is damaged"
        raise PictureError(f"{name}: {told}.") from None
    return np.ascontiguousarray(np.asarray(turned, dtype=np.uint8)[..., ::-1])


def _too_large(name: str) -> str:
    return f"{name}: has more than {LARGEST // 1_000_000} million pixels; make it smaller first."


def _check(kind: str, size: tuple[int, int], name: str) -> None:
    """Reject an unusable image before decoding its pixels."""
    if kind not in ENDINGS:
        raise PictureError(f"{name}: is not a picture (PNG, JPEG, WebP, BMP or TIFF).")
    if min(size) < SMALLEST:
        raise PictureError(f"{name}: is only {size[0]} x {size[1]} pixels: too small to see in.")
    if size[0] * size[1] > LARGEST:
        raise PictureError(_too_large(name))


def _check_colours(picture: Image, path: Path) -> None:
    """Reject an image that is not as a camera took it."""
    name, kind = plain(str(path)), picture.format or ""
    if path.suffix.lower() not in ENDINGS[kind]:
        raise PictureError(f"{name}: is {kind} inside; name it {ENDINGS[kind][0]}.")
    if picture.mode.lower().endswith("a") or "transparency" in picture.info:
        raise PictureError(f"{name}: has transparent parts; save it without them.")
    if picture.mode in ("1", "L") or picture.mode[0] in "IF":
        raise PictureError(f"{name}: is grey; colours are needed to see it as Tangy does.")


def _coloured(picture: Image) -> Image:
    """Return an image of any mode in RGB."""
    import numpy as np
    from PIL import Image

    if picture.mode[0] in "IF":  # 16 bits per pixel, or more
        values = np.nan_to_num(np.asarray(picture, dtype=float))
        values = values / 257 if values.max() > 255 else values
        return Image.fromarray(np.clip(values, 0, 255).astype(np.uint8)).convert("RGB")
    if picture.mode.lower()[-1] == "a" or "transparency" in picture.info:
        clear = picture.convert("RGBA")
        return Image.alpha_composite(Image.new("RGBA", clear.size, "white"), clear).convert("RGB")
    return picture.convert("RGB")
