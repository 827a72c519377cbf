"""Sound before decoding: noise reduction and endpoint detection."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tangy_hw.audio.wav import RATE
from tangy_tui.speech.endpointing import MARGIN, WINDOW, Endpoints, pieces
from tangy_tui.speech.noise_reduction import cleaned
from tests.hw.sounds import pcm

Samples = NDArray[np.float64]


def hiss(seconds: float, loud: float, seed: int = 1) -> Samples:
    return np.random.default_rng(seed).normal(0, loud, round(seconds * RATE))


def buzz(seconds: float) -> Samples:
    """A sound like a vowel: a hoarse buzz with two formants."""
    time = np.arange(round(seconds * RATE)) / RATE
    pulses = sum(np.sin(2 * np.pi * 120 * n * time) / n for n in range(1, 30))
    return np.asarray(0.15 * pulses * (1 + 0.2 * np.sin(2 * np.pi * 5 * time)))


def among_quiet(*lengths: float) -> bytes:
    """Buzzes of given lengths, with 1.5 s of quiet before, between and after them."""
    parts = [hiss(1.5, 0.0005)]
    for number, length in enumerate(lengths):
        parts += [buzz(length), hiss(1.5, 0.0005, number + 2)]
    return pcm(np.concatenate(parts))


class TestCleaning:
    @given(st.integers(0, 9_000), st.floats(0, 0.3), st.integers(0, 9))
    def test_cleaning_keeps_the_length_and_adds_no_energy(
        self, count: int, loud: float, seed: int
    ) -> None:
        sound = pcm(np.clip(hiss(count / RATE, loud, seed), -1, 1))
        found = cleaned(sound)
        assert len(found) == len(sound)
        assert energy(found) <= 1.01 * energy(sound) + 1

    def test_cleaning_reduces_noise_and_keeps_the_voice(self) -> None:
        voice = np.concatenate([np.zeros(RATE), buzz(1.0), np.zeros(RATE)])
        noise = hiss(3.0, 0.02)
        found = cleaned(pcm(np.clip(voice + noise, -1, 1)))
        assert energy(found[: 2 * RATE]) < 0.2 * energy(pcm(noise[:RATE]))
        middle = slice(2 * RATE, 4 * RATE)
        assert energy(found[middle]) == pytest.approx(energy(pcm(voice)[middle]), rel=0.15)

    @pytest.mark.parametrize("seconds", [0.0, 0.05, 3.0])
    def test_clean_or_short_sound_is_unchanged(self, seconds: float) -> None:
        sound = among_quiet(seconds) if seconds > 1 else pcm(buzz(seconds))
        assert cleaned(sound) == sound


class TestEndpoints:
    @pytest.mark.parametrize("size", [2, 640, 961, 3_200, 1 << 20])
    def test_an_utterance_is_found_in_chunks_of_any_size(self, size: int) -> None:
        stream = among_quiet(1.0)
        endpoints = Endpoints()
        marks = [
            (began, over)
            for place in range(0, len(stream), size)
            for began, _, over in endpoints.feed(stream[place : place + size])
        ]
        assert [began for began, _ in marks].count(True) == 1
        assert [over for _, over in marks].count(True) == 1
        assert endpoints.begin == pytest.approx(1.5, abs=0.25)
        assert endpoints.end == pytest.approx(2.5, abs=0.25)

    def test_an_utterance_keeps_the_quiet_around_it(self) -> None:
        stream = among_quiet(1.0)
        endpoints = Endpoints()
        for place in range(0, len(stream), 960):
            over = [over for _, _, over in endpoints.feed(stream[place : place + 960])]
            if any(over):
                break
        said = endpoints.utterance()
        begin = endpoints.taken - len(said)
        assert stream[begin : endpoints.taken] == said
        assert begin / 2 / RATE == pytest.approx(endpoints.begin - MARGIN, abs=0.001)
        assert len(said) / 2 / RATE == pytest.approx(MARGIN + 1 + WINDOW, abs=0.25)

    def test_a_long_silence_is_not_kept(self) -> None:
        endpoints = Endpoints()
        for seed in range(40):
            assert list(endpoints.feed(pcm(hiss(1.0, 0.0005, seed)))) == []
        assert endpoints.taken == pytest.approx(40 * 2 * RATE, abs=960)
        assert len(endpoints.recent) <= 2 * RATE * (WINDOW + MARGIN) + 2

    def test_the_end_of_the_stream_ends_an_utterance(self) -> None:
        stream = among_quiet(1.0)[: 2 * RATE * 2 + 100]
        endpoints = Endpoints()
        heard = b"".join(speech for _, speech, _ in endpoints.feed(stream))
        assert endpoints.speaking
        heard += endpoints.finish()
        assert endpoints.taken == len(stream)
        assert len(heard) / 2 / RATE == pytest.approx(0.5, abs=0.25)

    def test_pieces_of_a_recording_keep_a_margin(self) -> None:
        found = pieces(among_quiet(0.8, 1.2))
        expected = [(1.5 - MARGIN, 2.3 + MARGIN), (3.8 - MARGIN, 5.0 + MARGIN)]
        assert np.ravel(found) == pytest.approx(np.ravel(expected), abs=0.25)

    def test_a_long_recording_is_split(self) -> None:
        found = pieces(among_quiet(1.0) * 60)  # 4 minutes; it once took quadratic time
        assert len(found) == 60

    @pytest.mark.parametrize("sound", [b"", b"\0", bytes(640), bytes(8 * RATE)])
    def test_silence_has_no_pieces(self, sound: bytes) -> None:
        assert pieces(sound) == []


def energy(sound: bytes) -> float:
    return float((np.frombuffer(sound, "<i2").astype(np.float64) ** 2).mean()) if sound else 0.0
