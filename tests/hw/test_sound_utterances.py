"""Utterances are cut at pauses, however loud the voice and the room are."""

from __future__ import annotations

import numpy as np
import pytest

from tangy_hw.audio.utterances import LONGEST, split
from tangy_hw.audio.wav import RATE
from tests.hw.sounds import bursts, pcm, tone


class TestPauses:
    def test_utterances_are_split_at_pauses(self) -> None:
        found = split(bursts(0.6, 1.0, 0.4))
        assert [len(u) / 2 / RATE for u in found] == pytest.approx([1.0, 1.4, 0.8], abs=0.15)

    def test_a_short_pause_does_not_split(self) -> None:
        assert len(split(bursts(0.5, 0.5, pause=0.3))) == 1

    @pytest.mark.parametrize("loud", [0.5, 0.02])
    def test_quiet_and_loud_voices_are_detected(self, loud: float) -> None:
        quiet = np.zeros(RATE)
        assert len(split(pcm(np.concatenate([quiet, tone(0.6, loud=loud), quiet])))) == 1

    def test_a_voice_from_the_first_sample_is_detected(self) -> None:
        syllables = np.sin(2 * np.pi * 2 * np.arange(RATE) / RATE) ** 2
        assert len(split(pcm(tone(1.0) * syllables))) == 1

    def test_a_voice_above_a_hum_is_an_utterance_and_the_hum_is_not(self) -> None:
        assert len(split(bursts(0.6, noise=0.03))) == 1
        assert split(bursts(noise=0.03, pause=4.0)) == []

    def test_a_voice_is_detected_on_a_device_with_a_bias(self) -> None:
        voice = np.frombuffer(bursts(0.6, 0.6), "<i2") / 32_767
        assert len(split(pcm(voice + 0.4))) == 2

    def test_silence_bias_and_clicks_are_no_utterances(self) -> None:
        assert split(b"") == []
        assert split(bytes(2 * RATE)) == []
        assert split(pcm(np.full(RATE, 0.3))) == []
        assert split(bursts(0.04)) == split(bursts(0.08)) == []

    def test_a_voice_without_pauses_is_cut_into_pieces(self) -> None:
        syllables = np.sin(2 * np.pi * 2 * np.arange(20 * RATE) / RATE) ** 2
        found = split(pcm(tone(20) * syllables))
        assert max(len(u) for u in found) / 2 / RATE == pytest.approx(LONGEST, abs=0.02)
        assert sum(len(u) for u in found) / 2 / RATE > 19
