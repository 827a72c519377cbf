"""Speech without the decoder: sound files, pauses, sources, and how sure is sure enough."""

from __future__ import annotations

import asyncio
import os
import pty
import struct
import subprocess
import sys
from collections.abc import AsyncGenerator, Callable
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.microphone import LONGEST, Microphone, Splitter, open_microphone, split
from tangy_tui.learning.speech import UNDERSTOOD, Heard, Recogniser, listen, understand
from tangy_tui.learning.speech_worker import Worker
from tangy_tui.learning.wav import RATE, SoundError, decode_wav, read_wav

BOOK = Phrasebook(load_activity("bingo"), load_people(4))


Samples = NDArray[np.float64]


def tone(seconds: float, rate: int = RATE, hertz: float = 440.0, loud: float = 0.5) -> Samples:
    return loud * np.sin(2 * np.pi * hertz * np.arange(round(seconds * rate)) / rate)


def pcm(samples: Samples) -> bytes:
    return np.rint(samples * 32_767).astype("<i2").tobytes()


def written(samples: Samples, bits: int, *, floating: bool = False) -> bytes:
    if floating:
        return samples.astype(f"<f{bits // 8}").tobytes()
    if bits == 8:
        return np.rint(samples * 127 + 128).astype(np.uint8).tobytes()
    whole = np.rint(samples * (2.0 ** (bits - 1) - 1)).astype("<i4")
    return whole.view(np.uint8).reshape(-1, 4)[:, : bits // 8].tobytes()


def wav(
    sound: bytes,
    *,
    codec: int = 1,
    channels: int = 1,
    rate: int = RATE,
    bits: int = 16,
    extensible: bool = False,
    before: bytes = b"",
    size: int | None = None,
) -> bytes:
    width = bits // 8 * channels
    form = struct.pack(
        "<HHIIHH", 0xFFFE if extensible else codec, channels, rate, rate * width, width, bits
    )
    if extensible:
        form += struct.pack("<HHIH", 22, bits, 0, codec) + bytes(14)
    chunks = b"fmt " + struct.pack("<I", len(form)) + form + before + b"data"
    chunks += struct.pack("<I", len(sound) if size is None else size) + sound
    return b"RIFF" + struct.pack("<I", 4 + len(chunks)) + b"WAVE" + chunks


def bursts(*lengths: float, pause: float = 0.8, noise: float = 0.0) -> bytes:
    """Tones of some lengths in s, with a pause before, between and after them."""
    quiet = np.zeros(round(pause * RATE))
    parts = [quiet]
    for length in lengths:
        parts += [tone(length), quiet]
    sound = np.concatenate(parts)
    return pcm(sound + np.random.default_rng(1).normal(0, noise, len(sound)))


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

    def test_what_16_khz_cannot_hold_is_cut_off_not_folded(self) -> None:
        made = decode_wav(wav(written(tone(0.5, 48_000, 10_000), 16), rate=48_000), "it")
        assert np.abs(np.frombuffer(made, "<i2"))[1_000:-1_000].max() < 330  # -34 dB

    def test_other_chunks_and_the_sizes_of_streams_are_passed_over(self) -> None:
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
        ("content", "word"),
        [
            (b"", "breaks off"),
            (b"hello, this is a text file", "not a WAV"),
            (b"\x89PNG\r\n\x1a\n" + bytes(100), "not a WAV"),
            (b"RIFF\x00\x00\x00\x00AVI " + bytes(100), "not a WAV"),
            (wav(pcm(tone(0.1)))[:30], "breaks off"),
            (wav(b""), "no samples"),
            (wav(b"\x01"), "no samples"),
            (wav(bytes(100), codec=7, bits=8), "mu-law"),
            (wav(bytes(100), bits=12), "12-bit"),
            (wav(bytes(100), channels=0), "0 channels"),
            (wav(bytes(100), rate=1), "1 samples"),
            (wav(bytes(100), rate=1_000_000_000), "1,000,000,000"),
            (b"RIFF\x00\x00\x00\x00WAVEdata\x04\x00\x00\x00abcd", "does not say"),
        ],
    )
    def test_what_is_no_sound_is_refused_in_a_sentence(
        self, tmp_path: Path, content: bytes, word: str
    ) -> None:
        path = tmp_path / "odd.wav"
        path.write_bytes(content)
        with pytest.raises(SoundError, match=word) as refused:
            read_wav(path)
        assert str(path) in str(refused.value)
        assert str(refused.value).endswith((".", ".wav."))
        assert "\n" not in str(refused.value)

    def test_files_that_cannot_be_read_are_named(self, tmp_path: Path) -> None:
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


