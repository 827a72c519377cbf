"""Means of the acoustic model for voices whose spectrum differs from those that it was trained on.

The Gaussian means of each phone are moved by an affine transform of each stream of features (MLLR,
Leggetter and Woodland 1995). The transforms come with Tangy; `tests/bench/voice_transforms.py`
estimates them from formant voices.
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Values = NDArray[np.float64]

TRANSFORMS = "other_voices.bin"
PHONES, STREAMS, SIZE = 42, 3, 13  # of the model; SIZE features a stream
MODEL = "en-us/en-us/means"
HEADER_END = b"endhdr\n"
CHECKSUM = b"chksum0 yes\n"
COUNTS = 4 * (5 + STREAMS)  # bytes: byte order, 3 counts, the sizes of the streams, and the length


def moved_means() -> bytes:
    """Return the file of means (pocketsphinx's format) for other voices."""
    import numpy as np
    import pocketsphinx

    head, means = read_means(Path(pocketsphinx.get_model_path(MODEL)).read_bytes())
    stored = files("tangy_tui.speech").joinpath(TRANSFORMS).read_bytes()
    moved = transformed(
        means, np.frombuffer(stored, "<f2").reshape(PHONES, STREAMS, SIZE, 1 + SIZE)
    )
    return head + moved.astype("<f4").tobytes()


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
