"""A voice speaks lines in turn, stops at once, mutes the microphone, and never ends a game."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import pytest

from tangy_hw.audio.player import NullPlayer, PlayerError, ProgramPlayer, SoundPlayer
from tangy_hw.audio.synthesis import ABSENT, Synthesiser
from tangy_hw.audio.voice import SpeechVoice
from tangy_profiles.activity import load_activity
from tangy_profiles.voice import VoicePreference
from tests.hw.speakers import Clock, Speaker, program

SECONDS = 2.0  # of every line


class Broken:
    """A player without a sound card."""

    name = "aplay"
    tried = 0

    async def play(self, wav: Path) -> None:
        self.tried += 1
        raise PlayerError("No sound comes out of aplay: no card.")

    def stop(self) -> None:
        pass


class Scene:
    """A voice, its clock, and the events."""

    def __init__(self, folder: Path) -> None:
        self.clock = Clock()
        self.speaker = Speaker(folder / "speaker", seconds=SECONDS)
        self.synthesiser = Synthesiser(folder / "cache", which=self.speaker.which)
        self.gate: list[str] = []
        self.told: list[str] = []
        self.voices: list[SpeechVoice] = []

    def voice(
        self,
        player: SoundPlayer | None = None,
        *,
        synthesiser: Synthesiser | None = None,
        on_begin: Callable[[], None] | None = None,
        on_end: Callable[[], None] | None = None,
    ) -> SpeechVoice:
        """Make a voice."""
        voice = SpeechVoice(
            synthesiser or self.synthesiser,
            player or NullPlayer(self.clock.sleep),
            deck=load_activity("bingo").deck,
            on_begin=on_begin or (lambda: self.gate.append("shut")),
            on_end=on_end or (lambda: self.gate.append("open")),
            tell=self.told.append,
        )
        self.voices.append(voice)
        return voice

    async def hear(self) -> None:
        """Let the current line end."""
        await self.clock.somebody_sleeps()
        self.clock.pass_by(SECONDS)


@pytest.fixture
async def scene(tmp_path: Path) -> AsyncIterator[Scene]:
    made = Scene(tmp_path)
    yield made
    for voice in made.voices:
        await voice.close()
        assert made.gate.count("shut") == made.gate.count("open")


async def test_lines_are_spoken_in_turn(scene: Scene) -> None:
    voice = scene.voice()
    lines = [voice.say(text) for text in ("one", "two", "three")]
    assert voice.speaking
    for number, line in enumerate(lines):
        await scene.hear()
        assert await line
        assert not any(later.done() for later in lines[number + 1 :])
    await voice.quiet()
    assert [text.split(">")[1].split("<")[0] for text in scene.speaker.heard] == [
        "one",
        "two",
        "three",
    ]
    assert scene.clock.now == 3 * SECONDS
    assert scene.gate == ["shut", "open"], "it is not opened between two lines"
    assert not scene.told


async def test_the_microphone_is_muted_only_during_a_line(scene: Scene) -> None:
    voice = scene.voice()
    for _ in range(2):
        line = voice.say("hello")
        await scene.clock.somebody_sleeps()
        assert scene.gate[-1] == "shut"
        await scene.hear()
        assert await line
        await voice.quiet()
    assert scene.gate == ["shut", "open"] * 2


async def test_hush_cuts_every_line_and_opens_the_microphone(scene: Scene) -> None:
    voice = scene.voice()
    lines = [voice.say(text) for text in ("one", "two")]
    await scene.clock.somebody_sleeps()
    voice.hush()
    assert [await line for line in lines] == [False, False]
    await voice.quiet()
    assert scene.gate == ["shut", "open"]
    assert scene.clock.now == 0.0
    after = voice.say("three")
    await scene.hear()
    assert await after, "what is said later is spoken again"


async def test_hush_before_the_start_of_a_line_leaves_silence(scene: Scene) -> None:
    voice = scene.voice()
    line = voice.say("one")
    voice.hush()
    assert not await line
    line = voice.say("two")
    await asyncio.sleep(0)
    voice.hush()
    assert not await line
    await voice.quiet()
    assert scene.gate == []
    voice.hush()


async def test_an_interruption_replaces_the_line_with_the_microphone_muted(
    scene: Scene,
) -> None:
    voice = scene.voice()
    lines = [voice.say(text) for text in ("one", "two")]
    await scene.clock.somebody_sleeps()
    urgent = voice.say("stop", interrupt=True)
    assert [await line for line in lines] == [False, False]
    await scene.hear()
    assert await urgent
    await voice.quiet()
    assert scene.gate == ["shut", "open"]


async def test_a_call_is_spoken_in_the_preferred_voice(scene: Scene) -> None:
    voice = scene.voice()
    line = voice.say("It is O-69.", VoicePreference(100, "en-gb+f3"))
    await scene.hear()
    assert await line
    assert "O, 69." in scene.speaker.heard[0]
    assert "O, 6 9." in scene.speaker.heard[0]
    assert scene.speaker.asked[0].endswith("-v en-gb+f3 -s 100")


async def test_an_unknown_voice_falls_back_to_the_default(scene: Scene) -> None:
    voice = scene.voice()
    for _ in range(2):
        line = voice.say("hello", VoicePreference(100, "xx"))
        await scene.hear()
        assert await line
    assert scene.speaker.asked[0].endswith("-v en-us -s 100")
    assert len(scene.told) == 1
    assert "no voice 'xx'" in scene.told[0]


async def test_an_empty_line_takes_no_time(scene: Scene) -> None:
    voice = scene.voice()
    assert await voice.say("  ")
    await voice.quiet()
    assert scene.gate == []


async def test_a_missing_sound_card_is_reported_once(scene: Scene) -> None:
    player = Broken()
    voice = scene.voice(player)
    lines = [voice.say(text) for text in ("one", "two")]
    assert [await line for line in lines] == [False, False]
    assert not await voice.say("three")
    await voice.quiet()
    assert player.tried == 1
    assert scene.told == ["No sound comes out of aplay: no card. What Tangy says is shown as text."]
    assert scene.gate == ["shut", "open"]
    assert voice.silent


async def test_a_missing_synthesiser_is_reported_once(scene: Scene, tmp_path: Path) -> None:
    absent = Synthesiser(tmp_path / "none", which=lambda _: None)
    voice = scene.voice(synthesiser=absent)
    assert not await voice.say("one")
    assert not await voice.say("two")
    assert (await voice.prerender(["three"])).texts == 0
    assert scene.told == [ABSENT]
    assert scene.gate == []


async def test_a_failed_line_does_not_block_the_next(
    scene: Scene,
) -> None:
    voice = scene.voice()
    assert not await voice.say("a" * 6_000)
    line = voice.say("two")
    await scene.hear()
    assert await line
    assert len(scene.told) == 1


async def test_the_microphone_is_opened_when_the_player_dies(scene: Scene, tmp_path: Path) -> None:
    path = program(tmp_path / "bin" / "aplay", "kill -9 $$")
    voice = scene.voice(ProgramPlayer([(str(path),)]))
    assert not await voice.say("one")
    await voice.quiet()
    assert scene.gate == ["shut", "open"]
    assert "status 137" in scene.told[0]


async def test_a_failing_microphone_gate_does_not_end_the_game(scene: Scene) -> None:
    def jam() -> None:
        raise ValueError("jammed")

    voice = scene.voice(on_begin=jam)
    assert not await voice.say("one")
    voice = scene.voice(on_end=jam)
    for text in ("one", "two"):
        line = voice.say(text)
        await scene.hear()
        assert await line
        await voice.quiet()
    assert scene.told == ["The voice failed (ValueError: jammed)."] * 2, "once for each voice"
    scene.gate.clear()


async def test_an_emptied_cache_is_not_reported_as_a_player_fault(scene: Scene) -> None:
    class Emptied(NullPlayer):
        first = True

        async def play(self, wav: Path) -> None:
            if self.first:
                self.first = False
                scene.synthesiser.clear()
                raise PlayerError("No such file.")
            await super().play(wav)

    voice = scene.voice(Emptied(scene.clock.sleep))
    line = voice.say("one")
    await scene.hear()
    assert await line
    assert not scene.told


async def test_prerendered_lines_are_not_rendered_again(scene: Scene) -> None:
    voice = scene.voice()
    made = await voice.prerender(("B-1.", "B-2.", "B-3."))
    assert made.texts == 3
    assert made.bytes == sum(path.stat().st_size for path in scene.synthesiser.folder.iterdir())
    line = voice.say("B-2.")
    await scene.hear()
    assert await line
    assert len(scene.speaker.asked) == 3


async def test_a_line_does_not_wait_for_prerendering(scene: Scene) -> None:
    voice = scene.voice()
    making = voice.prerender([f"text {number}" for number in range(200)])
    line = voice.say("now")
    await scene.hear()
    assert await line
    assert not making.done()


async def test_closing_ends_lines_and_prerendering(scene: Scene) -> None:
    voice = scene.voice()
    line, later = voice.say("one"), voice.say("two")
    making = voice.prerender([f"text {number}" for number in range(200)])
    await scene.clock.somebody_sleeps()
    await voice.close()
    assert (line.result(), later.result()) == (False, False)
    assert making.cancelled()
    assert scene.gate == ["shut", "open"]
    assert not await voice.say("three")
    await voice.close()
    assert len(asyncio.all_tasks()) == 1, "only this test is left"
