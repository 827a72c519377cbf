"""A player plays to the end, stops at once, ends with the program, and fails with one sentence."""

from __future__ import annotations

import asyncio
import os
import select
import signal
import subprocess
import sys
import wave
from pathlib import Path

import pytest

from tangy_hw.audio.player import (
    NullPlayer,
    PlayerError,
    ProgramPlayer,
    examine_output,
    open_player,
)
from tests.hw.speakers import Clock, program


@pytest.fixture
def wav(tmp_path: Path) -> Path:
    """Two seconds of silence, under a unique name."""
    path = tmp_path / "-q it's; $(a) sound.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, 8_000, 0, "NONE", ""))
        file.writeframes(bytes(32_000))
    return path


class Playing:
    """An endless player that reports through a named pipe."""

    def __init__(self, folder: Path) -> None:
        self._pipe = folder / "told"
        os.mkfifo(self._pipe)
        self.path = program(folder / "aplay", f"echo $$ > '{self._pipe}'; exec sleep 600")
        self.player = ProgramPlayer([(str(self.path),)])

    async def pid(self) -> int:
        """Wait until it plays."""
        return int(await asyncio.to_thread(self._pipe.read_text))


def is_there(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


async def test_a_wav_is_played_to_its_end(tmp_path: Path, wav: Path) -> None:
    path = program(tmp_path / "aplay", f'echo "$#$1$2" > "{tmp_path}/played"; cat; exec 1>&2; echo')
    player = ProgramPlayer([(str(path), "-q")])
    await player.play(wav)
    assert (tmp_path / "played").read_text() == f"2-q{wav}\n"
    assert player.name == "aplay"


async def test_stop_ends_playback_at_once(tmp_path: Path, wav: Path) -> None:
    playing = Playing(tmp_path)
    heard = asyncio.create_task(playing.player.play(wav))
    pid = await playing.pid()
    playing.player.stop()
    await heard  # a player that was stopped on purpose has not failed
    assert not is_there(pid)
    playing.player.stop()  # without a player, this does nothing


async def test_cancelling_playback_ends_the_player(tmp_path: Path, wav: Path) -> None:
    playing = Playing(tmp_path)
    heard = asyncio.create_task(playing.player.play(wav))
    pid = await playing.pid()
    heard.cancel()
    await asyncio.wait({heard})
    assert heard.cancelled()
    assert not is_there(pid)


async def test_cancelling_before_the_start_plays_nothing(tmp_path: Path, wav: Path) -> None:
    path = program(tmp_path / "aplay", f"echo > '{tmp_path}/begun'; exec sleep 600")
    player = ProgramPlayer([(str(path),)])
    for stop in (False, True):
        heard = asyncio.create_task(player.play(wav))
        await asyncio.sleep(0)
        if stop:
            player.stop()
        else:
            heard.cancel()
        await asyncio.wait({heard}, timeout=20)
        assert heard.done()


async def test_a_player_ends_with_the_program(tmp_path: Path, wav: Path) -> None:
    playing = Playing(tmp_path)
    code = (
        "import asyncio, sys; from pathlib import Path\n"
        "from tangy_hw.audio.player import ProgramPlayer\n"
        "asyncio.run(ProgramPlayer([(sys.argv[1],)]).play(Path(sys.argv[2])))\n"
    )
    told = tmp_path / "written"
    with told.open("wb") as file:
        ours = subprocess.Popen(  # noqa: S603, ASYNC220 - our own interpreter
            [sys.executable, "-c", code, str(playing.path), str(wav)], stdout=file, stderr=file
        )
    pid = await playing.pid()
    ended = os.pidfd_open(pid)
    ours.send_signal(signal.SIGKILL)
    await asyncio.to_thread(ours.wait)
    assert await asyncio.to_thread(select.select, [ended], [], [], 20) == ([ended], [], [])
    os.close(ended)
    assert told.read_bytes() == b""


@pytest.mark.parametrize(
    ("does", "says"),
    [
        ("echo 'ALSA lib x' >&2; echo 'aplay: main:831: audio open error: None.' >&2; exit 1",
         "No sound comes out of aplay: audio open error: None."),
        ("exit 1", "No sound comes out of aplay: it ended with status 1."),
        ("kill -9 $$", "No sound comes out of aplay: it ended with status 137."),
    ],
)  # fmt: skip
async def test_a_failing_player_gives_its_reason(
    tmp_path: Path, wav: Path, does: str, says: str
) -> None:
    player = ProgramPlayer([(str(program(tmp_path / "aplay", does)),)])
    with pytest.raises(PlayerError) as failed:
        await player.play(wav)
    assert str(failed.value) == says


async def test_a_hanging_player_counts_as_failed(tmp_path: Path) -> None:
    path = program(tmp_path / "aplay", "exec sleep 600")
    player = ProgramPlayer([(str(path),)], late=0.2)
    with pytest.raises(PlayerError, match="the device may be in use"):
        await player.play(tmp_path / "none.wav")


async def test_the_next_player_is_tried_and_remembered(tmp_path: Path, wav: Path) -> None:
    bad = program(tmp_path / "aplay", f"echo >> '{tmp_path}/tried'; exit 1")
    good = program(tmp_path / "paplay", "exit 0")
    player = ProgramPlayer([(str(bad), "-q"), (str(good),)])
    await player.play(wav)
    await player.play(wav)
    assert player.name == "paplay"
    assert (tmp_path / "tried").read_text() == "\n", "once"


async def test_the_null_player_takes_its_time(wav: Path) -> None:
    clock = Clock()
    player = NullPlayer(clock.sleep)
    heard = asyncio.create_task(player.play(wav))
    await clock.somebody_sleeps()
    clock.pass_by(1.9)
    await asyncio.sleep(0)
    assert not heard.done()
    clock.pass_by(0.2)
    await heard


async def test_the_null_player_is_cut_as_well(wav: Path) -> None:
    clock = Clock()
    player = NullPlayer(clock.sleep)
    player.stop()
    heard = asyncio.create_task(player.play(wav))
    await clock.somebody_sleeps()
    player.stop()
    await heard
    assert clock.now == 0.0


def test_a_sink_is_opened_by_its_name() -> None:
    assert open_player("null").name == "null"
    assert open_player("auto", {"paplay": "/x/paplay", "afplay": "/x/afplay"}.get).name == "paplay"
    assert open_player("afplay", {"afplay": "/x/afplay"}.get).name == "afplay"


@pytest.mark.parametrize(
    ("sink", "says"),
    [
        ("aply", "did you mean 'aplay'?"),
        ("afplay", "afplay is not installed."),
        ("auto", "No program that plays sound is installed"),
    ],
)
def test_an_unknown_sink_is_refused(sink: str, says: str) -> None:
    with pytest.raises(PlayerError) as refused:
        open_player(sink, lambda _: None)
    assert says in str(refused.value)


def test_the_output_is_tested_with_silence(tmp_path: Path) -> None:
    bad = program(tmp_path / "aplay", "echo 'aplay: main:831: none' >&2; exit 1")
    good = program(tmp_path / "paplay", f"tail -c +45 \"$1\" | tr -d '\\0' > '{tmp_path}/heard'")
    assert examine_output({"aplay": str(bad)}.get) == (
        "",
        "aplay finds nothing to play on (none)",
    )
    assert examine_output({"aplay": str(bad), "paplay": str(good)}.get) == ("paplay", "")
    assert (tmp_path / "heard").read_bytes() == b"", "all of it silence"
    assert "alsa-utils" in examine_output(lambda _: None)[1]
    assert "cannot be started" in examine_output({"aplay": str(tmp_path)}.get)[1]
