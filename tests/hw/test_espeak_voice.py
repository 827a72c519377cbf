"""The robot's voice speaks each line, or reports that nobody could hear it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from tangy_hw.audio.player import NullPlayer, PlayerError, ProgramPlayer, SoundPlayer
from tangy_hw.device_protocols import DeviceError
from tangy_hw.drivers.espeak_voice import SpokenVoice
from tangy_profiles.activity import load_activity
from tangy_profiles.voice import VoicePreference
from tests.hw.speakers import Clock, Speaker, program
from tests.hw.waiting import PATIENCE, until
from tests.support.media import make_sound

SECONDS = 2.0  # of every line


class Scene:
    """Voices with a clock and a script in place of the synthesiser."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.clock = Clock()
        self.speaker = Speaker(folder / "speaker", seconds=SECONDS)
        self.gate: list[str] = []
        self.made: list[SpokenVoice] = []

    async def voice(self, player: SoundPlayer | None = None) -> SpokenVoice:
        """Make a voice, and start it."""
        voice = SpokenVoice(
            player=player or NullPlayer(self.clock.sleep),
            preference=VoicePreference(120, "en-gb"),
            deck=load_activity("bingo").deck,
            folder=self.folder / "cache",
            which=self.speaker.which,
            on_begin=lambda: self.gate.append("shut"),
            on_end=lambda: self.gate.append("open"),
        )
        self.made.append(voice)
        await voice.start()
        return voice


@pytest.fixture
async def scene(tmp_path: Path) -> AsyncIterator[Scene]:
    made = Scene(tmp_path)
    yield made
    for voice in made.made:
        await voice.close()


async def test_say_returns_after_the_sound_has_played(scene: Scene) -> None:
    voice = await scene.voice()
    saying = asyncio.create_task(voice.say("The next number is B-12."))
    async with asyncio.timeout(PATIENCE):
        await scene.clock.somebody_sleeps()
    assert not saying.done() and scene.gate == ["shut"]
    scene.clock.pass_by(SECONDS)
    async with asyncio.timeout(PATIENCE):
        await saying
    assert voice.reading().state == "OK" and voice.why == ""
    assert "-s 120" in scene.speaker.asked[-1] and "-v en-gb" in scene.speaker.asked[-1]
    assert "1 2" in scene.speaker.heard[-1]  # as a caller says it
    await until(lambda: scene.gate == ["shut", "open"])


async def test_a_sound_is_played_to_its_end_with_the_microphone_shut(
    scene: Scene, tmp_path: Path
) -> None:
    voice = await scene.voice()
    playing = asyncio.create_task(voice.play(make_sound(tmp_path / "bell.wav", 3.0)))
    async with asyncio.timeout(PATIENCE):
        await scene.clock.somebody_sleeps()
    scene.clock.pass_by(2.9)
    await asyncio.sleep(0)
    assert not playing.done() and scene.gate == ["shut"]
    scene.clock.pass_by(0.2)
    async with asyncio.timeout(PATIENCE):
        await playing
    await until(lambda: scene.gate == ["shut", "open"])
    assert not scene.speaker.heard


async def test_a_missing_sound_file_is_a_warning_until_the_next_line(
    scene: Scene, tmp_path: Path
) -> None:
    voice = await scene.voice(Broken())
    with pytest.raises(DeviceError, match=r"bell\.wav is not there any more"):
        await voice.play(tmp_path / "bell.wav")
    assert voice.reading().state == "WARN"


@pytest.mark.parametrize("by", ["hush", "cancel", "close"])
async def test_speech_is_cut_at_once(scene: Scene, by: str) -> None:
    voice = await scene.voice()
    saying = asyncio.create_task(voice.say("This goes on and on."))
    async with asyncio.timeout(PATIENCE):
        await scene.clock.somebody_sleeps()
        if by == "hush":
            await voice.hush()
            await saying  # it is no error: the silence was intended
            assert voice.reading().state == "OK"
        elif by == "close":
            await voice.close()
            await saying
            assert voice.reading().state == "ERROR"
        else:
            saying.cancel()
            with pytest.raises(asyncio.CancelledError):
                await saying
    await until(lambda: scene.gate == ["shut", "open"])


class Broken:
    """A player whose sound card is gone."""

    name = "aplay"

    def __init__(self) -> None:
        self.works = False

    async def play(self, wav: Path) -> None:
        if not self.works:
            raise PlayerError("No sound comes out of aplay: no card.")

    def stop(self) -> None:
        pass


async def test_a_silent_player_is_an_error_until_a_restart(scene: Scene) -> None:
    player = Broken()
    voice = await scene.voice(player)
    assert voice.reading().state == "OK"
    for _ in range(2):
        with pytest.raises(DeviceError, match="No sound comes out of aplay: no card"):
            await voice.say("Hello.")
        assert voice.reading().state == "ERROR"
    player.works = True
    await voice.close()
    await voice.start()
    await voice.say("Hello.")
    assert (voice.reading().state, voice.why) == ("OK", "")


async def test_a_failed_synthesis_is_a_warning_until_the_next_line(scene: Scene) -> None:
    player = Broken()
    player.works = True
    voice = await scene.voice(player)
    with pytest.raises(DeviceError, match=r"^voice: "):
        await voice.say("word " * 2000)
    assert voice.reading().state == "WARN"
    await voice.say("Hello.")
    assert (voice.reading().state, voice.why) == ("OK", "")


async def test_a_missing_synthesiser_is_named(tmp_path: Path) -> None:
    voice = SpokenVoice(player=NullPlayer(), folder=tmp_path, which=lambda name: None)
    assert voice.reading().state == "ERROR"
    await voice.start()
    assert "espeak-ng is not installed" in voice.why
    with pytest.raises(DeviceError, match="espeak-ng is not installed"):
        await voice.say("Hello.")
    await voice.hush()
    await voice.close()


async def test_a_broken_player_is_noticed_before_the_first_line(
    scene: Scene, tmp_path: Path
) -> None:
    player = program(tmp_path / "bin" / "aplay", "echo 'no card' >&2; exit 1")
    known = {"espeak-ng": scene.speaker.which("espeak-ng"), "aplay": str(player)}
    voice = SpokenVoice(folder=tmp_path / "cache", which=known.get)
    await voice.start()
    assert (voice.reading().state, voice.why) == ("WARN", "voice is being tried.")
    await until(lambda: voice.reading().state == "ERROR")
    assert "no card" in voice.why
    await voice.close()
    program(player, "exit 0")
    await voice.start()
    await until(lambda: voice.reading().state == "OK")
    await voice.close()


async def test_say_waits_for_a_real_player(scene: Scene, tmp_path: Path) -> None:
    player = program(tmp_path / "bin" / "aplay", f"echo played >> {tmp_path}/played")
    voice = await scene.voice(ProgramPlayer([[str(player)]]))
    async with asyncio.timeout(PATIENCE):
        await voice.say("Hello.")
    assert (tmp_path / "played").read_text() == "played\n"
