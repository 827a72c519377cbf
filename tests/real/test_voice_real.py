"""The voice through the real espeak-ng and the real aplay, whose sound card is a named pipe."""

from __future__ import annotations

import asyncio
import os
import re
import select
import shutil
import signal
import subprocess
import wave
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from tangy_hw.audio.number_reader import as_called, marked_up
from tangy_hw.audio.player import PlayerError, examine_output, open_player
from tangy_hw.audio.synthesis import NoSuchVoice, Synthesiser, examine_voice
from tangy_hw.audio.voice import SpeechVoice
from tangy_profiles.activity import load_activity
from tangy_profiles.voice import VoicePreference
from tangy_profiles.wav_length import wav_seconds
from tests.real.conftest import OpenTerminal
from tests.support.terminal import PATIENCE, TANGY

pytestmark = [
    pytest.mark.skipif(
        shutil.which("espeak-ng") is None, reason="espeak-ng is not installed: nobody to speak"
    ),
]
needs_aplay = pytest.mark.skipif(
    shutil.which("aplay") is None, reason="aplay is not installed: nothing to hear with"
)

DECK = load_activity("bingo").deck
LONG = "This goes on and on, about this and that and the other, until nobody listens any more."
QUIET = 60.0  # root mean square of 10 ms of 16-bit samples, below which it is a pause


@pytest.fixture
def synthesiser(tmp_path: Path) -> Synthesiser:
    return Synthesiser(tmp_path / "cache")


@pytest.fixture
def card(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """A named pipe as ALSA's sound card: the played sound is read from this descriptor.

    It plays no faster than it is read.
    """
    pipe, settings = tmp_path / "card", tmp_path / "asound.conf"
    os.mkfifo(pipe)
    settings.write_text(
        f'pcm.!default {{ type file slave.pcm {{ type null }} file "{pipe}" format raw }}\n'
    )
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(settings))
    descriptor = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    yield descriptor
    os.close(descriptor)


