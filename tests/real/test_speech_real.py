"""Speech through the real decoder: synthetic voices in, behaviours out, and a worker that dies."""

from __future__ import annotations

import asyncio
import json
import os
import pty
import select
import shutil
import signal
import subprocess
import sys
import wave
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.person import Person, load_people
from tangy_tui.learning.commands import Phrasebook
from tangy_tui.learning.microphone import open_microphone, split
from tangy_tui.learning.speech import (
    END_SECONDS,
    WORKER,
    Recogniser,
    SpeechUnavailable,
    listen,
    understand,
)
from tangy_tui.learning.wav import RATE, read_wav

pytestmark = pytest.mark.skipif(
    shutil.which("flite") is None, reason="flite is not installed: nobody to speak the commands"
)

PATIENCE = 30.0
BOOK = Phrasebook(load_activity("bingo"), load_people(4))
FEW = ("call number", "tell a joke", "go to the front")

Say = Callable[..., Path]


@pytest.fixture
def say(tmp_path: Path) -> Say:
    """Have a voice of flite say something; returns the WAV file."""

    def speak(text: str, voice: str = "slt") -> Path:
        path = tmp_path / f"{text} {voice}.wav"
        command = ["flite", "-voice", voice, "-t", text, "-o", str(path)]
        subprocess.run(command, check=True, capture_output=True)  # noqa: S603
        return path

    return speak


@pytest.fixture
async def recogniser() -> AsyncIterator[Recogniser]:
    """A recogniser that is ended whatever happens."""
    made = Recogniser()
    yield made
    await made.close()


def ended(pid: int) -> bool:
    """Wait for a process to end."""
    try:
        descriptor = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([descriptor], [], [], PATIENCE)[0])
    finally:
        os.close(descriptor)


def chat(*requests: object, command: tuple[str, ...] = WORKER) -> list[dict[str, Any]]:
    """Send requests to a worker of the test's own and return its answers, until it ends."""
    lines = b"".join(
        r if isinstance(r, bytes) else json.dumps(r).encode() + b"\n" for r in requests
    )
    done = subprocess.run(  # noqa: S603 - our own worker
        command, input=lines, capture_output=True, timeout=PATIENCE, check=True
    )
    return [json.loads(line) for line in done.stdout.splitlines()]


class TestListening:
    def test_spoken_commands_are_understood(self, say: Say) -> None:
        spoken = {
            "greet everyone": ("greeting", {}),
            "call the next number": ("call number", {}),
            "tell a joke": ("joke", {}),
            "go to user two": ("navigate to user", {"user": "user2"}),
            "move the card closer": ("move card closer", {}),
            "remove the markers": ("remove markers", {}),
            "mark the missing numbers": ("mark numbers", {}),
            "encourage the player": ("encourage", {}),
            "go back to the front": ("navigate to front", {}),
            "celebrate the winner": ("celebrate", {}),
            "say goodbye to everyone": ("valediction", {}),
        }
        files = [say(text) for text in spoken]
        rows = listen(files, BOOK)
        assert [row["file"] for row in rows] == [str(file) for file in files]
        assert [(row["behaviour"], row["arguments"]) for row in rows] == list(spoken.values())
        assert [row["heard"] for row in rows] == list(spoken)
        assert min(row["confidence"] for row in rows) > 0.8
        json.dumps(rows)

    @pytest.mark.parametrize("voice", ["rms", "kal16", "kal"])
    def test_other_voices_are_understood(self, say: Say, voice: str) -> None:
        rows = listen([say(text, voice) for text in FEW], BOOK)
        assert [row["behaviour"] for row in rows] == ["call number", "joke", "navigate to front"]

    def test_other_speech_is_not_taken_for_a_command(self, say: Say) -> None:
        other = [
            "the soup was too salty",
            "have you seen my glasses",
            "the card is on the table",
            "she told me a long story about the game",
        ]
        rows = listen([say(text) for text in other], BOOK)
        assert [row["behaviour"] for row in rows] == [None] * 4

    def test_several_commands_in_one_file_give_several_rows(self, say: Say, tmp_path: Path) -> None:
        both = tmp_path / "both.wav"
        with wave.open(str(both), "wb") as file:
            file.setparams((1, 2, RATE, 0, "NONE", ""))
            for text in FEW[1:]:
                file.writeframes(read_wav(say(text)) + bytes(2 * RATE))
        rows = listen([both], BOOK)
        assert [row["behaviour"] for row in rows] == ["joke", "navigate to front"]

    def test_silence_gives_a_row_in_which_nothing_was_heard(self, tmp_path: Path) -> None:
        path = tmp_path / "silence.wav"
        with wave.open(str(path), "wb") as file:
            file.setparams((1, 2, RATE, 0, "NONE", ""))
            file.writeframes(bytes(2 * RATE))
        (row,) = listen([path], BOOK)
        assert (row["heard"], row["behaviour"], row["confidence"]) == ("", None, 0.0)


