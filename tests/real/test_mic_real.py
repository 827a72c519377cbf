"""`tangy mic` as its own process, with a listener in another, as on a robot."""

from __future__ import annotations

import asyncio
import os
import signal
import sys
import time
from asyncio.subprocess import PIPE, Process
from collections.abc import AsyncIterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tangy_hw.audio.sources import SOCKET_NAME, open_source
from tangy_hw.audio.wav import RATE
from tests.hw.sounds import wav
from tests.support.terminal import PATIENCE, TANGY, Terminal

if TYPE_CHECKING:
    from tests.real.conftest import OpenTerminal

SOUND = np.random.default_rng(4).integers(-9_000, 9_000, 5 * RATE, np.int16).astype("<i2").tobytes()
PIECE = 640  # bytes, 20 ms
QUIET = bytes(2 * RATE)  # the second of quiet after a stream
LISTEN = """
import asyncio, sys
from pathlib import Path
from tangy_hw.audio.sources import open_source

async def listen():
    source = open_source("socket", folder=Path(sys.argv[1]))
    source.tell = lambda sentence: print(sentence, file=sys.stderr, flush=True)
    async for chunk in source:
        sys.stdout.buffer.write(chunk)
        sys.stdout.buffer.flush()

asyncio.run(listen())
"""


class Running:
    """A process, its input and its output."""

    def __init__(self, process: Process) -> None:
        self.process = process

    async def until(self, text: str) -> str:
        """Read its messages until one holds a text."""
        assert self.process.stderr is not None
        read = b""
        while text.encode() not in read:
            line = await asyncio.wait_for(self.process.stderr.readline(), PATIENCE)
            assert line, f"never said {text!r}, but: {read!r}"
            read += line
        return read.decode()

    async def say(self, sound: bytes) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(sound)
        await self.process.stdin.drain()

    async def hear(self, count: int) -> bytes:
        assert self.process.stdout is not None
        return await asyncio.wait_for(self.process.stdout.readexactly(count), PATIENCE)

    async def end(self) -> int:
        """Close its input, and return its status."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        return await self.status()

    async def status(self) -> int:
        return await asyncio.wait_for(self.process.wait(), PATIENCE)


class Robot:
    """A data folder, and the processes that use it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.started: list[Process] = []

    async def _start(self, *command: str) -> Running:
        process = await asyncio.create_subprocess_exec(
            *command, stdin=PIPE, stdout=PIPE, stderr=PIPE, start_new_session=True
        )
        self.started.append(process)
        return Running(process)

    async def mic(self, *words: str) -> Running:
        return await self._start(TANGY, "mic", "--data", str(self.folder), *words)

    async def listener(self) -> Running:
        started = await self._start(sys.executable, "-c", LISTEN, str(self.folder))
        await started.until("Waiting for the laptop's microphone.")
        return started


@pytest.fixture
async def robot(tmp_path: Path) -> AsyncIterator[Robot]:
    made = Robot(tmp_path / "data")
    made.folder.mkdir()
    yield made
    for process in made.started:
        if process.returncode is None:
            process.kill()
        await process.communicate()


@pytest.mark.slow
async def test_five_seconds_arrive_exactly_through_two_programs(robot: Robot) -> None:
    listener = await robot.listener()
    mic = await robot.mic()
    await mic.until("Connected")
    late = []
    await mic.say(SOUND[:PIECE] * 4)  # in which it detects the format
    assert await listener.hear(4 * PIECE) == SOUND[:PIECE] * 4
    for place in range(0, len(SOUND), PIECE):
        began = time.perf_counter()
        await mic.say(SOUND[place : place + PIECE])
        assert await listener.hear(PIECE) == SOUND[place : place + PIECE]
        late.append(time.perf_counter() - began)
    print(f"median {sorted(late)[len(late) // 2] * 1_000:.1f} ms, most {max(late) * 1_000:.1f} ms")
    assert await mic.end() == 0


@pytest.mark.slow
async def test_a_wav_is_forwarded_without_its_header(robot: Robot) -> None:
    listener = await robot.listener()
    mic = await robot.mic()
    await mic.until("Connected")
    await mic.say(wav(SOUND[: 4 * PIECE], size=0xFFFFFFFF))
    assert await listener.hear(4 * PIECE) == SOUND[: 4 * PIECE]
    assert await mic.end() == 0


