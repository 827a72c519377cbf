"""Speech through the real decoder: synthetic voices, recognised behaviours, and a killed worker."""

from __future__ import annotations

import asyncio
import base64
import itertools
import json
import os
import pty
import select
import shutil
import signal
import subprocess
import sys
from collections.abc import Awaitable, Iterator
from pathlib import Path
from threading import Thread
from time import perf_counter
from typing import Any, TypeVar

import pytest

from tangy_hw.audio.wav import RATE
from tangy_profiles.activity import load_activity
from tangy_profiles.codec import encode
from tangy_profiles.person import Person, load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.intents import Intents
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.speech.decoder import make_decoder
from tangy_tui.speech.evidence import (
    LONGEST,
    USUAL,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
)
from tangy_tui.speech.input import SpeechInput
from tangy_tui.speech.recogniser import WORKER, Recogniser, SpeechUnavailable
from tangy_tui.speech.transcription import listen, tier_of
from tangy_tui.speech.understanding import understand, wanted
from tangy_tui.speech.worker import Worker
from tests.hw.sounds import wav
from tests.real.voices import FESTIVAL, NOISES, Voices
from tests.support.terminal import PATIENCE
from tests.support.waiting import until

pytestmark = [
    pytest.mark.skipif(shutil.which("flite") is None, reason="flite is not installed"),
    pytest.mark.xdist_group("speech"),  # they share a worker and the voices
]

T = TypeVar("T")

BOOK = Phrasebook(load_activity("bingo"), load_people(4))
WANTED = wanted(BOOK, USUAL)
FEW = DecoderVocabulary(("call number", "tell a joke", "go to the front"))
PIECE = 1_600  # bytes, 50 ms

KNOWN = [
    ("greet everyone", "slt", "greeting", {}),
    ("call the next number", "rms", "call number", {}),
    ("tell a joke", "kal16", "joke", {}),
    ("go to user two", "slt", "navigate to user", {"user": "user2"}),
    ("move the card closer", "rms", "move card closer", {}),
    ("remove the markers", "kal16", "remove markers", {}),
    ("mark the missing numbers", "slt", "mark numbers", {}),
    ("encourage the player", "rms", "encourage", {}),
    ("go back to the front", "kal16", "navigate to front", {}),
    ("celebrate the winner", FESTIVAL, "celebrate", {}),
    ("say goodbye to everyone", FESTIVAL, "valediction", {}),
]
UNKNOWN = [
    ("please call another number", "slt", "call number"),
    ("drive back to the front", "rms", "navigate to front"),
    ("go back to front please", "kal16", "navigate to front"),
    ("let us hear a joke", "rms", "joke"),
]
FREE = [
    ("motivate them a little", "awb", "encourage"),
    ("get her to move that card in a bit", "awb", "move card closer"),
    ("tell him to slide the card over to you", "kal16", "move card closer"),
]
OTHER = [
    ("the soup was too salty", "slt"),
    ("have you seen my glasses", "rms"),
    ("the card is on the table", "kal16"),
    ("she told me a long story about the game", "slt"),
    ("my sister lives in canada", "rms"),
]


class Studio:
    """One worker that the tests share, and its event loop."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.recogniser = Recogniser(notify=self.told.append)
        self._runner = asyncio.Runner()

    def run(self, doing: Awaitable[T]) -> T:
        async def patiently() -> T:
            return await asyncio.wait_for(doing, PATIENCE)

        return self._runner.run(patiently())

    def decode(self, pcm: bytes) -> AcousticEvidence:
        return self.run(self.recogniser.decode(pcm))

    def hear(self, pcm: bytes) -> tuple[str, str | None, dict[str, str]]:
        """Return the tier of an utterance, and its likeliest meaning."""
        said = understand(self.decode(pcm), BOOK, USUAL)
        if not isinstance(said, Say) or not said.commands:
            return tier_of(said), None, {}
        return tier_of(said), said.commands[0].behaviour, dict(said.commands[0].arguments)

    def close(self) -> None:
        self.run(self.recogniser.close())
        self._runner.close()


def hands_free(pcm: bytes) -> tuple[float, AcousticEvidence]:
    """Return the first utterance in a sound, and its delay from the sound's beginning in s."""
    answers: list[dict[str, Any]] = []
    worker = Worker(answers.append)
    worker.take({"id": 1, "wanted": encode(WANTED)})
    worker.take({"id": 2, "begin": "commands", "endpoint": True})
    pcm += bytes(2 * RATE)
    for place in range(0, len(pcm), PIECE):
        worker.take({"pcm": base64.b64encode(pcm[place : place + PIECE]).decode()})
        if heard := next((answer["heard"] for answer in answers if "heard" in answer), None):
            return (place + PIECE) / 2 / RATE, AcousticEvidence(**heard)
    raise AssertionError(f"nothing was heard: {answers}")