class TestRecogniser:
    async def test_utterances_of_a_source_become_commands(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        await recogniser.start(BOOK.spoken())
        microphone = open_microphone(str(say("celebrate the win")))
        found = [understand(await recogniser.decode(pcm), BOOK) async for pcm in microphone]
        assert [command and command.behaviour for command in found] == ["celebrate"]

    async def test_names_outside_the_dictionary_are_reported_and_left_out(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        book = Phrasebook(
            load_activity("bingo"), [Person("user1", "Xhqzr"), Person("user2", "Rosa")]
        )
        await recogniser.start(book.spoken())
        assert recogniser.left_out == ("xhqzr",)
        heard = await recogniser.decode(split(read_wav(say("go to Rosa")))[0])
        command = understand(heard, book)
        assert command is not None
        assert command.arguments == {"user": "user2"}

    async def test_the_same_sound_is_heard_alike_every_time(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        await recogniser.start(FEW)
        one, other = (split(read_wav(say(text)))[0] for text in FEW[:2])
        first = await recogniser.decode(one)
        await recogniser.decode(other)
        assert await recogniser.decode(one) == first
        assert first.seconds == pytest.approx(len(one) / 2 / RATE, abs=0.001)

    @pytest.mark.parametrize("pcm", [b"", b"\0", bytes(640), bytes(4 * RATE), b"\x11\x99" * RATE])
    async def test_odd_sounds_are_nothing(self, recogniser: Recogniser, pcm: bytes) -> None:
        await recogniser.start(FEW)
        heard = await recogniser.decode(pcm)
        assert understand(heard, BOOK) is None

    async def test_what_is_too_long_is_refused_and_the_next_is_heard(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        await recogniser.start(FEW)
        with pytest.raises(SpeechUnavailable, match="longer than"):
            await recogniser.decode(bytes(2 * RATE * 31))
        assert (await recogniser.decode(read_wav(say(FEW[1])))).text == FEW[1]

    async def test_phrases_that_nobody_can_pronounce_are_refused(
        self, recogniser: Recogniser
    ) -> None:
        with pytest.raises(SpeechUnavailable, match="pronounced"):
            await recogniser.start(["xhqzr qqq"])
        assert recogniser.pid is None

    async def test_a_missing_decoder_is_said(
        self, recogniser: Recogniser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        (tmp_path / "pocketsphinx.py").write_text("raise ImportError(name='pocketsphinx')")
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        with pytest.raises(SpeechUnavailable, match="needs the package pocketsphinx"):
            await recogniser.start(FEW)


class TestDeath:
    async def test_a_worker_that_is_killed_is_noticed_and_started_again(self, say: Say) -> None:
        told: asyncio.Queue[str] = asyncio.Queue()
        recogniser = Recogniser(notify=told.put_nowait)
        try:
            await recogniser.start(FEW)
            first = recogniser.pid
            assert first is not None
            os.kill(first, signal.SIGKILL)
            sentence = await asyncio.wait_for(told.get(), PATIENCE)
            assert "signal 9" in sentence
            assert "\n" not in sentence
            assert (await recogniser.decode(read_wav(say(FEW[1])))).text == FEW[1]
            assert recogniser.pid not in (None, first)
        finally:
            await recogniser.close()
        assert told.empty()  # an end that was asked for is no news

    async def test_a_worker_that_dies_over_an_utterance_is_an_error_not_a_wait(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        await recogniser.start(FEW)
        pid, sound = recogniser.pid, read_wav(say(FEW[1]))
        assert pid is not None
        os.kill(pid, signal.SIGSTOP)
        decoding = asyncio.create_task(recogniser.decode(sound))
        await asyncio.wait({decoding}, timeout=0.1)
        assert not decoding.done()
        os.kill(pid, signal.SIGKILL)
        with pytest.raises(SpeechUnavailable, match="signal 9"):
            await asyncio.wait_for(decoding, PATIENCE)
        assert (await recogniser.decode(sound)).text == FEW[1]

    async def test_a_worker_that_hangs_is_ended(
        self, recogniser: Recogniser, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        await recogniser.start(FEW)
        monkeypatch.setattr("tangy_tui.learning.speech.DECODE_SECONDS", 0.1)
        pid = recogniser.pid
        assert pid is not None
        os.kill(pid, signal.SIGSTOP)
        with pytest.raises(SpeechUnavailable, match="did not answer"):
            await recogniser.decode(bytes(2 * RATE))
        assert ended(pid)

    async def test_an_utterance_nobody_waits_for_does_not_answer_the_next(
        self, say: Say, recogniser: Recogniser
    ) -> None:
        await recogniser.start(FEW)
        one, other = (read_wav(say(text)) for text in FEW[:2])
        given_up = asyncio.create_task(recogniser.decode(one))
        await asyncio.wait({given_up}, timeout=0.001)
        given_up.cancel()
        assert (await recogniser.decode(other)).text == FEW[1]

    async def test_closing_ends_the_worker(self, recogniser: Recogniser) -> None:
        await recogniser.start(FEW)
        pid = recogniser.pid
        assert pid is not None
        await recogniser.close()
        assert ended(pid)
        assert recogniser.pid is None
        with pytest.raises(SpeechUnavailable, match="not started"):
            await recogniser.decode(bytes(2 * RATE))

    async def test_closing_does_not_wait_for_a_worker_that_hangs(
        self, recogniser: Recogniser
    ) -> None:
        await recogniser.start(FEW)
        pid = recogniser.pid
        assert pid is not None
        os.kill(pid, signal.SIGSTOP)
        decoding = asyncio.create_task(recogniser.decode(bytes(2 * RATE)))
        await asyncio.wait({decoding}, timeout=0.1)
        await asyncio.wait_for(recogniser.close(), END_SECONDS)
        assert ended(pid)
        with pytest.raises(SpeechUnavailable):
            await decoding

    def test_the_worker_ends_when_its_input_closes(self) -> None:
        assert chat({"id": 7, "phrases": FEW}) == [{"id": 7, "ready": True, "left_out": []}]

    def test_the_worker_ends_when_the_program_is_killed(self) -> None:
        code = (
            "import asyncio\n"
            "from tangy_tui.learning.speech import Recogniser\n"
            "async def run():\n"
            "    recogniser = Recogniser()\n"
            "    await recogniser.start(['call number'])\n"
            "    print(recogniser.pid, flush=True)\n"
            "    await asyncio.Event().wait()\n"
            "asyncio.run(run())\n"
        )
        with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE) as program:  # noqa: S603
            assert program.stdout is not None
            pid = int(program.stdout.readline())
            program.kill()
        assert ended(pid)


class TestProtocol:
    def test_garbage_is_answered_with_errors(self) -> None:
        answers = chat(
            b"hello\n",
            b"\xff\xfe\n",
            b"[" * 100_000 + b"\n",
            {"id": 1},
            {"id": 2, "pcm": "AAAA"},
            {"id": 3, "phrases": FEW},
            {"id": 4, "pcm": "not base64!"},
            {"id": 5, "pcm": ""},
            {"id": 6, "phrases": ["<s> (", "\\end\\", "a\nb"]},
        )
        assert [answer["id"] for answer in answers] == [None, None, None, 1, 2, 3, 4, 5, 6]
        assert all("error" in answer for answer in answers[:5])
        assert "base64" in answers[6]["error"]
        assert answers[7]["text"] == ""
        assert answers[8]["left_out"] == ["(", "<s>", "\\end\\"]

    def test_what_the_library_prints_stays_out_of_the_answers(self) -> None:
        code = (
            "import os\n"
            "from tangy_tui.learning import speech_worker\n"
            "class Noisy(speech_worker.Worker):\n"
            "    def answer(self, request):\n"
            "        os.write(1, b'noise')\n"
            "        print('noise', flush=True)\n"
            "        return super().answer(request)\n"
            "speech_worker.Worker = Noisy\n"
            "speech_worker.main()\n"
        )
        answers = chat({"id": 1, "phrases": FEW}, command=(sys.executable, "-c", code))
        assert answers == [{"id": 1, "ready": True, "left_out": []}]

    def test_nothing_is_written_to_the_terminal(self, say: Say, tmp_path: Path) -> None:
        code = (
            "import asyncio, os, sys\n"
            "from pathlib import Path\n"
            "from tangy_tui.learning.wav import read_wav\n"
            "from tangy_tui.learning.speech import Recogniser, SpeechUnavailable\n"
            "async def run():\n"
            "    recogniser = Recogniser(log=Path(sys.argv[2]))\n"
            "    await recogniser.start(['tell a joke', 'xhqzr'])\n"
            "    heard = await recogniser.decode(read_wav(Path(sys.argv[1])))\n"
            "    assert os.getsid(recogniser.pid) != os.getsid(0)\n"
            "    os.kill(recogniser.pid, 11)\n"
            "    try:\n"
            "        await recogniser.decode(bytes(64000))\n"
            "    except SpeechUnavailable:\n"
            "        pass\n"
            "    await recogniser.close()\n"
            "    sys.exit(0 if heard.text == 'tell a joke' else 9)\n"
            "asyncio.run(run())\n"
        )
        parent, child = pty.openpty()
        command = [sys.executable, "-c", code, str(say("tell a joke")), str(tmp_path / "log")]
        with subprocess.Popen(command, stdin=child, stdout=child, stderr=child) as program:  # noqa: S603
            status = program.wait(PATIENCE)
        os.close(child)
        shown = b""
        while select.select([parent], [], [], 0)[0]:
            try:
                shown += os.read(parent, 4096)
            except OSError:  # the terminal's other side is closed
                break
        os.close(parent)
        assert (status, shown) == (0, b"")
        assert (tmp_path / "log").exists()
