"""WAV files: every usual kind is read, and other files are refused in one sentence."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.audio.wav import RATE, SoundError, decode_wav, read_wav, seconds_cut_off
from tests.hw.sounds import pcm, tone, wav, written


def spectrum_peak(sound: bytes) -> float:
    samples = np.frombuffer(sound, "<i2")
    return float(np.argmax(np.abs(np.fft.rfft(samples)))) * RATE / len(samples)


class TestWav:
    @pytest.mark.parametrize("rate", [8_000, 11_025, 16_000, 22_050, 44_100, 48_000, 96_000])
    @pytest.mark.parametrize("channels", [1, 2])
    def test_any_rate_becomes_16_khz_mono(self, rate: int, channels: int) -> None:
        sound = written(np.repeat(tone(0.5, rate), channels), 16)
        made = decode_wav(wav(sound, rate=rate, channels=channels), "it")
        samples = np.frombuffer(made, "<i2") / 32_767
        assert len(samples) == pytest.approx(RATE / 2, abs=2)
        assert spectrum_peak(made) == pytest.approx(440, abs=4)
        assert samples[1_000:-1_000].std() == pytest.approx(0.5 / 2**0.5, rel=0.02)

    @pytest.mark.parametrize(
        ("bits", "floating"),
        [(8, False), (16, False), (24, False), (32, False), (32, True), (64, True)],
    )
    @pytest.mark.parametrize("extensible", [False, True])
    def test_any_width_gives_the_same_samples(
        self, bits: int, floating: bool, extensible: bool
    ) -> None:
        content = wav(
            written(tone(0.1), bits, floating=floating),
            codec=3 if floating else 1,
            bits=bits,
            extensible=extensible,
        )
        made = np.frombuffer(decode_wav(content, "it"), "<i2")
        exact = np.frombuffer(pcm(tone(0.1)), "<i2")
        assert np.abs(made.astype(int) - exact).max() <= (300 if bits == 8 else 2)

    @pytest.mark.parametrize(
        ("content", "missing"),
        [
            (wav(pcm(tone(0.5))), 0.0),
            (wav(pcm(tone(0.5)))[:-8_000], 0.25),
            (wav(written(tone(0.5, 48_000), 24), bits=24, rate=48_000)[:-36_000], 0.25),
            (wav(pcm(tone(0.5)))[:44], 0.5),
            (wav(pcm(tone(0.5)), size=0xFFFF_FFFF), 0.0),
            (wav(pcm(tone(0.5)), size=0x7FFF_FFE0), 0.0),
            (wav(pcm(tone(0.5)), size=0), 0.0),
            (wav(pcm(tone(0.5)))[:30], 0.0),
            (b"hello", 0.0),
            (b"", 0.0),
        ],
    )
    def test_the_missing_seconds_of_a_truncated_file_are_known(
        self, content: bytes, missing: float, tmp_path: Path
    ) -> None:
        (tmp_path / "a.wav").write_bytes(content)
        assert seconds_cut_off(tmp_path / "a.wav") == pytest.approx(missing)
        assert seconds_cut_off(tmp_path / "none.wav") == 0

    def test_resampling_to_16_khz_does_not_alias(self) -> None:
        made = decode_wav(wav(written(tone(0.5, 48_000, 10_000), 16), rate=48_000), "it")
        assert np.abs(np.frombuffer(made, "<i2"))[1_000:-1_000].max() < 330  # -34 dB

    def test_other_chunks_and_stream_sizes_are_ignored(self) -> None:
        listed = b"LIST" + struct.pack("<I", 5) + b"INFOx\0"
        sound = pcm(tone(0.1))
        for content in (wav(sound, before=listed), wav(sound, size=0xFFFFFFFF)):
            assert decode_wav(content, "it") == sound

    @pytest.mark.filterwarnings("error")
    def test_loud_and_impossible_floats_are_clipped(self) -> None:
        odd = np.array([2.0, -2.0, np.nan, np.inf, -np.inf, 0.0] * 50)
        content = wav(written(odd, 32, floating=True), codec=3, bits=32)
        assert np.abs(np.frombuffer(decode_wav(content, "it"), "<i2").astype(int)).max() <= 32_767

    @pytest.mark.parametrize(
        ("codec", "codes", "samples"),  # as in the tables of G.711
        [
            (7, [0xFF, 0x7F, 0x80, 0x00, 0xF0], [0, 0, 32_124, -32_124, 120]),
            (6, [0xD5, 0x55, 0xAA, 0x2A, 0xC5], [8, -8, 32_256, -32_256, 264]),
        ],
    )
    def test_telephone_codecs_are_read(
        self, codec: int, codes: list[int], samples: list[int]
    ) -> None:
        content = wav(bytes(codes), codec=codec, bits=8)
        assert np.frombuffer(decode_wav(content, "it"), "<i2") == pytest.approx(samples, abs=1)

    def test_a_file_with_a_zero_length_header_is_read_to_its_end(self) -> None:
        sound = pcm(tone(0.1))
        assert decode_wav(wav(sound, size=0), "it") == sound

    @pytest.mark.parametrize(
        ("content", "word"),
        [
            (b"", "breaks off"),
            (b"hello, this is a text file", "not a WAV"),
            (b"\x89PNG\r\n\x1a\n" + bytes(100), "not a WAV"),
            (b"RIFF\x00\x00\x00\x00AVI " + bytes(100), "not a WAV"),
            (wav(pcm(tone(0.1)))[:30], "breaks off"),
            (wav(b""), "no samples"),
            (wav(b"\x01"), "no samples"),
            (wav(bytes(100), codec=0x31, bits=8), "GSM"),
            (wav(bytes(100), bits=12), "12-bit"),
            (wav(bytes(100), channels=0), "0 channels"),
            (wav(bytes(100), rate=1), "1 samples"),
            (wav(bytes(100), rate=1_000_000_000), "1,000,000,000"),
            (b"RIFF\x00\x00\x00\x00WAVEdata\x04\x00\x00\x00abcd", "does not say"),
        ],
    )
    def test_a_file_that_is_no_sound_is_refused_in_one_sentence(
        self, tmp_path: Path, content: bytes, word: str
    ) -> None:
        path = tmp_path / "odd.wav"
        path.write_bytes(content)
        with pytest.raises(SoundError, match=word) as refused:
            read_wav(path)
        assert str(path) in str(refused.value)
        assert str(refused.value).endswith((".", ".wav."))
        assert "\n" not in str(refused.value)

    def test_unreadable_files_are_named(self, tmp_path: Path) -> None:
        for path, word in (
            (tmp_path / "none.wav", "no such file"),
            (tmp_path, "not a file"),
            (tmp_path / "a\0b.wav", "cannot be read"),
            (tmp_path / ("x" * 300 + ".wav"), "cannot be read"),
        ):
            with pytest.raises(SoundError, match=word):
                read_wav(path)

    @given(st.binary(max_size=200))
    def test_garbage_is_read_or_refused_but_never_fails(self, garbage: bytes) -> None:
        head = wav(b"")[: 12 + 8 + 16]
        for content in (garbage, b"RIFF" + garbage, b"RIFF\0\0\0\0WAVE" + garbage, head + garbage):
            try:
                assert isinstance(decode_wav(content, "it"), bytes)
            except SoundError as refused:
                assert str(refused).startswith("it: ")

    @given(st.binary(min_size=16, max_size=16), st.binary(min_size=64, max_size=64))
    def test_any_format_is_read_or_refused_but_never_fails(self, form: bytes, sound: bytes) -> None:
        content = wav(sound)
        try:
            decode_wav(content[:20] + form + content[36:], "it")
        except SoundError as refused:
            assert str(refused).startswith("it: ")
