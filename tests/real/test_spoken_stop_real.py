"""Who says "stop the robot" in a live game stops its wheels, from the sound to the odometry."""

from __future__ import annotations

import json
import shutil
import threading
import time
import wave
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from tangy_hw.audio.wav import RATE
from tests.real.microphone import Laptop
from tests.real.voices import Voices
from tests.support.processes import Family
from tests.support.terminal import TANGY, Terminal

if TYPE_CHECKING:
    from websockets.sync.connection import Connection

STOPS = 0.5  # s after the last word, in which the wheels stand
DRIVES = 0.1  # m/s, from which it is on its way
LISTENING = 0x0A  # the state of such a socket in /proc/net/tcp
PATIENCE = 60.0

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.xdist_group("robot"),
]


class Wheels:
    """What the bench's odometry tells another client of its, as it comes."""

    def __init__(self, link: Connection) -> None:
        self.told: list[tuple[float, float]] = []
        """When (on the monotonic clock), and how fast it drove, in m/s."""
        self._link = link
        self._link.send(json.dumps({"op": "subscribe", "topic": "/odom"}))
        threading.Thread(target=self._hear, daemon=True).start()

    def _hear(self) -> None:
        with suppress(WebSocketException, OSError):
            for text in self._link:
                twist = json.loads(text)["msg"]["twist"]["twist"]
                speed = float(np.hypot(twist["linear"]["x"], twist["angular"]["z"]))
                self.told.append((time.monotonic(), speed))

    @property
    def speed(self) -> float:
        """How fast it drives, in m/s; a turn of a rad/s counts as one."""
        return self.told[-1][1] if self.told else 0.0

    def still_since(self) -> float:
        """Return when it came to stand, on the monotonic clock."""
        return max((at for at, speed in self.told if speed > 1e-3), default=0.0)


def rosbridge(pid: int) -> str:
    """Return the address of the one of a process's ports that speaks rosbridge."""
    for port in _listens(pid):
        url = f"ws://127.0.0.1:{port}"
        with suppress(WebSocketException, OSError), connect(url, open_timeout=2):
            return url
    raise AssertionError("the bench has no rosbridge")


def _listens(pid: int) -> list[int]:
    names = [str(entry.readlink()) for entry in Path(f"/proc/{pid}/fd").iterdir()]
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    own = {name[8:-1] for name in names if name.startswith("socket:[")}
    listening = (row for row in rows if row[9] in own and int(row[3], 16) == LISTENING)
    return [int(row[1].rpartition(":")[2], 16) for row in listening]


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
def test_who_says_stop_the_robot_while_it_drives_stops_its_wheels_at_once(
    terminal: Terminal, microphone: Laptop, wheels: Wheels, tmp_path: Path, voice: str, words: str
) -> None:
    said = Voices(tmp_path).say(words, voice)
    loud = np.abs(np.frombuffer(said, "<i2").astype(int)) > 1000
    last = (len(loud) - int(np.argmax(loud[::-1]))) / RATE  # s, where its last sound ends
    if "Is all well now?" in terminal.until(
        lambda text: "greet everyone" in text or "well" in text
    ):
        terminal.type("y")
    terminal.type("u")  # the steps in place of what staff see
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
    assert took <= STOPS
    assert wheels.speed < 1e-3


def test_a_recording_is_heard_as_if_it_were_said_once_the_robot_is_on(
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
        assert time.monotonic() - began > 9  # s: not read out before it was said
        terminal.until("The recording is over.")
    finally:
        terminal.end()
