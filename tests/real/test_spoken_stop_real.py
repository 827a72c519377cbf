"""A spoken "stop the robot" in a live game halts the wheels, from the sound to the odometry."""

from __future__ import annotations

import shutil
import time
import wave
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from websockets.sync.client import connect

from tangy_hw.audio.wav import RATE
from tests.real.microphone import Laptop
from tests.real.voices import Voices
from tests.support.processes import Family
from tests.support.terminal import TANGY, Terminal
from tests.support.wheels import Wheels, rosbridge

STOPS = 1.0  # s after the last word until the wheels stand; the goal of .5 is measured by hand
DRIVES = 0.1  # m/s, from which it counts as driving
PATIENCE = 60.0

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.xdist_group("robot"),
]


@pytest.fixture
def family() -> Family:
    return Family()


@pytest.fixture
def terminal(folder: Path, family: Family) -> Iterator[Terminal]:
    game = ["live", "--bench", "--begin", "--pace", "3", "--seed", "5", "--data", str(folder)]
    hears = ["--mic", "socket", "--hands-free"]
    terminal = Terminal(
        [TANGY, *game, *hears], columns=110, lines=40, environment=family.environment
    )
    yield terminal
    terminal.end()


@pytest.fixture
def microphone(folder: Path, terminal: Terminal) -> Iterator[Laptop]:
    terminal.until("Now")
    laptop = Laptop(TANGY, folder)
    yield laptop
    laptop.end()


@pytest.fixture
def wheels(family: Family, terminal: Terminal) -> Iterator[Wheels]:
    terminal.until("Now")
    (bench,) = (
        pid for pid, command in family.there().items() if "tangy_sim.device_simulator" in command
    )
    with connect(rosbridge(bench)) as link:
        yield Wheels(link)


@pytest.mark.parametrize("voice", ["slt", "rms"])
@pytest.mark.parametrize("words", ["stop the robot", "emergency stop"])
def test_a_spoken_stop_halts_the_driving_wheels_at_once(
    terminal: Terminal, microphone: Laptop, wheels: Wheels, tmp_path: Path, voice: str, words: str
) -> None:
    said = Voices(tmp_path).say(words, voice)
    loud = np.abs(np.frombuffer(said, "<i2").astype(int)) > 1000
    last = (len(loud) - int(np.argmax(loud[::-1]))) / RATE  # s, the end of its last sound
    if "Is all well now?" in terminal.until(
        lambda text: "greet everyone" in text or "well" in text
    ):
        terminal.type("y")
    terminal.type("u")  # the steps in place of the staff view
    terminal.until("call number")
    terminal.type("h")
    terminal.until("Who needs help?")
    terminal.type("\r")
    ends = time.monotonic() + PATIENCE
    while wheels.speed < DRIVES and time.monotonic() < ends:
        microphone.say(terminal, bytes(RATE // 5))
    assert wheels.speed >= DRIVES
    began = microphone.say(terminal, said + bytes(2 * RATE))
    terminal.until("STOPPED")
    assert f"Heard: {words}" in terminal.text
    took = wheels.still_since() - (began + last)
    print(f"{words!r} by {voice} stopped the wheels in {took:.3f} s")
    assert took <= STOPS
    assert wheels.speed < 1e-3


def test_a_recording_plays_after_the_robot_is_open(
    folder: Path, family: Family, tmp_path: Path
) -> None:
    said = tmp_path / "said.wav"
    speech = Voices(tmp_path).say("stop the robot", "slt")
    with wave.open(str(said), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RATE)
        file.writeframes(bytes(12 * 2 * RATE) + speech)
    command = [TANGY, "live", "--bench", "--begin", "--seed", "5", "--data", str(folder)]
    terminal = Terminal(
        [*command, "--hands-free", "--mic", str(said)],
        columns=110,
        lines=40,
        environment=family.environment,
    )
    try:
        terminal.until("Now")
        began = time.monotonic()
        terminal.until("STOPPED")
        terminal.until("Heard: stop the robot")
        assert time.monotonic() - began > 9  # s: not transcribed before it was said
        terminal.until("The recording is over.")
    finally:
        terminal.end()