@pytest.fixture(scope="session")
def voices(tmp_path_factory: pytest.TempPathFactory) -> Voices:
    return Voices(tmp_path_factory.mktemp("voices"))


@pytest.fixture(scope="module")
def _studio() -> Iterator[Studio]:
    made = Studio()
    made.run(made.recogniser.start(WANTED))
    yield made
    made.close()


@pytest.fixture
def studio(_studio: Studio) -> Studio:
    """The running worker that listens for all phrases."""
    _studio.told.clear()
    _studio.recogniser.partial = lambda words: None
    return _studio


class TestVoices:
    @pytest.mark.slow
    def test_known_phrases_are_recognised_with_certainty(
        self, studio: Studio, voices: Voices
    ) -> None:
        found = {said: studio.hear(voices.say(said, voice)) for said, voice, _, _ in KNOWN}
        assert found == {said: ("sure", name, who) for said, _, name, who in KNOWN}

    def test_paraphrases_are_verified_or_offered(self, studio: Studio, voices: Voices) -> None:
        found = [(*studio.hear(voices.say(said, voice))[:2], name) for said, voice, name in UNKNOWN]
        taken = [(first, name) for tier, first, name in found if tier in ("sure", "unsure")]
        assert all(first == name for first, name in taken), found
        assert len(taken) >= len(UNKNOWN) - 1, found  # the bench says how many in the long run

    @pytest.mark.slow
    def test_free_wordings_are_understood_from_guesses_at_the_sentence(
        self, voices: Voices
    ) -> None:
        book = Phrasebook(load_activity("bingo"), load_people(4), Intents().model)
        decoder = make_decoder(wanted(book, USUAL))
        for said, voice, meant in FREE:
            evidence = decoder.decode(voices.say(said, voice), "commands")
            found = understand(evidence, book, USUAL)
            assert isinstance(found, Say) and found.commands, said
            assert found.commands[0].behaviour == meant
            assert evidence.words not in evidence.guesses  # only the words were misheard
        assert not decoder.decode(voices.say(*KNOWN[0][:2]), "commands").guesses
        polite = decoder.decode(voices.say("please tell a joke", "slt"), "commands")
        assert polite.words == "please tell a joke" and not polite.guesses
        decoder.close()

    @pytest.mark.slow
    def test_other_speech_is_no_command(self, studio: Studio, voices: Voices) -> None:
        found = {said: studio.hear(voices.say(said, voice))[0] for said, voice in OTHER}
        assert found == dict.fromkeys(found, "nothing")

    @pytest.mark.slow
    @pytest.mark.parametrize("voice", ["slt", "kal16", FESTIVAL])
    @pytest.mark.parametrize(
        "words", ["stop", "stop the robot", "emergency stop", "stop the game", "stop right away"]
    )
    def test_stop_is_heard_from_every_voice(
        self, studio: Studio, voices: Voices, voice: str, words: str
    ) -> None:
        assert studio.hear(voices.say(words, voice))[0] == "stop"

    def test_noises_are_no_command(self, studio: Studio, voices: Voices) -> None:
        found = {name: studio.hear(voices.noise(name))[0] for name in NOISES}
        assert found == dict.fromkeys(NOISES, "nothing")

    def test_noise_20_dB_below_the_voice_loses_no_command(
        self, studio: Studio, voices: Voices
    ) -> None:
        for said, voice, name, who in KNOWN[:4]:
            assert studio.hear(voices.say(said, voice, noise=20)) == ("sure", name, who)

    @pytest.mark.parametrize(
        "pcm",
        [b"", b"\0", bytes(640), bytes(4 * RATE), b"\x11\x99" * RATE, bytes(2 * RATE * LONGEST)],
        ids=["none", "half a sample", "20 ms", "silence", "a flat line", "the longest"],
    )
    def test_odd_sounds_are_no_command(self, studio: Studio, pcm: bytes) -> None:
        assert studio.hear(pcm)[0] == "nothing"

    def test_decoding_is_deterministic(self, studio: Studio, voices: Voices) -> None:
        one, other = voices.say("tell a joke", "kal16"), voices.say("greet everyone")
        first = studio.decode(one)
        studio.decode(other)
        assert studio.decode(one) == first
        assert first.seconds == pytest.approx(len(one) / 2 / RATE)


