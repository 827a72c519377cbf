"""Sound of half the band, as telephones and many Bluetooth headsets send it, made whole.

The acoustic models expect sound up to 7 kHz. Where there is none above 4 kHz, hisses are missing,
and other words are heard: of known phrases of three voices that were cut at 4 kHz, 54 of 69 were
right without this, 66 with it (tuned voices of `tests/bench/speech.py`, and flite's kal).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.speech.evidence import RATE

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Spectra = NDArray[np.complex128]

WINDOW, HOP = 512, 256  # samples
LOW, HIGH = (300, 3_700), (4_300, 7_000)  # Hz: the bands that are compared
HALF = -50.0  # dB of the high band against the low one, below which there is none
EDGE = 3_900  # Hz, at which the spectrum is mirrored
GAIN, SLOPE = -6.0, -3.0  # dB at the edge, and for every kHz above it
QUIET = 7  # the quietest of so many frames are noise


def widened(pcm: bytes) -> bytes:
    """Return an utterance (16 kHz mono s16le) with its missing upper band made up, if it is.

    The lower band is mirrored at its edge, and falls off above it ("spectral folding", Makhoul and
    Berouti 1979). Sound of the whole band is returned as it is.
    """
    import numpy as np

    samples = np.frombuffer(pcm[: len(pcm) // 2 * 2], "<i2").astype(np.float64)
    padded = np.pad(samples, (WINDOW, 2 * WINDOW))
    count = (len(padded) - WINDOW) // HOP + 1
    window = np.sqrt(np.hanning(WINDOW + 1)[:WINDOW])
    places = np.arange(WINDOW)[None, :] + HOP * np.arange(count)[:, None]
    spectra = np.fft.rfft(padded[places] * window, WINDOW)
    if not len(samples) or not _lacks_upper_band(spectra):
        return pcm
    hertz = np.fft.rfftfreq(WINDOW, 1 / RATE)
    edge = int(np.searchsorted(hertz, EDGE))
    mirrored = np.maximum(edge - 1 - np.arange(len(hertz) - edge), 1)
    gains = 10 ** ((GAIN + SLOPE * (hertz[edge:] - EDGE) / 1000) / 20)
    spectra[:, edge:] = np.conj(spectra[:, mirrored]) * gains
    frames = np.fft.irfft(spectra, WINDOW) * window
    made = np.zeros(HOP * (count + 1))
    made[:-HOP] += frames[:, :HOP].ravel()
    made[HOP:] += frames[:, HOP:].ravel()
    whole = made[WINDOW : WINDOW + len(samples)]
    cut: bytes = np.clip(np.rint(whole), -32_768, 32_767).astype("<i2").tobytes()
    return cut


def _lacks_upper_band(spectra: Spectra) -> bool:
    """Whether there is nothing in the upper band but the noise that is always there."""
    import numpy as np

    power = np.abs(spectra) ** 2
    hertz = np.fft.rfftfreq(WINDOW, 1 / RATE)
    low, high = (
        power[:, (hertz > least) & (hertz < most)].sum(axis=1) for least, most in (LOW, HIGH)
    )
    heard = low > 0
    if not heard.any():
        return False
    low, high = low[heard], high[heard]
    noise = high[np.argsort(low)[: max(3, len(low) // QUIET)]].mean()
    return bool((high - noise).sum() < 10 ** (HALF / 10) * low.sum())
