"""The sound of an item from a robot's loudspeaker: the robot process, espeak-ng and aplay.

ALSA's sound card is a named pipe that is read as fast as a loudspeaker plays.
"""

from __future__ import annotations

import fcntl
import os
import shutil
import threading
import time
import wave
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.stop_latch import Preempted
from tangy_tui.app.device_simulator import DeviceSimulator
from tests.real.bench_setup import setup_on
from tests.support.waiting import wait_until

RATE = 22_050
PIECE = 0.05  # s
LOUD = 20_000  # of 32,767
AFTER_STOP = 0.5  # s until the loudspeaker must be silent
PIPE = 4_096  # bytes that the pipe holds: .09 s

pytestmark = [
    pytest.mark.slow,
    pytest.mark.xdist_group("robot"),
    pytest.mark.skipif(shutil.which("espeak-ng") is None, reason="espeak-ng is not installed"),
    pytest.mark.skipif(shutil.which("aplay") is None, reason="aplay is not installed"),
]


class Loudspeaker:
    """Plays a named pipe at the speed of sound, or slower on a busy machine."""

    def __init__(self, pipe: Path) -> None:
        os.mkfifo(pipe)
        self._card = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        fcntl.fcntl(self._card, fcntl.F_SETPIPE_SZ, PIPE)
        self.played: list[bytes] = []
        self.last = time.monotonic()
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    def _play(self) -> None:
        size = 2 * round(RATE * PIECE)
        while not self._over.wait(PIECE):
            try:
                piece = os.read(self._card, size)
            except BlockingIOError:
                continue
            if piece:
                self.played.append(piece)
                self.last = time.monotonic()

    @property
    def samples(self) -> NDArray[np.int16]:
        """Everything that it has played."""
        return np.frombuffer(b"".join(self.played), "<i2")

    def close(self) -> None:
        self._over.set()
        self._thread.join()
        os.close(self._card)


@pytest.fixture
def loudspeaker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Loudspeaker]:
    pipe, settings = tmp_path / "card", tmp_path / "asound.conf"
    settings.write_text(
        f'pcm.!default {{ type file slave.pcm {{ type null }} file "{pipe}" format raw }}\n'
    )
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(settings))
    loudspeaker = Loudspeaker(pipe)
    yield loudspeaker
    loudspeaker.close()


@pytest.fixture
def robot(bench: DeviceSimulator, loudspeaker: Loudspeaker) -> Iterator[RobotLink]:
    """A robot on the bench with this machine's loudspeaker."""
    setup = setup_on(bench)
    drivers = {**setup.drivers, "voice": {"kind": "spoken", "sink": "aplay"}}
    link = RobotLink(replace(setup, drivers=drivers))
    link.start()
    yield link
    link.close()


def song(folder: Path, seconds: float) -> tuple[Path, NDArray[np.int16]]:
    """Write a WAV file with a rising tone; return its samples, too."""
    time_of = np.arange(round(RATE * seconds)) / RATE
    samples = (LOUD * np.sin(2 * np.pi * (300 + 40 * time_of) * time_of)).astype("<i2")
    path = folder / "song.wav"
    with wave.open(str(path), "wb") as file:
        file.setparams((1, 2, RATE, 0, "NONE", ""))
        file.writeframes(samples.tobytes())
    return path, samples


def found_in(samples: NDArray[np.int16], played: NDArray[np.int16]) -> int:
    """Return where a sound begins in the played sound, as a byte offset; -1: nowhere."""
    return played.tobytes().find(samples.tobytes())


def test_the_song_is_played_whole_after_the_sentence_and_not_changed(
    robot: RobotLink, loudspeaker: Loudspeaker, tmp_path: Path
) -> None:
    path, samples = song(tmp_path, 2.0)
    robot.do("perform", text="Row your boat.", sound=str(path))
    wait_until(lambda: found_in(samples, loudspeaker.samples) > 0, "the song is heard")
    begins = found_in(samples, loudspeaker.samples)
    spoken = loudspeaker.samples[: begins // 2].astype(float)
    assert 500 < np.abs(spoken).max() < 32_767  # audible, and not clipped
    assert np.abs(loudspeaker.samples[begins // 2 :]).max() <= LOUD


def test_a_stop_silences_a_song(robot: RobotLink, loudspeaker: Loudspeaker, tmp_path: Path) -> None:
    path, samples = song(tmp_path, 20.0)
    begun = samples[: RATE // 2]
    asked = robot.ask("perform", text="", sound=str(path))
    wait_until(lambda: found_in(begun, loudspeaker.samples) >= 0, "the song is heard")
    robot.stop("a person says stop")
    before = len(loudspeaker.samples)
    with pytest.raises(Preempted):
        asked.result(10)
    wait_until(lambda: time.monotonic() - loudspeaker.last > 1.0, "the loudspeaker is silent")
    after = len(loudspeaker.samples) - before  # counted in sound: the machine may be busy
    assert after <= AFTER_STOP * RATE
    assert len(loudspeaker.samples) < len(samples) / 2