class TestPauses:
    def test_utterances_are_split_at_pauses(self) -> None:
        found = split(bursts(0.6, 1.0, 0.4))
        assert [len(u) / 2 / RATE for u in found] == pytest.approx([1.0, 1.4, 0.8], abs=0.15)

    def test_a_short_pause_does_not_split(self) -> None:
        assert len(split(bursts(0.5, 0.5, pause=0.3))) == 1

    @pytest.mark.parametrize("loud", [0.5, 0.02])
    def test_quiet_and_loud_voices_are_found(self, loud: float) -> None:
        quiet = np.zeros(RATE)
        assert len(split(pcm(np.concatenate([quiet, tone(0.6, loud=loud), quiet])))) == 1

    def test_a_recording_that_begins_with_the_voice_is_found(self) -> None:
        syllables = np.sin(2 * np.pi * 2 * np.arange(RATE) / RATE) ** 2
        assert len(split(pcm(tone(1.0) * syllables))) == 1

    def test_a_hum_is_not_an_utterance_but_a_voice_above_it_is(self) -> None:
        assert len(split(bursts(0.6, noise=0.03))) == 1
        assert split(bursts(noise=0.03, pause=4.0)) == []

    def test_a_voice_is_found_on_a_device_with_a_bias(self) -> None:
        voice = np.frombuffer(bursts(0.6, 0.6), "<i2") / 32_767
        assert len(split(pcm(voice + 0.4))) == 2

    def test_silence_bias_and_clicks_hold_none(self) -> None:
        assert split(b"") == []
        assert split(bytes(2 * RATE)) == []
        assert split(pcm(np.full(RATE, 0.3))) == []
        assert split(bursts(0.04)) == split(bursts(0.08)) == []

    def test_what_never_pauses_is_cut(self) -> None:
        syllables = np.sin(2 * np.pi * 2 * np.arange(20 * RATE) / RATE) ** 2
        found = split(pcm(tone(20) * syllables))
        assert max(len(u) for u in found) / 2 / RATE == pytest.approx(LONGEST, abs=0.02)
        assert sum(len(u) for u in found) / 2 / RATE > 19

    @given(st.lists(st.integers(1, 9_000), min_size=1, max_size=40))
    def test_how_the_sound_arrives_makes_no_difference(self, sizes: list[int]) -> None:
        sound = bursts(0.3, 0.5, pause=0.6)
        splitter, found, place = Splitter(), [], 0
        for size in (*sizes, len(sound)):
            found += splitter.feed(sound[place : place + size])
            place += size
        whole = Splitter()
        assert found + splitter.finish() == whole.feed(sound) + whole.finish()


def _write(descriptor: int, content: bytes) -> None:
    with os.fdopen(descriptor, "wb") as pipe:
        pipe.write(content)


async def _next(microphone: Microphone) -> bytes:
    return await anext(microphone)


async def heard(microphone: Microphone) -> list[bytes]:
    try:
        return [utterance async for utterance in microphone]
    finally:
        await microphone.close()


