"""Sources by name: recordings, pipes and the local microphone; what each refuses."""

from __future__ import annotations

import asyncio
import os
import pty
import socket
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from tangy_hw.audio.arecord import LocalMicrophone
from tangy_hw.audio.piped_source import odd_kind, open_standard_input
from tangy_hw.audio.source import Recording, Source, WholeSamples
from tangy_hw.audio.sources import open_source
from tangy_hw.audio.wav import RATE, SoundError
from tests.hw.sounds import bursts, pcm, tone, wav, written

SOUND = bursts(0.6, 0.6)


async def heard(source: Source) -> bytes:
    """Listen to the end."""
    try:
        return b"".join([chunk async for chunk in source])
    finally:
        await source.close()


class TestNames:
    async def test_a_file_is_a_recording(self, tmp_path: Path) -> None:
        path = tmp_path / "two.wav"
        path.write_bytes(wav(SOUND))
        source = open_source(str(path))
        assert (source.name, source.live) == (str(path), False)
        assert await heard(source) == SOUND

    async def test_a_recording_plays_in_pieces_after_its_start(self) -> None:
        source = Recording("two.wav", SOUND[:9_600]).spoken()
        assert source.live
        first = asyncio.ensure_future(anext(source))
        done, _ = await asyncio.wait({first}, timeout=0.1)
        assert not done
        source.begin()
        began = asyncio.get_running_loop().time()
        pieces = [await first, *[piece async for piece in source]]
        await source.close()
        assert b"".join(pieces) == SOUND[:9_600]
        assert max(map(len, pieces)) <= RATE // 10 * 2
        assert asyncio.get_running_loop().time() - began > 0.25  # of .3 s

    @pytest.mark.parametrize(
        ("name", "word"),
        [
            ("none.wav", "no such file"),
            ("arecord:", "nothing after the colon"),
            ("socket:", "nothing after the colon"),
            ("socket", "no data folder"),
        ],
    )
    def test_an_unusable_source_is_refused_at_once(self, name: str, word: str) -> None:
        with pytest.raises(SoundError, match=word):
            open_source(name)

    async def test_a_closed_source_gives_nothing_more(self, tmp_path: Path) -> None:
        path = tmp_path / "two.wav"
        path.write_bytes(wav(SOUND))
        source = open_source(str(path))
        await source.close()
        with pytest.raises(StopAsyncIteration):
            await anext(source)
        await source.close()