class TestStream:
    async def speak(self, sound: asyncio.Queue[bytes], pcm: bytes) -> None:
        for place in range(0, len(pcm), PIECE):
            sound.put_nowait(pcm[place : place + PIECE])
            await asyncio.sleep(0)

    def test_partial_words_arrive_before_the_end(self, studio: Studio, voices: Voices) -> None:
        shown: list[str] = []

        async def talk() -> AcousticEvidence:
            sound: asyncio.Queue[bytes] = asyncio.Queue()
            whole = asyncio.Event()

            def partial(words: str) -> None:
                shown.append(words)
                if words == "call the next number":
                    whole.set()

            studio.recogniser.partial = partial
            hearing = asyncio.create_task(studio.recogniser.hear(sound))
            await self.speak(sound, voices.say("call the next number", "rms"))
            await whole.wait()
            assert not hearing.done()
            sound.put_nowait(b"")
            return await hearing

        assert studio.run(talk()).words == "call the next number"
        assert len(set(shown)) >= 3

    @pytest.mark.slow
    def test_a_worker_killed_during_an_utterance_loses_nothing(
        self, studio: Studio, voices: Voices
    ) -> None:
        pcm = voices.say("call the next number", "rms")
        alone = studio.decode(pcm)
        first = studio.recogniser.pid
        assert first is not None

        async def talk() -> AcousticEvidence:
            sound: asyncio.Queue[bytes] = asyncio.Queue()
            begun = asyncio.Event()
            studio.recogniser.partial = lambda words: begun.set()
            hearing = asyncio.create_task(studio.recogniser.hear(sound))
            await self.speak(sound, pcm[: len(pcm) // 2])
            await begun.wait()
            os.kill(first, signal.SIGKILL)
            await self.speak(sound, pcm[len(pcm) // 2 :])
            sound.put_nowait(b"")
            return await hearing

        heard = studio.run(talk())  # in the pause at its end, before the last quiet has passed
        assert (heard.words, heard.phrase) == (alone.words, alone.phrase)
        assert studio.recogniser.pid not in (None, first)
        assert studio.recogniser.said == pcm
        (sentence,) = studio.told
        assert "signal 9" in sentence

    @pytest.mark.parametrize(
        ("said", "voice"),
        [
            *(("stop", "slt"), ("stop", "rms"), ("stop", "kal16"), ("tangy stop", "slt")),
            *(("stop the robot", "slt"), ("emergency stop", "rms"), ("make it stop", "slt")),
        ],
    )
    def test_stop_ends_the_utterance(
        self, studio: Studio, voices: Voices, said: str, voice: str
    ) -> None:
        async def talk() -> AcousticEvidence:
            sound: asyncio.Queue[bytes] = asyncio.Queue()
            await self.speak(sound, voices.say(said, voice))
            return await studio.recogniser.hear(sound)

        assert isinstance(understand(studio.run(talk()), BOOK, USUAL), StopCommand)

    @pytest.mark.slow
    @pytest.mark.parametrize("voice", ["slt", "rms", "awb"])
    @pytest.mark.parametrize(
        ("said", "soon"), [("stop the robot", 0.2), ("emergency stop", 0.2), ("make it stop", 0.5)]
    )
    def test_a_hands_free_stop_is_detected_before_the_endpoint(
        self, voices: Voices, said: str, soon: float, voice: str
    ) -> None:
        pcm = voices.say(said, voice)
        loud = [abs(sample) > 1000 for sample in memoryview(pcm).cast("h")]
        last = (len(loud) - loud[::-1].index(True)) / RATE  # s, the end of its last sound
        seconds, evidence = hands_free(pcm)
        assert isinstance(understand(evidence, BOOK, USUAL), StopCommand)
        assert seconds - last <= soon

    @pytest.mark.slow
    def test_at_most_one_other_sentence_with_stop_stops_hands_free(self, voices: Voices) -> None:
        others = ("stop teasing her", "stop by the red table", "he stopped playing", "do not stop")
        taken = [
            (said, voice)
            for said, voice in itertools.product(others, ("slt", "rms"))
            if isinstance(
                understand(hands_free(voices.say(said, voice))[1], BOOK, USUAL), StopCommand
            )
        ]
        assert len(taken) <= 1, taken

    def test_the_result_arrives_soon_after_the_end(
        self, studio: Studio, voices: Voices, capsys: pytest.CaptureFixture[str]
    ) -> None:
        took: list[float] = []
        at_rest: list[float] = []

        async def talk(pcm: bytes) -> None:
            begun = perf_counter()
            await studio.recogniser.decode(pcm)
            at_rest.append(perf_counter() - begun)
            sound: asyncio.Queue[bytes] = asyncio.Queue()
            hearing = asyncio.create_task(studio.recogniser.hear(sound))
            await self.speak(sound, pcm)
            await until(sound.empty)  # unchanged words are not reported again
            ended_at = perf_counter()
            sound.put_nowait(b"")
            await hearing
            took.append(perf_counter() - ended_at)

        for said, voice, _, _ in KNOWN[:3]:
            studio.run(talk(voices.say(said, voice)))
        with capsys.disabled():
            print(f"\nend of an utterance -> evidence: {', '.join(f'{t:.2f}' for t in took)} s")
        assert sum(took) < 4 * sum(at_rest)


class TestEars:
    @pytest.mark.slow
    def test_a_stream_is_split_into_understood_utterances(
        self, voices: Voices, tmp_path: Path
    ) -> None:
        gap = bytes(RATE)
        stream = b"".join(
            gap + part
            for part in (
                voices.noise("claps"),
                voices.say("the soup was too salty"),
                voices.say("call the next number", "rms"),
                voices.say("tell a joke", "kal16"),
                voices.say("stop"),
            )
        )
        reading, writing = os.pipe()

        async def hear() -> list[object]:
            ears = SpeechInput("-", BOOK, hands_free=True, stdin=reading, folder=tmp_path)
            try:
                return [heard async for heard in ears]
            finally:
                await ears.close()

        def speak() -> None:
            with os.fdopen(writing, "wb") as pipe:
                pipe.write(stream + gap)

        speaker = Thread(target=speak)
        speaker.start()
        try:
            heard = asyncio.run(asyncio.wait_for(hear(), PATIENCE))
        finally:
            os.close(reading)
            speaker.join()
        commands = [
            one.commands[0].behaviour for one in heard if isinstance(one, Say) and one.commands
        ]
        assert commands == ["call number", "joke"]
        assert StopCommand("stop") in heard

    @pytest.mark.slow
    def test_files_are_transcribed(self, voices: Voices, tmp_path: Path) -> None:
        both = tmp_path / "both.wav"
        both.write_bytes(
            wav(voices.say("tell a joke", "kal16") + bytes(2 * RATE) + voices.say("greet everyone"))
        )
        silence = tmp_path / "silence.wav"
        silence.write_bytes(wav(bytes(2 * RATE)))
        rows = listen([both, voices.file("call the next number", "rms"), silence], BOOK)
        assert [row["behaviour"] for row in rows] == ["joke", "greeting", "call number", None]
        assert [row["tier"] for row in rows] == ["sure"] * 3 + ["nothing"]
        assert rows[-1]["heard"] == ""
        json.dumps(rows)

    @pytest.mark.slow
    def test_the_paper_mode_understands_phrases(self, voices: Voices) -> None:
        settings = EvidenceSettings(mode="paper")
        files = [voices.file(said, voice) for said, voice, _, _ in KNOWN[:3]]
        rows = listen([*files, voices.file("stop")], BOOK, settings)
        assert [row["behaviour"] for row in rows] == [name for _, _, name, _ in KNOWN[:3]] + [None]
        assert rows[-1]["tier"] == "stop"


class TestWorker:
    @pytest.mark.slow
    def test_unpronounceable_names_are_left_out_and_reported(self, voices: Voices) -> None:
        people = [Person("user1", "Xhqzr"), Person("user2", "Rosa")]
        book = Phrasebook(load_activity("bingo"), people)
        studio = Studio()
        try:
            studio.run(studio.recogniser.start(wanted(book, USUAL)))
            assert "xhqzr" in studio.recogniser.left_out
            said = understand(studio.decode(voices.say("go to Rosa")), book, USUAL)
            assert isinstance(said, Say)
            assert said.commands is not None
            assert said.commands[0].arguments == {"user": "user2"}
            pid = studio.recogniser.pid
            with pytest.raises(SpeechUnavailable, match="pronounced"):
                studio.run(studio.recogniser.start(DecoderVocabulary(("xhqzr qqq",))))
            studio.run(studio.recogniser.start(FEW))
            assert studio.recogniser.pid == pid
            assert studio.decode(voices.say("tell a joke", "kal16")).words == "tell a joke"
        finally:
            studio.close()

    def test_a_missing_decoder_is_reported(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        (tmp_path / "pocketsphinx.py").write_text("raise ImportError(name='pocketsphinx')")
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        studio = Studio()
        try:
            with pytest.raises(SpeechUnavailable, match="needs the package pocketsphinx"):
                studio.run(studio.recogniser.start(FEW))
            assert studio.recogniser.pid is None
        finally:
            studio.close()

    @pytest.mark.slow
    def test_garbage_is_answered_with_errors_until_the_end_of_input(self) -> None:
        requests: list[object] = [
            b"hello\n",
            b"\xff\xfe\n",
            b"[" * 100_000 + b"\n",
            {"id": 1},
            {"id": 2, "begin": "commands"},
            {"id": 3, "wanted": encode(FEW)},
            {"id": 4, "begin": "commands"},
            {"pcm": "not base64!"},
            {"id": 5, "begin": "answers"},
            {"id": 5, "end": True},
            {"id": 6, "wanted": encode(DecoderVocabulary(("<s> (", "\\end\\", "a\nb", "/1/ a;")))},
            {"id": 7, "wanted": encode(DecoderVocabulary(("a",), pronunciations={"a": ("QQ",)}))},
            {"id": 8, "pieces": ""},
        ]
        lines = b"".join(
            r if isinstance(r, bytes) else json.dumps(r).encode() + b"\n" for r in requests
        )
        done = subprocess.run(  # noqa: S603 - our own worker
            WORKER, input=lines, capture_output=True, timeout=PATIENCE, check=True
        )
        answers: list[dict[str, Any]] = [json.loads(line) for line in done.stdout.splitlines()]
        assert [answer["id"] for answer in answers] == [None, None, None, 1, 2, 3, 4, 5, 6, 7, 8]
        assert all("error" in answer for answer in answers[:5])
        assert answers[5]["ready"]
        assert "base64" in answers[6]["error"]
        assert answers[7]["heard"]["words"] == ""
        assert "(" in answers[8]["left_out"]
        assert answers[10]["found"] == []

    @pytest.mark.slow
    def test_nothing_is_written_to_the_terminal(self, voices: Voices, tmp_path: Path) -> None:
        code = (
            "import asyncio, os, sys\n"
            "from pathlib import Path\n"
            "from tangy_hw.audio.wav import read_wav\n"
            "from tangy_tui.speech.evidence import DecoderVocabulary\n"
            "from tangy_tui.speech.recogniser import Recogniser\n"
            "async def run():\n"
            "    asyncio.get_running_loop().slow_callback_duration = 60.0\n"
            "    recogniser = Recogniser(log=Path(sys.argv[2]))\n"
            "    await recogniser.start(DecoderVocabulary(('tell a joke', 'xhqzr', 'a(b')))\n"
            "    first, sound = recogniser.pid, asyncio.Queue()\n"
            "    assert os.getsid(first) != os.getsid(0)\n"
            "    begun = asyncio.Event()\n"
            "    recogniser.partial = lambda words: begun.set()\n"
            "    hearing = asyncio.create_task(recogniser.hear(sound))\n"
            "    pcm = read_wav(Path(sys.argv[1]))\n"
            "    for place in range(0, len(pcm), 3200):\n"
            "        sound.put_nowait(pcm[place:place + 3200])\n"
            "    await begun.wait()\n"
            "    os.kill(first, 11)\n"
            "    sound.put_nowait(b'')\n"
            "    heard = await hearing\n"
            "    await recogniser.close()\n"
            "    sys.exit(0 if heard.words == 'tell a joke' else 9)\n"
            "asyncio.run(run())\n"
        )
        parent, child = pty.openpty()
        file = voices.file("tell a joke", "kal16")
        command = [sys.executable, "-X", "dev", "-c", code, str(file), str(tmp_path / "log")]
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
