"""Speech without the decoder: sound files, pauses, sources, and how sure is sure enough."""

from __future__ import annotations

import asyncio
import os
import pty
import subprocess
import sys
from collections.abc import AsyncGenerator, Callable
from pathlib import Path
from threading import Thread

import numpy as np
import pytest

from tangy_hw.sound.wav import RATE, SoundError
from tangy_profiles.activity import load_activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.microphone import Microphone, open_microphone, split
from tangy_tui.learning.speech import UNDERSTOOD, Heard, Recogniser, listen, understand
from tangy_tui.learning.speech_worker import Worker
from tests.hw.sounds import bursts, pcm, tone, wav, written

BOOK = Phrasebook(load_activity("bingo"), load_people(4))


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
