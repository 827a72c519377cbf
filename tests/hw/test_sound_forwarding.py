"""Forwarding sound: unchanged, never old, and to the next listener after a restart."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np
import pytest

from tangy_hw.audio.forwarding import SPEED_SECONDS, Forwarder, TakenOver
from tangy_hw.audio.socket_source import LaptopMicrophone
from tangy_hw.audio.source import Chunks, Recording, Source
from tangy_hw.audio.wav import RATE, SoundError

PATIENCE = 20.0
PIECE = 640
SOUND = np.random.default_rng(2).integers(-9_000, 9_000, RATE, np.int16).astype("<i2").tobytes()


class Spoken(Source):
    """A live source of given sound; an empty piece ends it."""

    def __init__(self) -> None:
        super().__init__("spoken", live=True)
        self.given = asyncio.Queue[bytes]()

    async def _sound(self) -> Chunks:
        while chunk := await self.given.get():
            yield chunk
            self.given.task_done()

    async def say(self, chunk: bytes) -> None:
        """Say something; return when it has been taken."""
        self.given.put_nowait(chunk)
        await asyncio.wait_for(self.given.join(), PATIENCE)


class Link:
    """A forwarder between a source and a listener."""

    def __init__(self, path: Path, source: Source | None = None) -> None:
        self.path = path
        self.now = 50.0
        self.spoken = Spoken()
        self.told = asyncio.Queue[str]()
        self.forwarder = Forwarder(
            source or self.spoken,
            path,
            tell=self.told.put_nowait,
            clock=lambda: self.now,
            again=0.0,
        )
        self.running = asyncio.create_task(self.forwarder.run())

    async def said(self) -> str:
        return await asyncio.wait_for(self.told.get(), PATIENCE)

    async def end(self) -> None:
        self.running.cancel()
        await asyncio.wait({self.running})


async def take(listener: Source, count: int) -> bytes:
    """Read a number of bytes."""
    got = b""
    while len(got) < count:
        got += await asyncio.wait_for(anext(listener), PATIENCE)
    return got


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "mic.sock"


async def test_forwarded_sound_arrives_unchanged(path: Path) -> None:
    listener = LaptopMicrophone("socket", path)
    hearing = asyncio.ensure_future(take(listener, PIECE))
    link = Link(path)
    assert await link.said() == "Connected: Tangy listens to this microphone."
    for place in range(0, len(SOUND), PIECE):
        await link.spoken.say(SOUND[place : place + PIECE])
        assert await hearing == SOUND[place : place + PIECE]
        hearing = asyncio.ensure_future(take(listener, PIECE))
    assert link.forwarder.dropped == 0
    link.spoken.given.put_nowait(b"")
    await link.running
    await listener.close()


async def test_sound_without_a_listener_is_dropped(path: Path) -> None:
    link = Link(path)
    assert "Tangy does not listen yet" in await link.said()
    for _ in range(20):
        await link.spoken.say(b"\1\1" * (PIECE // 2))
    listener = LaptopMicrophone("socket", path)
    hearing = asyncio.ensure_future(take(listener, PIECE))
    assert "Connected" in await link.said()
    await link.spoken.say(b"\2\2" * (PIECE // 2))
    assert await hearing == b"\2\2" * (PIECE // 2)
    await link.end()
    await listener.close()


async def test_a_late_listener_hears_only_the_newest_sound(path: Path) -> None:
    listener = LaptopMicrophone("socket", path)
    first = asyncio.ensure_future(take(listener, 2))
    link = Link(path)
    await link.said()
    for number in range(150):  # three seconds; the listener takes only the first piece
        await link.spoken.say(number.to_bytes(2, "little") * (PIECE // 2))
        for _ in range(5):
            await asyncio.sleep(0)
    await first
    got, last = b"", (149).to_bytes(2, "little")
    while not got.endswith(last):
        got += await take(listener, 2)
    assert len(got) / 2 / RATE < 0.7, "what the listener itself had taken, and a quarter second"
    assert link.forwarder.dropped / 2 / RATE > 2.0
    await link.end()
    await listener.close()


async def test_delayed_sound_is_cut_to_its_newest_part(path: Path) -> None:
    listener = LaptopMicrophone("socket", path)
    hearing = asyncio.ensure_future(take(listener, 2))
    link = Link(path)
    await link.said()
    await link.spoken.say(SOUND)  # a second at once, as after a broken link
    got = await hearing
    while not got.endswith(SOUND[-PIECE:]):
        got += await take(listener, 2)
    assert len(got) / 2 / RATE <= 0.25
    assert SOUND.endswith(got)
    await link.end()
    await listener.close()


async def test_the_forwarder_reconnects_to_a_restarted_program(path: Path) -> None:
    link = Link(path)
    assert "does not listen yet" in await link.said()
    for number in (1, 2):
        listener = LaptopMicrophone("socket", path)
        hearing = asyncio.ensure_future(take(listener, 4))
        assert "Connected" in await link.said()
        await link.spoken.say(bytes([number] * 4))
        assert await hearing == bytes([number] * 4)
        await listener.close()
        assert await link.said() == "Tangy has closed; waiting until it listens again."
    assert link.told.empty()
    await link.end()


async def test_the_last_sound_before_the_end_arrives(path: Path) -> None:
    listener = LaptopMicrophone("socket", path)
    hearing = asyncio.ensure_future(take(listener, 2_000))
    link = Link(path)
    await link.said()
    link.spoken.given.put_nowait(SOUND[:2_000])
    link.spoken.given.put_nowait(b"")
    await link.running
    assert await hearing == SOUND[:2_000]
    await listener.close()


async def test_a_recording_is_sent_whole_and_waits_for_a_listener(path: Path) -> None:
    link = Link(path, Recording("it.wav", SOUND[:5_000]))
    assert "does not listen yet" in await link.said()
    listener = LaptopMicrophone("socket", path)
    assert await take(listener, 5_000) == SOUND[:5_000]
    await link.running
    await listener.close()


async def test_a_newer_forwarder_replaces_the_older_one(path: Path) -> None:
    listener = LaptopMicrophone("socket", path)
    hearing = asyncio.ensure_future(take(listener, 2 * RATE + 4))
    older = Link(path)
    assert "Connected" in await older.said()
    newer = Link(path)
    assert "Connected" in await newer.said()
    with pytest.raises(TakenOver, match="Another microphone has taken over"):
        await asyncio.wait_for(older.running, PATIENCE)
    await newer.spoken.say(b"new!")
    assert await hearing == bytes(2 * RATE) + b"new!"  # the older part ended, so it is quiet there
    await newer.end()
    await listener.close()


async def test_a_failing_source_ends_the_forwarder_with_its_reason(path: Path) -> None:
    class Broken(Spoken):
        async def _sound(self) -> Chunks:
            raise SoundError("It is broken.")
            yield b""

    link = Link(path, Broken())
    with pytest.raises(SoundError, match="It is broken"):
        await asyncio.wait_for(link.running, PATIENCE)


@pytest.mark.parametrize(
    ("speed", "says"),
    [(1.0, ""), (0.9, ""), (5.5, "5.5 times as fast"), (0.5, "0.5 times as fast")],
)
async def test_a_wrong_sample_rate_is_reported_once(path: Path, speed: float, says: str) -> None:
    link = Link(path)
    await link.said()
    await link.spoken.say(bytes(2 * RATE * 20))  # sound that waited on the way does not count
    size = round(2 * RATE * speed / 2) // 2 * 2
    for _ in range(round(4 * SPEED_SECONDS) * 2):
        link.now += 0.5
        await link.spoken.say(bytes(size))
    told = [link.told.get_nowait() for _ in range(link.told.qsize())]
    assert len(told) == bool(says)
    assert all(says in sentence for sentence in told)
    await link.end()


async def test_a_pause_is_not_taken_for_a_wrong_sample_rate(path: Path) -> None:
    link = Link(path)
    await link.said()
    for number in range(60):
        link.now += 5.0 if number == 30 else 0.5
        await link.spoken.say(bytes(RATE))
    assert link.told.empty()
    await link.end()


async def test_the_level_is_measured_without_a_listener(path: Path) -> None:
    link = Link(path)
    assert link.forwarder.meter.level == 0.0
    await link.spoken.say(SOUND[:PIECE])
    await link.spoken.say(SOUND[:PIECE])  # so the first was heard
    assert link.forwarder.meter.level == pytest.approx(0.79, abs=0.02)
    await link.end()