class TestStandardInput:
    @pytest.fixture
    def piped(self) -> Callable[[bytes], Source]:
        def pipe(content: bytes, *, convert: bool = True) -> Source:
            reading, writing = os.pipe()

            def write() -> None:
                with suppress(BrokenPipeError), os.fdopen(writing, "wb") as file:
                    file.write(content)

            Thread(target=write, daemon=True).start()
            source = open_standard_input("--mic -", reading, convert=convert)
            return source

        return pipe

    @pytest.mark.parametrize(
        "content",
        [SOUND, SOUND + b"\x07", wav(SOUND, size=0xFFFFFFFF), wav(SOUND, extensible=True)],
        ids=["raw", "half a sample more", "streamed WAV", "extensible WAV"],
    )
    async def test_standard_input_may_be_raw_or_wav(
        self, piped: Callable[..., Source], content: bytes
    ) -> None:
        source = piped(content)
        assert source.live
        assert await heard(source) == SOUND

    async def test_a_wav_of_another_format_is_converted_at_its_end(
        self, piped: Callable[..., Source]
    ) -> None:
        sound = written(np.repeat(tone(0.5, 48_000), 2), 24)
        source, told = piped(wav(sound, rate=48_000, channels=2, bits=24)), list[str]()
        source.tell = told.append
        assert len(await heard(source)) == pytest.approx(RATE, abs=8)
        (sentence,) = told
        assert "48,000 samples a second, 2 channels, 24 bits" in sentence

    async def test_another_format_is_refused_for_live_speech(
        self, piped: Callable[..., Source]
    ) -> None:
        source = piped(wav(bytes(10_000), rate=44_100, channels=2), convert=False)
        with pytest.raises(SoundError, match="44,100 samples a second, 2 channels, 16 bits"):
            await heard(source)

    @pytest.mark.parametrize(
        ("content", "word"),
        [
            (b"Good morning.\n" * 200, "text"),
            (b"hello\n", "text"),
            (np.rint(tone(0.5, loud=0.3) * 127 + 128).astype(np.uint8).tobytes(), "8-bit"),
            (tone(0.5, loud=0.3).astype("<f4").tobytes(), "floating-point"),
            (b"fLaC" + bytes(3_000), "FLAC"),
            (b"FORM" + bytes(3_000), "AIFF"),
        ],
    )
    async def test_input_that_is_no_sound_is_refused(
        self, piped: Callable[..., Source], content: bytes, word: str
    ) -> None:
        with pytest.raises(SoundError, match=word) as refused:
            await heard(piped(content))
        assert "\n" not in str(refused.value)

    @pytest.mark.parametrize("loud", [0.0, 0.0001, 0.003, 0.1, 0.9])
    def test_raw_sound_and_silence_are_never_refused(self, loud: float) -> None:
        noise = np.random.default_rng(3).normal(0, 1e-4, RATE)
        for place in (0, 5_000):
            for sound in (tone(1.0, loud=loud), tone(1.0, loud=loud, hertz=90.0) + noise):
                assert odd_kind(pcm(sound)[place : place + 2_000]) == ""

    async def test_a_file_as_standard_input_is_a_recording(self, tmp_path: Path) -> None:
        path = tmp_path / "two.raw"
        for content in (SOUND, wav(SOUND)):
            path.write_bytes(content)
            with path.open("rb") as file:
                source = open_source("-", stdin=file.fileno())
            assert not source.live
            assert await heard(source) == SOUND

    async def test_empty_input_ends_the_source(self, piped: Callable[..., Source]) -> None:
        assert await heard(piped(b"")) == b""
        with open(os.devnull, "rb") as nothing:  # noqa: ASYNC230, PTH123
            assert await heard(open_source("-", stdin=nothing.fileno())) == b""

    def test_terminals_folders_and_closed_descriptors_are_refused(self, tmp_path: Path) -> None:
        parent, child = pty.openpty()
        folder = os.open(tmp_path, os.O_RDONLY)
        try:
            for descriptor, word in ((child, "terminal"), (folder, "folder"), (10_000, "closed")):
                with pytest.raises(SoundError, match=word):
                    open_source("-", stdin=descriptor)
        finally:
            for descriptor in (parent, child, folder):
                os.close(descriptor)

    async def test_closing_the_source_ends_a_pending_read(self) -> None:
        ours, theirs = socket.socketpair()
        with ours, theirs:
            source = open_source("-", stdin=ours.fileno())
            theirs.send(SOUND[:3_000])
            assert await anext(source) == SOUND[:3_000]
            waiting = asyncio.ensure_future(heard(source))
            await asyncio.sleep(0)
            await source.close()
            assert await asyncio.wait_for(waiting, 10) == b""

    def test_pieces_of_any_size_are_joined_to_whole_samples(self) -> None:
        whole, content = WholeSamples(), bytes(range(200))
        sizes = [1, 1, 3, 2, 5, 0, 88, 99]
        made, place = [], 0
        for size in sizes:
            made.append(whole.of(content[place : place + size]))
            place += size
        assert all(len(piece) % 2 == 0 for piece in made)
        assert b"".join(made) == content[: sum(sizes) // 2 * 2]


class TestLocalMicrophone:
    @pytest.fixture
    def record(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., None]:
        """Install an arecord that records its arguments, sends a sound, and runs lines of shell."""
        monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")

        def install(then: str, first: str = ":") -> None:
            raw, script = tmp_path / "sound.raw", tmp_path / "arecord"
            raw.write_bytes(SOUND)
            script.touch(mode=0o755)
            script.write_text(
                f"#!/bin/sh\ncd '{tmp_path}'\necho $$ > pid\necho \"$*\" > words\n{first}\n"
                f"cat sound.raw\n{then}\n"
            )

        return install

    async def test_the_microphone_records_in_the_format_of_the_decoder(
        self, record: Callable[..., None], tmp_path: Path
    ) -> None:
        record("exec cat /dev/zero")
        for name, more in (("arecord", ""), ("arecord:hw:1,0", " -D hw:1,0")):
            source = open_source(name)
            assert source.live
            got = b""
            while len(got) < len(SOUND):
                got += await anext(source)
            await source.close()
            assert got[: len(SOUND)] == SOUND
            words = (tmp_path / "words").read_text()
            assert words == f"-q -t raw -f S16_LE -r 16000 -c 1{more}\n"

    async def test_an_unplugged_microphone_is_reported_once_and_awaited(
        self, record: Callable[..., None], tmp_path: Path
    ) -> None:
        record(
            'rm -f back; echo "arecord: pcm_read:2221: read error: No such device" >&2; exit 1',
            first="[ -e back ] || { echo tried >> tries; [ $(wc -l < tries) = 3 ] && touch back; "
            "echo 'arecord: main:831: audio open error: No such device' >&2; exit 1; }",
        )
        (tmp_path / "back").touch()
        source, told = LocalMicrophone("arecord", again=0.0), list[str]()
        source.tell = told.append
        got = b""
        while len(got) < 2 * len(SOUND):
            got += await anext(source)
        await source.close()
        assert got[: 2 * len(SOUND)] == SOUND * 2
        assert told[:2] == [
            "The microphone stopped: it is unplugged. It is tried again until it is back.",
            "The microphone is back.",
        ]
        assert (tmp_path / "tries").read_text().count("tried") >= 3

    async def test_a_reason_cannot_act_on_a_terminal(self, record: Callable[..., None]) -> None:
        record("printf 'busy \\033[31mdevice' >&2; exit 1")
        source, told = LocalMicrophone("arecord", again=60.0), asyncio.Queue[str]()
        source.tell = told.put_nowait
        listening = asyncio.ensure_future(heard(source))
        sentence = await asyncio.wait_for(told.get(), 20)
        assert "stopped: busy" in sentence
        assert "\033" not in sentence
        await source.close()
        assert await listening == SOUND

    async def test_closing_the_source_ends_the_recorder_despite_unread_sound(
        self, record: Callable[..., None], tmp_path: Path
    ) -> None:
        record("exec cat /dev/zero")
        source = open_source("arecord")
        await anext(source)
        for _ in range(2_000):  # turns of the loop, in which all buffers fill
            await asyncio.sleep(0)
        await asyncio.wait_for(source.close(), 10)
        with pytest.raises(ProcessLookupError):
            os.kill(int((tmp_path / "pid").read_text()), 0)

    def test_a_missing_recorder_is_reported_with_the_package_to_install(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setenv("PATH", str(tmp_path))
        with pytest.raises(SoundError, match="alsa-utils"):
            open_source("arecord")
