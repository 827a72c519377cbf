"""Means of the acoustic model for voices whose spectrum differs from those that it was trained on.

The Gaussian means of each phone are moved by an affine transform of each stream of features (MLLR,
Leggetter and Woodland 1995). The transforms come with Tangy; `tests/bench/voice_transforms.py`
estimates them from formant voices.
"""

from __future__ import annotations

import math
import struct
from base64 import b64decode, b64encode
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Values = NDArray[np.float64]

BASES = ("usual", "other")  # means that the voice of a person begins with
TRANSFORMS = "other_voices.bin"
PHONES, STREAMS, SIZE = 42, 3, 13  # of the model; SIZE features a stream
NO_SPEECH = (0, 1, 32)  # the places of noises and silence among the phones
MODEL = "en-us/en-us/means"
HEADER_END = b"endhdr\n"
CHECKSUM = b"chksum0 yes\n"
COUNTS = 4 * (5 + STREAMS)  # bytes: byte order, 3 counts, the sizes of the streams, and the length


def moved_means() -> bytes:
    """Return the file of means (pocketsphinx's format) for other voices."""
    return _file_of(base_means("other"))


def both_means(voice: str) -> tuple[bytes | None, bytes | None]:
    """Return the means for all speech, and those for speech that fits them badly; None is usual.

    If the voice of the person is known, the second ones are the usual ones: somebody else speaks.

    Raises:
        ValueError: it is no voice.
    """
    return (means_of(voice), None) if voice else (None, moved_means())


def means_of(voice: str) -> bytes:
    """Return the file of means for the voice of a person.

    Raises:
        ValueError: it is no voice.
    """
    import numpy as np

    if not is_voice(voice):
        raise ValueError("This is no voice.")
    base, _, encoded = voice.partition(" ")
    stored = np.frombuffer(b64decode(encoded), "<f2").astype(np.float64)
    transform = stored.reshape(STREAMS, SIZE, 1 + SIZE)
    return _file_of(of_one_voice(base_means(base), transform))


def of_one_voice(means: Values, transform: Values) -> Values:
    """Return means with those of speech moved by one transform (streams, size, 1 + size)."""
    import numpy as np

    moved = transformed(means, np.broadcast_to(transform, (PHONES, *transform.shape)))
    moved[list(NO_SPEECH)] = means[list(NO_SPEECH)]
    return moved


def is_voice(text: str) -> bool:
    """Return whether a text is the voice of a person, as `voice_text` writes it."""
    base, _, encoded = text.partition(" ")
    try:
        values = struct.unpack(f"<{STREAMS * SIZE * (1 + SIZE)}e", b64decode(encoded))
    except (ValueError, struct.error):
        return False
    return base in BASES and all(map(math.isfinite, values))


def voice_text(base: str, transform: Values) -> str:
    """Return a voice as text: the means that it begins with, and their transform."""
    return f"{base} {b64encode(transform.astype('<f2').tobytes()).decode()}"


def base_means(base: str) -> Values:
    """Return the usual means, or those of other voices."""
    import numpy as np

    _, means = _usual()
    if base == "usual":
        return means
    stored = files("tangy_tui.speech").joinpath(TRANSFORMS).read_bytes()
    transforms = np.frombuffer(stored, "<f2").reshape(PHONES, STREAMS, SIZE, 1 + SIZE)
    return transformed(means, transforms)


def _usual() -> tuple[bytes, Values]:
    import pocketsphinx

    return read_means(Path(pocketsphinx.get_model_path(MODEL)).read_bytes())


def _file_of(means: Values) -> bytes:
    return _usual()[0] + means.astype("<f4").tobytes()


def read_means(content: bytes) -> tuple[bytes, Values]:
    """Return the header without a checksum, and the means (phones, streams, densities, size)."""
    import numpy as np

    start = content.index(HEADER_END) + len(HEADER_END) + COUNTS
    values = np.frombuffer(content[start:-4], "<f4").astype(np.float64)  # the checksum follows
    head = content[:start].replace(CHECKSUM, b"")
    return head, values.reshape(PHONES, STREAMS, -1, SIZE)


def transformed(means: Values, transforms: Values) -> Values:
    """Return means moved by the transforms (phones, streams, size, 1 + size), constant first."""
    import numpy as np

    values = transforms.astype(np.float64)
    linear: Values = np.einsum("psij,psdj->psdi", values[..., 1:], means)
    return linear + values[..., None, :, 0]
