"""Spoken commands through real terminals and processes, from the sound to the executed step."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tangy_hw.audio.wav import RATE
from tests.hw.sounds import wav
from tests.real.microphone import Laptop
from tests.real.voices import Voices
from tests.support.terminal import PATIENCE, ended

if TYPE_CHECKING:
    from tests.real.conftest import OpenTerminal
    from tests.support.terminal import Tmux

pytestmark = [
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.xdist_group("speech"),
]


@pytest.fixture
def voices(tmp_path: Path) -> Voices:
    return Voices(tmp_path)


@pytest.fixture
def laptop(tangy: str, tmp_path: Path) -> Iterator[Callable[[], Laptop]]:
    made: list[Laptop] = []

    def one() -> Laptop:
        made.append(Laptop(tangy, tmp_path / "data"))
        return made[-1]

    yield one
    for each in made:
        each.end()


def steps(tangy: str, data: Path) -> list[str]:
    """Return the behaviours of the demonstration, by the log."""
    kept = subprocess.run(  # noqa: S603 - our own program
        [tangy, "teach", "--json", "--data", str(data)],
        input="",
        capture_output=True,
        text=True,
        check=True,
    )
    trajectory = json.loads(kept.stdout)["demonstrations"][0]["trajectory"]
    return [step["behaviour"] for step in trajectory]


def children(pid: int) -> list[int]:
    """Return the processes that a process has started."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                parent = int((entry / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:
                continue
            if parent == pid:
                found.append(int(entry.name))
    return found


@pytest.mark.slow
def test_a_recorded_command_is_verified_and_becomes_a_step(
    open_terminal: OpenTerminal, voices: Voices, tangy: str, tmp_path: Path
) -> None:
    file = voices.file("greet everyone")
    terminal = open_terminal("teach", "--seed", "1", "--mic", str(file))
    terminal.until("Did you say: greet everyone?")
    terminal.settle(0.4)
    terminal.type("y")
    terminal.until("-> greet everyone")
    terminal.type("\x03")
    assert terminal.wait() == 0
    assert steps(tangy, tmp_path / "data") == ["greeting"]


@pytest.mark.slow
def test_push_to_talk_over_a_laptop_microphone_gives_a_step(
    open_terminal: OpenTerminal,
    laptop: Callable[[], Laptop],
    voices: Voices,
    tangy: str,
    tmp_path: Path,
) -> None:
    terminal = open_terminal("teach", "--seed", "1", "--mic", "socket", columns=100, lines=30)
    terminal.until("t talk   then say")
    microphone = laptop()
    terminal.until("microphone is connected")
    terminal.type("t")
    terminal.until("● listening")
    microphone.say(terminal, voices.say("greet everyone"))
    terminal.until(lambda text: "greet" in text.partition("● listening")[2])  # while it is spoken
    terminal.type("t")
    terminal.until("Did you say: greet everyone?")
    terminal.settle(0.4)
    terminal.type("y")
    terminal.until("-> greet everyone")
    terminal.until("○ t talk")
    terminal.type("t")
    terminal.until("● listening")
    microphone.say(terminal, voices.say("stop"))
    terminal.until("Heard: stop.")  # without a key
    terminal.type("\x03")
    assert terminal.wait() == 0
    assert steps(tangy, tmp_path / "data") == ["greeting"]
    shown = terminal.raw.decode(errors="replace")
    assert "Traceback" not in shown
    assert "ERROR" not in shown


@pytest.mark.slow
def test_a_decoder_killed_during_an_utterance_loses_nothing(
    open_terminal: OpenTerminal, laptop: Callable[[], Laptop], voices: Voices
) -> None:
    terminal = open_terminal("teach", "--seed", "1", "--mic", "socket", columns=100, lines=30)
    terminal.until("t talk   then say")
    microphone = laptop()
    terminal.until("microphone is connected")
    (decoder,) = children(terminal.process.pid)
    pcm = voices.say("greet everyone")
    terminal.type("t")
    terminal.until("● listening")
    microphone.say(terminal, pcm[: len(pcm) // 2])
    os.kill(decoder, signal.SIGKILL)
    microphone.say(terminal, pcm[len(pcm) // 2 :])
    terminal.until("stopped by itself (signal 9)")
    terminal.type("t")
    terminal.until("Did you say: greet everyone?")
    (other,) = children(terminal.process.pid)
    assert other != decoder
    terminal.process.kill()
    assert ended(other)


def test_keys_work_while_sound_comes_from_standard_input(
    open_tmux: Callable[[int, int], Tmux], voices: Voices, tangy: str, tmp_path: Path
) -> None:
    tmux = open_tmux(80, 24)
    file = voices.folder / "greeting.raw"
    file.write_bytes(voices.say("greet everyone") + bytes(2 * RATE))
    data = str(tmp_path / "data")
    words = ("teach", "--teacher", "Ada", "--hands-free", "--mic", "-", "--data", data)
    tmux.run("cat", str(file), "|", tangy, *words)
    tmux.until("Did you say: greet everyone?")
    tmux.confirm("-> greet everyone")
    tmux("send-keys", "C-c")


@pytest.mark.slow
def test_a_no_executes_nothing_and_takes_the_next_command(
    open_terminal: OpenTerminal, voices: Voices
) -> None:
    file = voices.file("call a number")
    terminal = open_terminal("teach", "--seed", "1", "--mic", str(file))
    terminal.until("Did you say: call number?")
    terminal.settle(0.4)
    terminal.type("n")
    terminal.until(lambda text: "Did you say" not in text and "> type a command" in text)
    assert "No steps yet" in terminal.text
    terminal.type("greet everyone\r")  # the heard words are not in the line
    terminal.until("Did you say: greet everyone?")


@pytest.mark.slow
def test_a_script_of_answers_controls_a_recording_by_lines(
    voices: Voices, tangy: str, tmp_path: Path
) -> None:
    script, file = tmp_path / "answers", tmp_path / "two.wav"
    script.write_text("y\ny\n")
    said = voices.say("greet everyone") + bytes(RATE) + voices.say("call the next number", "rms")
    file.write_bytes(wav(said))
    done = subprocess.run(  # noqa: S603 - our own program
        [
            *(tangy, "teach", "--plain", "--seed", "1", "--mic", str(file)),
            *("--script", str(script), "--data", str(tmp_path / "data")),
        ],
        capture_output=True,
        timeout=PATIENCE,
        check=True,
    )
    assert b"-> greet everyone" in done.stdout
    assert b"-> call number" in done.stdout
    assert done.stderr == b""


@pytest.mark.slow
def test_an_activity_without_cards_is_taught_by_voice_alone(
    voices: Voices, tangy: str, tmp_path: Path
) -> None:
    said = ("welcome everyone", "yes please", "ask the question", "yes please")
    file = tmp_path / "trivia.wav"
    file.write_bytes(wav(bytes(2 * RATE).join(voices.say(text) for text in said)))
    script = tmp_path / "none"
    script.write_text("")
    words = ("teach", "--plain", "--activity", "trivia", "--guided", "--seed", "11")
    heard = ("--mic", str(file), "--spoken-answers", "--script", str(script))
    done = subprocess.run(  # noqa: S603 - our own program
        [tangy, *words, *heard, "--data", str(tmp_path / "data")],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=True,
    )
    assert "-> welcome everyone" in done.stdout
    assert "-> ask question" in done.stdout
    assert "do not know what" not in done.stdout