@pytest.fixture
def no_card(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Hide every sound card from ALSA."""
    settings = tmp_path / "none.conf"
    settings.write_text("")
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(settings))


def samples(path: Path) -> NDArray[np.float64]:
    with wave.open(str(path)) as file:
        assert file.getparams()[:3] == (1, 2, 22_050)
        return np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(np.float64)


def parts(path: Path) -> tuple[list[float], list[float]]:
    """Return the length of the spoken sound, and the pauses (0.3 s and more) in it, in seconds."""
    sound = samples(path)
    frames = sound[: len(sound) // 220 * 220].reshape(-1, 220).std(axis=1) >= QUIET
    written = "".join("x" if loud else "." for loud in frames).strip(".")
    spoken = re.split(r"\.{30,}", written)
    return [len(s) / 100 for s in spoken], [len(p) / 100 for p in re.findall(r"\.{30,}", written)]


def listen(card: int, wanted: int) -> bytes:
    """Listen to the sound card until this many bytes were heard, or the players have ended."""
    heard = b""
    poll = select.poll()
    poll.register(card, select.POLLIN)
    while len(heard) < wanted:
        assert poll.poll(1000 * PATIENCE), "nobody plays"
        chunk = os.read(card, 4096)
        if not chunk:
            break
        heard += chunk
    return heard


async def hear(card: int, wanted: int) -> bytes:
    """Listen to the sound card while the voice goes on."""
    return await asyncio.to_thread(listen, card, wanted)


def phonemes(text: str) -> str:
    """Return espeak-ng's pronunciation of a text."""
    said = subprocess.run(
        ["espeak-ng", "--stdin", "-q", "-x", "-m", "-z", "-v", "en-us"],  # noqa: S607
        input=marked_up(as_called(text, DECK)),
        capture_output=True,
        text=True,
        check=True,
    )
    return re.sub(r"[^a-zA-Z@\s]", "", said.stdout)


@pytest.mark.parametrize("rate", [100, 140, 180])
def test_a_call_has_pauses_around_it_and_is_slow(synthesiser: Synthesiser, rate: int) -> None:
    preference = VoicePreference(rate)
    path = synthesiser.render(marked_up(as_called("Now come I 22 and so on.", DECK)), preference)
    spoken, pauses = parts(path)
    assert len(spoken) >= 4, "the words before, the call twice, and the words after it"
    assert pauses[0] == pytest.approx(0.4, abs=0.1)
    assert sum(0.5 <= pause <= 0.75 for pause in pauses) >= 2
    plain_text = synthesiser.render("<speak>twenty two.</speak>", preference)
    slow = synthesiser.render(
        '<speak><prosody rate="75%">twenty two.</prosody></speak>', preference
    )
    ratio = sum(parts(slow)[0]) / sum(parts(plain_text)[0])
    assert ratio > (1.1 if rate == 100 else 1.2), "espeak-ng goes no slower than 80 words"


def test_speech_after_a_call_has_normal_speed(synthesiser: Synthesiser) -> None:
    after = "and everybody marks it on the card"
    with_call = parts(synthesiser.render(marked_up(as_called(f"B 5 {after}", DECK))))[0][-1]
    alone = parts(synthesiser.render(f"<speak>{after}</speak>"))[0][-1]
    assert with_call == pytest.approx(alone, rel=0.1)


def test_the_repetition_of_a_call_is_digit_by_digit() -> None:
    assert phonemes("O 69").split() == ["oU", "sIksti", "naIn", "oU", "sIks", "naIn"]
    fifteen, fifty = phonemes("B 15").split(), phonemes("G 50").split()
    assert fifteen == ["bi", "fIftin", "bi", "wVn", "faIv"]
    assert fifty[:2] == ["dZi", "fIfti"]
    assert fifty[3:5] == ["faIv", "zi@roU"]


@pytest.mark.parametrize(
    "text",
    ["<b>", "a & b", '"it\'s"', "-v de", "--help", "Zoë 你好", "[[x]]", "</speak>", "%s;$(id)"],
)
def test_any_text_is_spoken_as_text(synthesiser: Synthesiser, text: str) -> None:
    path = synthesiser.render(marked_up(as_called(text, DECK)))
    assert 0.2 < wav_seconds(path) < 6.0
    assert samples(path).std() > 100


def test_rate_and_voice_are_heard(synthesiser: Synthesiser) -> None:
    text = f"<speak>{LONG}</speak>"
    slow, usual, fast = (
        wav_seconds(synthesiser.render(text, VoicePreference(rate))) for rate in (80, None, 260)
    )
    assert slow > 1.4 * usual > 2.0 * fast
    made = {
        synthesiser.render(text, VoicePreference(None, voice)).read_bytes()
        for voice in ("en-us", "en-gb", "en-us+f3", "de", "en")
    }
    assert len(made) >= 4
    for voice in ("en-uk", "en-us+f33", "f3"):
        with pytest.raises(NoSuchVoice):
            synthesiser.render(text, VoicePreference(None, voice))


def test_doctor_tests_the_voice() -> None:
    named, problem = examine_voice()
    assert re.fullmatch(r"espeak-ng \d[\w.-]*", named)
    assert problem == ""


@needs_aplay
async def test_the_played_sound_equals_the_rendered_one(
    synthesiser: Synthesiser, card: int
) -> None:
    voice = SpeechVoice(synthesiser, open_player("aplay"), deck=DECK)
    line = voice.say("B 5")
    heard = await hear(card, 10_000_000)
    assert await line
    await voice.close()
    (path,) = synthesiser.folder.iterdir()
    made = samples(path).astype("<i2").tobytes()
    assert heard[: len(made)] == made
    assert not heard[len(made) :].strip(b"\0"), "and silence to the end of the device's buffer"


@needs_aplay
async def test_hush_cuts_a_line_within_a_word(synthesiser: Synthesiser, card: int) -> None:
    gate: list[str] = []
    voice = SpeechVoice(
        synthesiser,
        open_player("aplay"),
        on_begin=lambda: gate.append("shut"),
        on_end=lambda: gate.append("open"),
    )
    line = voice.say(" ".join([LONG] * 3))
    begun = await hear(card, 44_100)
    assert gate == ["shut"]
    voice.hush()
    assert not await line
    rest = await hear(card, 10_000_000)  # ends when the players have ended
    await voice.quiet()
    assert gate == ["shut", "open"]
    (path,) = synthesiser.folder.iterdir()
    in_the_pipe = 65_536 + 4_096
    assert len(rest) <= in_the_pipe < path.stat().st_size - len(begun)
    await voice.close()


@needs_aplay
async def test_a_killed_player_opens_the_microphone(synthesiser: Synthesiser, card: int) -> None:
    told: list[str] = []
    ended = asyncio.Event()
    voice = SpeechVoice(synthesiser, open_player("aplay"), on_end=ended.set, tell=told.append)
    line = voice.say(" ".join([LONG] * 3))
    await hear(card, 4_096)
    (path,) = synthesiser.folder.iterdir()
    os.kill(_player_of(path), signal.SIGKILL)
    assert not await line
    await ended.wait()
    assert len(told) == 1
    await voice.close()


def _player_of(path: Path) -> int:
    """Find the process that plays a file."""
    for found in Path("/proc").glob("[0-9]*/cmdline"):
        words = _words(found)
        if words[:1] == [shutil.which("aplay")] and str(path) in words:
            return int(found.parent.name)
    raise AssertionError("nobody plays it")


def _words(command_line: Path) -> list[str]:
    try:
        return command_line.read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return []


@needs_aplay
@pytest.mark.usefixtures("no_card")
async def test_a_missing_sound_card_is_reported_by_aplay(synthesiser: Synthesiser) -> None:
    with pytest.raises(PlayerError, match="No sound comes out of aplay: "):
        await open_player("aplay").play(synthesiser.render("<speak>hello</speak>"))
    player, problem = examine_output(
        lambda name: shutil.which("aplay") if name == "aplay" else None
    )
    assert (player, problem.startswith("aplay finds nothing to play on (")) == ("", True)


@pytest.mark.slow
@needs_aplay
def test_the_program_speaks_and_prints_only_the_text(card: int, tmp_path: Path, tangy: str) -> None:
    ours = subprocess.Popen(  # noqa: S603 - our own program
        [TANGY, "say", "B 5", "--sink", "aplay"],
        env={**os.environ, "XDG_CACHE_HOME": str(tmp_path / "home")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    heard = listen(card, 10_000_000)
    said, failed = ours.communicate(timeout=30)
    assert (ours.returncode, said, failed) == (0, b"B 5\n", b"")
    assert np.frombuffer(heard[: len(heard) // 2 * 2], "<i2").std() > 100


@pytest.mark.slow
@needs_aplay
def test_ctrl_c_cuts_the_speech_and_leaves_the_terminal_clean(
    card: int, tmp_path: Path, open_terminal: OpenTerminal
) -> None:
    terminal = open_terminal(
        "say",
        " ".join([LONG] * 3),
        columns=400,
        environment={
            "XDG_CACHE_HOME": str(tmp_path / "home"),
            "ALSA_CONFIG_PATH": os.environ["ALSA_CONFIG_PATH"],
        },
    )
    assert listen(card, 22_050)
    terminal.type("\x03")
    assert terminal.wait() == 130
    assert len(listen(card, 10_000_000)) <= 65_536 + 4_096
    assert terminal.text.split() == f"{' '.join([LONG] * 3)} ^C".split()