@pytest.mark.slow
async def test_a_restarted_listener_hears_only_new_sound(robot: Robot) -> None:
    mic = await robot.mic()
    await mic.until("does not listen yet")
    await mic.say(b"\1\1" * 2_000)
    for number in range(2, 4):
        listener = await robot.listener()
        await mic.until("Connected")
        await mic.say(bytes([number]) * PIECE)
        assert await listener.hear(PIECE) == bytes([number]) * PIECE
        assert (robot.folder / SOCKET_NAME).is_socket()
        listener.process.send_signal(signal.SIGKILL)
        await mic.until("Tangy has closed")
        await mic.say(b"\1\1" * PIECE)
    assert await mic.end() == 0


@pytest.mark.slow
async def test_a_new_microphone_replaces_a_killed_one(robot: Robot) -> None:
    listener = await robot.listener()
    for word in (SOUND[:3_000], SOUND[3_000:6_000]):
        mic = await robot.mic()
        await mic.until("Connected")
        await mic.say(word)
        assert await listener.hear(len(word)) == word
        mic.process.send_signal(signal.SIGKILL)
        await listener.until("has gone; waiting for it to come back")
        assert await listener.hear(len(QUIET)) == QUIET


@pytest.mark.slow
async def test_the_newer_of_two_microphones_takes_over(robot: Robot) -> None:
    listener = await robot.listener()
    older = await robot.mic()
    await older.until("Connected")
    newer = await robot.mic()
    await newer.until("Connected")
    assert "Another microphone has taken over" in await older.until("taken over")
    assert await older.status() == 1
    await newer.say(SOUND[:3_000])
    assert await listener.hear(len(QUIET) + 3_000) == QUIET + SOUND[:3_000]
    newer.process.send_signal(signal.SIGINT)
    assert await newer.status() == 0


@pytest.mark.slow
async def test_another_socket_can_be_named(robot: Robot, tmp_path: Path) -> None:
    source = open_source(f"socket:{tmp_path / 'here'}")
    hearing = asyncio.ensure_future(anext(source))
    mic = await robot.mic("--socket", str(tmp_path / "here"))
    await mic.until("Connected")
    await mic.say(SOUND[:3_000])
    assert SOUND.startswith(await hearing)
    await source.close()
    await mic.until("Tangy has closed")
    assert await mic.end() == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("content", "word"),
    [
        (b"Good morning.\n" * 200, "text"),
        (wav(bytes(3_000), rate=44_100, channels=2), "44,100 samples a second, 2 channels"),
    ],
)
async def test_input_that_is_no_sound_is_refused_in_one_line(
    robot: Robot, content: bytes, word: str
) -> None:
    mic = await robot.mic()
    await mic.say(content)
    assert await mic.status() == 2
    assert mic.process.stderr is not None
    lines = (await mic.process.stderr.read()).decode().splitlines()
    assert word in lines[-1]
    assert len(lines) <= 2, "the other says that it waits"


@pytest.mark.slow
def test_a_terminal_as_input_prints_the_commands_to_type(open_terminal: OpenTerminal) -> None:
    terminal = open_terminal("mic", columns=250)
    assert terminal.wait() == 2
    assert "arecord -q -t raw -f S16_LE -r 16000 -c 1 | ssh ROBOT tangy mic" in terminal.text
    assert "rec -q -t raw -b 16 -e signed -r 16000 -c 1 - | ssh ROBOT tangy mic" in terminal.text


@pytest.mark.slow
def test_a_terminal_shows_the_level_bar(tmp_path: Path) -> None:
    fifo = tmp_path / "sound"
    os.mkfifo(fifo)
    loud = b"\x00\x20\x00\xe0" * 4_000
    writing = os.open(fifo, os.O_RDWR)
    folder = str(tmp_path / "data")
    shown = Terminal(["sh", "-c", f"exec '{TANGY}' mic --data '{folder}' < '{fifo}'"])
    try:
        os.write(writing, loud)
        text = shown.until("waiting for Tangy")
        assert "[##" in text
        shown.type("\x03")
        assert shown.wait() == 0
    finally:
        shown.end()
        os.close(writing)