class TestSources:
    async def test_a_file_gives_its_utterances(self, tmp_path: Path) -> None:
        path = tmp_path / "two.wav"
        path.write_bytes(wav(bursts(0.6, 0.6)))
        assert await heard(open_microphone(str(path))) == split(bursts(0.6, 0.6))

    def test_a_file_that_is_no_sound_is_refused_at_once(self, tmp_path: Path) -> None:
        with pytest.raises(SoundError, match="no such file"):
            open_microphone(str(tmp_path / "none.wav"))

    @pytest.mark.parametrize(
        "content",
        [
            bursts(0.6, 0.6),
            wav(bursts(0.6, 0.6), size=0xFFFFFFFF),
            wav(
                written(np.repeat(np.frombuffer(bursts(0.6, 0.6), "<i2") / 32_767, 6), 16),
                rate=48_000,
                channels=2,
            ),
        ],
        ids=["raw", "wav", "wav at 48 kHz in stereo"],
    )
    async def test_standard_input_may_be_raw_or_a_wav(self, content: bytes) -> None:
        reading, writing = os.pipe()
        writer = Thread(target=_write, args=(writing, content))
        writer.start()
        try:
            assert len(await heard(open_microphone("-", stdin=reading))) == 2
        finally:
            os.close(reading)
            writer.join()

    async def test_standard_input_may_be_a_file(self, tmp_path: Path) -> None:
        path = tmp_path / "two.raw"
        path.write_bytes(bursts(0.6, 0.6))
        with path.open("rb") as file:
            assert len(await heard(open_microphone("-", stdin=file.fileno()))) == 2

    async def test_nothing_on_standard_input_is_the_end(self) -> None:
        with open(os.devnull, "rb") as nothing:  # noqa: ASYNC230, PTH123
            assert await heard(open_microphone("-", stdin=nothing.fileno())) == []

    def test_a_terminal_is_no_sound(self) -> None:
        parent, child = pty.openpty()
        try:
            with pytest.raises(SoundError, match="terminal"):
                open_microphone("-", stdin=child)
        finally:
            os.close(parent)
            os.close(child)

    @pytest.fixture
    def record(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
        """Install an arecord that sends a sound, and then runs a line of shell."""
        monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")

        def install(sound: bytes, then: str) -> None:
            raw, script = tmp_path / "sound.raw", tmp_path / "arecord"
            raw.write_bytes(sound)
            script.touch(mode=0o755)
            script.write_text(
                f"#!/bin/sh\necho $$ > '{tmp_path}/pid'\n"
                f'[ "$*" = "-q -t raw -f S16_LE -r 16000 -c 1" ] && cat "{raw}"\n{then}\n'
            )

        return install

    async def test_the_local_microphone_is_recorded_from(self, record: Callable[..., None]) -> None:
        record(bursts(0.6, 0.6), "printf 'busy \\033[31mdevice' >&2; exit 1")
        microphone = open_microphone("arecord")
        found = [await anext(microphone), await anext(microphone)]
        assert found == split(bursts(0.6, 0.6))
        with pytest.raises(SoundError, match="stopped: busy") as stopped:
            await anext(microphone)
        assert "\033" not in str(stopped.value)
        with pytest.raises(StopAsyncIteration):
            await anext(microphone)

    async def test_the_recorder_ends_with_the_microphone(
        self, record: Callable[..., None], tmp_path: Path
    ) -> None:
        record(bursts(0.6), "exec cat /dev/zero")
        microphone = open_microphone("arecord")
        await anext(microphone)
        await microphone.close()
        with pytest.raises(ProcessLookupError):
            os.kill(int((tmp_path / "pid").read_text()), 0)

    async def test_a_recorder_ends_even_if_nobody_took_what_it_sent(
        self, record: Callable[..., None]
    ) -> None:
        record(bursts(0.6), "exec cat /dev/zero")
        chunks = open_microphone("arecord")._chunks
        taken = 0
        while taken < len(bursts(0.6)) + 100_000:  # from here on it floods
            taken += len(await anext(chunks))
        for _ in range(2_000):  # turns of the loop, in which all buffers fill
            await asyncio.sleep(0)
        await asyncio.wait_for(chunks.aclose(), 10)

    async def test_a_machine_without_a_recorder_is_told_what_to_do(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PATH", str(tmp_path))
        with pytest.raises(SoundError, match="alsa-utils"):
            await anext(open_microphone("arecord"))


class TestShutting:
    async def test_what_the_robot_says_is_not_heard(self) -> None:
        said, arriving = bursts(0.6), asyncio.Queue[bytes]()
        taken = asyncio.Event()

        async def chunks() -> AsyncGenerator[bytes, None]:
            while chunk := await arriving.get():
                yield chunk
                taken.set()

        async def arrive(chunk: bytes) -> None:
            taken.clear()
            arriving.put_nowait(chunk)
            await taken.wait()

        microphone = Microphone(chunks(), live=True)
        first = asyncio.create_task(_next(microphone))
        await arrive(said)
        assert await first == split(said)[0]
        await arrive(said)  # heard, but nobody has taken it yet
        microphone.shut()
        await arrive(said)
        microphone.open()
        await arrive(pcm(tone(0.29)))  # the room rings on
        await arrive(bursts(1.2))
        arriving.put_nowait(b"")
        assert [len(u) / 2 / RATE async for u in microphone] == pytest.approx([1.6], abs=0.15)

    async def test_a_recording_goes_on(self, tmp_path: Path) -> None:
        path = tmp_path / "two.wav"
        path.write_bytes(wav(bursts(0.6, 0.6)))
        microphone = open_microphone(str(path))
        microphone.shut()
        assert len(await heard(microphone)) == 2

    async def test_there_is_a_level_to_show(self, tmp_path: Path) -> None:
        path = tmp_path / "loud.wav"
        path.write_bytes(wav(bursts(0.6)[: -2 * RATE]))  # ends while it is loud
        microphone = open_microphone(str(path))
        assert microphone.level == 0
        await anext(microphone)
        assert microphone.level == pytest.approx(0.35, abs=0.05)
        assert 0 <= microphone.silent_seconds < 5


class TestUnderstanding:
    def test_confidence_is_that_of_the_sound_and_of_the_match(self) -> None:
        certain = understand(Heard("go to the front", 0.9, 1.0), BOOK)
        keyword = understand(Heard("front", 0.9, 1.0), BOOK)
        assert certain is not None
        assert keyword is not None
        assert certain.confidence == 0.9
        assert UNDERSTOOD < keyword.confidence < 0.9

    def test_what_is_unsure_is_no_command(self) -> None:
        assert understand(Heard("go to the front", UNDERSTOOD - 0.01, 1.0), BOOK) is None
        assert understand(Heard("", 0.0, 1.0), BOOK) is None
        assert understand(Heard("the to a", 1.0, 1.0), BOOK) is None


class TestListening:
    def test_no_files_are_no_rows(self) -> None:
        assert listen([], BOOK) == []

    def test_a_file_that_cannot_be_read_is_named_before_anything_is_decoded(
        self, tmp_path: Path
    ) -> None:
        (tmp_path / "text.wav").write_text("hello")
        for name in ("none.wav", "text.wav"):
            with pytest.raises(TangyError, match=name):
                listen([tmp_path / name], BOOK)

    async def test_nothing_is_decoded_before_the_start(self) -> None:
        with pytest.raises(TangyError, match="not started"):
            await Recogniser().decode(bytes(100))

    @pytest.mark.parametrize(
        ("request_", "word"),
        [
            (None, "must hold"),
            ([], "must hold"),
            ({"id": 1}, "must hold"),
            ({"phrases": [1]}, "must hold"),
            ({"phrases": "call number"}, "must hold"),
            ({"pcm": "AAAA"}, "phrases must come before"),
        ],
    )
    def test_the_worker_answers_odd_requests_with_an_error(
        self, request_: object, word: str
    ) -> None:
        assert word in Worker().answer(request_)["error"]

    def test_nothing_heavy_is_imported_with_these_rooms(self) -> None:
        code = (
            "import sys, tangy_tui.learning.commands, tangy_tui.learning.speech\n"
            "heavy = {'numpy', 'pocketsphinx', 'textual', 'rich'} & set(sys.modules)\n"
            "sys.exit(str(heavy) if heavy else 0)"
        )
        subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603
