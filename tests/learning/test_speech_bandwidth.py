"""Bandwidth extension: half-band sound gains an upper band; full-band sound is unchanged."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tangy_tui.speech.bandwidth import widened
from tangy_tui.speech.evidence import RATE


def _speech(seconds: float = 1.0, *, upto: float, seed: int = 1) -> NDArray[np.float64]:
    """Return sound in bursts, like syllables, with nothing above a frequency."""
    chance = np.random.default_rng(seed)
    length = round(seconds * RATE)
    spectrum = np.fft.rfft(chance.normal(size=length))
    spectrum[np.fft.rfftfreq(length, 1 / RATE) > upto] = 0
    bursts = np.sin(2 * np.pi * 3 * np.arange(length) / RATE).clip(0)
    made: NDArray[np.float64] = 3000 * np.fft.irfft(spectrum, length) * bursts
    return made


def _pcm(samples: NDArray[np.float64]) -> bytes:
    return np.clip(np.rint(samples), -32_768, 32_767).astype("<i2").tobytes()


def _share_above(pcm: bytes, hertz: float) -> float:
    power = np.abs(np.fft.rfft(np.frombuffer(pcm, "<i2").astype(float))) ** 2
    high = np.fft.rfftfreq(len(pcm) // 2, 1 / RATE) > hertz
    return float(power[high].sum() / power.sum())


@pytest.mark.parametrize("hiss", [0.0, 2.0])
def test_half_band_sound_gains_an_upper_band_and_keeps_its_lower(hiss: float) -> None:
    samples = _speech(upto=3_600) + hiss * np.random.default_rng(2).normal(size=RATE)
    pcm = _pcm(samples)
    made = widened(pcm)
    assert _share_above(pcm, 4_000) < 1e-4
    assert _share_above(made, 4_000) > 0.01
    before, after = (
        np.fft.rfft(np.frombuffer(one, "<i2").astype(float))[300:3_000] for one in (pcm, made)
    )
    assert np.corrcoef(np.abs(before), np.abs(after))[0, 1] > 0.99


@pytest.mark.parametrize("upto", [5_000, 8_000])
def test_full_band_sound_is_unchanged(upto: float) -> None:
    pcm = _pcm(_speech(upto=upto))
    assert widened(pcm) == pcm


@given(st.binary(max_size=4_000))
def test_widening_keeps_the_number_of_samples(pcm: bytes) -> None:
    assert len(widened(pcm)) // 2 == len(pcm) // 2
