"""A microphone check chooses settings that separate commands from other speech."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.audio.meter import Meter
from tangy_hw.audio.source import Chunks, Recording, Source
from tangy_hw.audio.wav import RATE, SoundError
from tangy_profiles.activity import Activity
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_profiles.store import Store
from tangy_tui.app.microphones import forget, keep, microphone, settings_for
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.labels import UtteranceLabel
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.language.words import spoken, words_of
from tangy_tui.speech import microphone_check
from tangy_tui.speech.calibration import (
    SHIFTS,
    SURELY,
    WEIGHTS,
    CalibrationPrompt,
    CalibrationResult,
    CalibrationScore,
    SeparationCounts,
    choose,
)
from tangy_tui.speech.evidence import (
    USUAL,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
    Expecting,
)
from tangy_tui.speech.microphone_check import (
    CheckNews,
    CheckResult,
    CheckStep,
    MicrophoneCheck,
    to_say,
)
from tangy_tui.speech.other_voices import SIZE, STREAMS, voice_text
from tangy_tui.text.mic_check import checked_lines, reason_words
from tests.support.append_body import append_body

VOICE = voice_text("usual", np.zeros((STREAMS, SIZE, 1 + SIZE)))
COMMAND, OTHER = (
    CalibrationPrompt("call number", UtteranceLabel("call number")),
    CalibrationPrompt("tea", None),
)


def scores(commands: list[float], others: list[float]) -> list[CalibrationScore]:
    """Commands that are understood correctly with these scores, and other sentences."""
    said = [CalibrationScore(told, COMMAND, True) for told in commands]
    return said + [CalibrationScore(told, OTHER, False) for told in others]


def everywhere(graded: list[CalibrationScore]) -> dict[float, list[CalibrationScore]]:
    return dict.fromkeys(WEIGHTS, graded)


class TestChoosing:
    def test_the_default_settings_stay_if_they_separate_everything(self) -> None:
        chosen = choose(everywhere(scores([3.5, 3.0, 2.5], [-6, -4, -3])))
        assert chosen.settings == USUAL
        assert chosen.figures == chosen.usual == SeparationCounts(3, 3, 0, 3, 0)
        assert chosen.figures.perfect

    def test_a_quiet_voice_lowers_the_threshold(self) -> None:
        shy = [SURELY - short for short in (0.3, 0.4, 0.2, 0.5, 0.3, 0.4)]
        chosen = choose(everywhere(scores(shy, [-6, -6, -6])))
        assert chosen.usual == SeparationCounts(6, 0, 6, 3, 0)
        assert chosen.settings.shift < 0
        assert chosen.figures == SeparationCounts(6, 6, 0, 3, 0)

    def test_confusable_speech_raises_the_threshold(self) -> None:
        chosen = choose(everywhere(scores([4.0] * 6, [0.2, 0.0, -0.4])))
        assert chosen.usual.taken == 3
        assert chosen.settings.shift > 0
        assert chosen.figures.taken < 3
        assert chosen.figures.understood == 6

    def test_the_weight_that_understands_most_is_chosen(self) -> None:
        lost = [*scores([3.5] * 3, [-6] * 3), *[CalibrationScore(-6.0, COMMAND, False)] * 3]
        chosen = choose(everywhere(lost) | {0.1: scores([3.5] * 6, [-6] * 3)})
        assert chosen.settings.garbage == 0.1
        assert (chosen.usual.understood, chosen.figures.understood) == (3, 6)

    def test_inseparable_scores_are_reported_as_not_separated(self) -> None:
        nothing = [CalibrationScore(-6.0, COMMAND, False)] * 6 + scores([], [-6.0] * 3)
        chosen = choose(everywhere(nothing))
        assert not chosen.figures.parted
        assert abs(chosen.settings.shift) <= 0.5
        mixed = choose(everywhere(scores([1.0, 1.0, -6.0], [1.0, 1.0, 1.0])))
        assert not mixed.figures.parted

    @given(
        st.lists(st.tuples(st.floats(-6, 6), st.booleans()), min_size=1, max_size=9),
        st.lists(st.floats(-6, 6), max_size=4),
    )
    def test_settings_stay_within_bounds_and_lose_no_command_without_gain(
        self, said: list[tuple[float, bool]], others: list[float]
    ) -> None:
        graded = [CalibrationScore(told, COMMAND, right) for told, right in said] + scores(
            [], others
        )
        chosen = choose(everywhere(graded))
        assert chosen.settings.garbage in WEIGHTS
        assert SHIFTS[0] <= chosen.settings.shift <= SHIFTS[-1]
        was, now = chosen.usual, chosen.figures
        assert (now.understood + now.offered, -now.taken) >= (0, -len(others))
        if was.understood > now.understood:
            assert now.taken < was.taken or chosen.settings.shift > 0
        if was.perfect and all(told >= SURELY + 0.6 for told, _ in said):
            assert now.perfect


class TestStore:
    CHOSEN = CalibrationResult(
        EvidenceSettings("tiers", 0.9, -0.5),
        SeparationCounts(6, 6, 0, 3, 0),
        SeparationCounts(6, 4, 1, 3, 1),
    )

    def test_settings_are_stored_for_each_microphone(self, store: Store) -> None:
        keep(store, "arecord", self.CHOSEN)
        assert settings_for(store, "arecord") == EvidenceSettings("tiers", 0.9, -0.5)
        assert settings_for(store, "arecord", "paper") == EvidenceSettings("paper", 0.9, -0.5)
        assert settings_for(store, "socket") == settings_for(store, None) == USUAL

    def test_the_last_check_counts_and_can_be_forgotten(self, store: Store) -> None:
        keep(store, "socket", self.CHOSEN)
        keep(
            store,
            "socket",
            CalibrationResult(
                USUAL, SeparationCounts(6, 6, 0, 3, 0), SeparationCounts(6, 6, 0, 3, 0)
            ),
        )
        assert settings_for(store, "socket") == USUAL
        keep(store, "socket", self.CHOSEN)
        assert forget(store, "socket")
        assert settings_for(store, "socket") == USUAL
        assert not forget(store, "socket")

    def test_the_voice_of_each_teacher_is_kept(self, store: Store) -> None:
        voiced = replace(self.CHOSEN, settings=replace(self.CHOSEN.settings, voice=VOICE))
        keep(store, "arecord", voiced, "ann")
        keep(store, "arecord", self.CHOSEN, "bob")
        assert settings_for(store, "arecord", teacher="ann") == voiced.settings
        for teacher in ("bob", "cleo", ""):
            assert settings_for(store, "arecord", teacher=teacher) == self.CHOSEN.settings
        assert settings_for(store, "socket", teacher="ann") == USUAL
        keep(store, "arecord", self.CHOSEN, "ann")
        assert settings_for(store, "arecord", teacher="ann") == self.CHOSEN.settings

    @pytest.mark.parametrize("voice", ["usual", "mine AAAA", VOICE[:-4], 3, None])
    def test_an_invalid_voice_is_ignored(self, store: Store, voice: object) -> None:
        settings = {"garbage": 0.9, "shift": -0.5, "voice": voice}
        body = {"source": "arecord", "settings": settings, "teacher": "ann"}
        append_body(store, "microphone checked", body)
        assert settings_for(store, "arecord", teacher="ann") == self.CHOSEN.settings

    def test_an_unknown_mode_is_refused(self, store: Store) -> None:
        with pytest.raises(TangyError, match="tiers"):
            settings_for(store, None, "teirs")

    def test_no_path_is_stored(self, store: Store) -> None:
        for source in ("/home/rosa/voice.wav", "socket:/home/rosa/mic"):
            keep(store, source, self.CHOSEN)
            assert settings_for(store, source) == self.CHOSEN.settings
        assert "rosa" not in json.dumps([event.body for event in store.events()])
        assert microphone("arecord:plughw:1") == "arecord:plughw:1"

    @pytest.mark.parametrize(
        "written", [None, 3, {}, {"garbage": "x", "shift": 0}, {"garbage": 0.0, "shift": 0.0},
                    {"garbage": 0.4, "shift": 9}, {"garbage": float(10**9), "shift": 0}]
    )  # fmt: skip
    def test_invalid_stored_settings_are_ignored(self, written: object, store: Store) -> None:
        append_body(store, "microphone checked", {"source": "arecord", "settings": written})
        assert settings_for(store, "arecord") == USUAL


class Hears:
    """A recogniser: an utterance of n samples is the n-th text; zeros are no voice."""

    def __init__(self, texts: list[str], voice: str = "") -> None:
        self.texts = texts
        self.known = voice
        self.said = b""
        self.speaking: Callable[[], None] = lambda: None
        self.weights: list[float] = []
        self.voices: list[str] = []
        self.read: list[str] = []

    async def start(self, wanted: DecoderVocabulary) -> None:
        self.weights.append(wanted.settings.garbage)
        self.voices.append(wanted.settings.voice)

    async def hear(
        self,
        sound: asyncio.Queue[bytes],
        expecting: Expecting = "commands",
        *,
        endpoint: bool = False,
    ) -> AcousticEvidence:
        while chunk := await sound.get():
            if any(chunk):
                self.speaking()
                self.said = chunk
                return AcousticEvidence(seconds=1.0)
        return AcousticEvidence()

    async def decode(self, pcm: bytes, expecting: Expecting = "commands") -> AcousticEvidence:
        return AcousticEvidence(self.texts[pcm[0] - 1], "", 0.5, 1.0, 1.0)

    async def voice(self, said: Sequence[tuple[bytes, str]]) -> str:
        self.read = [text for _, text in said]
        return self.known

    async def pieces(self, pcm: bytes) -> list[bytes]:
        return [pcm[place : place + 2] for place in range(0, len(pcm), 2)]


class Microphone(Source):
    """A microphone that is quiet for 3 s, and then gives the next phrase on request."""

    def __init__(self, said: list[int | None]) -> None:
        super().__init__("microphone", live=True)
        self.said = said
        self.asked = asyncio.Event()

    def told(self, news: CheckNews) -> None:
        if isinstance(news, CheckStep) and news.kind in ("say", "say again"):
            self.asked.set()

    async def _sound(self) -> Chunks:
        yield bytes(2 * 3 * RATE)
        for number in self.said:
            await self.asked.wait()
            self.asked.clear()
            await asyncio.sleep(0)
            yield bytes(2 * 7 * RATE) if number is None else bytes([number, 0]) * 4000
        await asyncio.Event().wait()


class Silent(Source):
    """A microphone that sends nothing at all."""

    def __init__(self) -> None:
        super().__init__("silent", live=True)

    async def _sound(self) -> Chunks:
        await asyncio.Event().wait()
        yield b""


class Muted(Microphone):
    """A microphone that sends silence until the check reports it."""

    def __init__(self, said: list[int | None], *, mended: bool) -> None:
        super().__init__(said)
        self.mended = mended
        self.now = 0.0
        self.switched = asyncio.Event()

    def told(self, news: CheckNews) -> None:
        super().told(news)
        if news == CheckStep("goes on by itself"):
            self.switched.set()

    async def _sound(self) -> Chunks:
        self.now = 3.0
        yield bytes(2 * 3 * RATE)
        await self.switched.wait()
        if not self.mended:
            self.now = 60.0
            await asyncio.Event().wait()
        for _ in range(12):
            yield b"\7\0\0\0" * (RATE // 8)
        async for chunk in super()._sound():
            yield chunk


class Broken(Microphone):
    """A microphone that is pulled out after some phrases."""

    async def _sound(self) -> Chunks:
        yield bytes(2 * 3 * RATE)
        for number in self.said:
            await self.asked.wait()
            self.asked.clear()
            yield bytes([number or 0, 0]) * 4000
        await self.asked.wait()
        raise SoundError("It was unplugged.")


@pytest.fixture
def asked(activity: Activity, people: tuple[Person, ...]) -> list[CalibrationPrompt]:
    book = Phrasebook(activity, people)
    return to_say(book, Lexicon(book))


class TestChecking:
    def test_the_phrases_of_the_check_span_the_behaviours(
        self, activity: Activity, lanterns: Activity, people: tuple[Person, ...]
    ) -> None:
        for one in (activity, lanterns):
            book = Phrasebook(one, people)
            said = to_say(book, Lexicon(book))
            commands = [a for a in said if a.meant]
            others = [a for a in said if not a.meant]
            assert len({a.meant.behaviour for a in commands if a.meant}) == min(
                6, len(one.behaviours)
            )
            assert len(others) == 3
            for a in commands:
                command = book.understand(a.text)
                assert command is not None and a.meant is not None
                assert command.behaviour == a.meant.behaviour
            assert not any(book.understand(a.text) for a in others)

    async def test_a_recording_is_checked_in_order(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        pcm = b"".join(bytes([number, 0]) for number in range(1, len(asked) + 1))
        checked = await self.check(Recording("a.wav", pcm), activity, people, asked)
        assert checked.parted
        assert checked.chosen.figures.perfect
        assert [words for _, words in checked.heard] == [a.text for a in asked]

    async def test_the_commands_are_decoded_with_the_voice_that_was_learnt(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        pcm = b"".join(bytes([number, 0]) for number in range(1, len(asked) + 1))
        hears = Hears([one.text for one in asked], VOICE)
        checked = await self.check(Recording("a.wav", pcm), activity, people, asked, hears=hears)
        assert checked.chosen.settings == EvidenceSettings(voice=VOICE)
        assert hears.read == [spoken(words_of(one.text)) for one in asked]
        assert hears.voices == ["", VOICE]
        assert any("learnt yours" in line for line in checked_lines(checked, "arecord"))

    async def test_a_missed_phrase_is_asked_for_once_more(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        microphone = Microphone([1, None, 2, *range(3, len(asked) + 1)])
        told: list[CheckNews] = []
        checked = await self.check(microphone, activity, people, asked, told)
        assert checked.chosen.figures.perfect
        again = [news for news in told if isinstance(news, CheckStep) and news.kind == "say again"]
        assert again == [CheckStep("say again", asked[1].text, 2)]
        assert told[0] == CheckStep("be quiet", number=3)

    async def test_a_missing_phrase_counts_as_not_understood(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        checked = await self.check(Recording("a.wav", b"\1\0\2\0"), activity, people, asked)
        assert checked.chosen.figures == SeparationCounts(6, 2, 0, 0, 0)
        assert not checked.parted
        assert checked.advice

    async def test_silence_changes_nothing(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        with pytest.raises(SoundError, match="nobody was heard"):
            await self.check(Recording("a.wav", b""), activity, people, asked)

    async def test_a_microphone_without_data_ends_the_check(
        self,
        activity: Activity,
        people: tuple[Person, ...],
        asked: list[CalibrationPrompt],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        monkeypatch.setattr(microphone_check, "LOOK_SECONDS", 0.0)
        with pytest.raises(SoundError, match=r"nothing was heard for 0 s.* plugged in"):
            await self.check(Silent(), activity, people, asked, patience=0.0)

    async def test_the_check_waits_for_a_muted_microphone(
        self,
        activity: Activity,
        people: tuple[Person, ...],
        asked: list[CalibrationPrompt],
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        said: list[int | None] = [*range(1, len(asked) + 1)]
        monkeypatch.setattr(microphone_check, "LOOK_SECONDS", 0.0)
        muted, told = Muted(said, mended=True), list[CheckNews]()
        monkeypatch.setattr(microphone_check, "Meter", lambda: Meter(lambda: muted.now))
        checked = await self.check(muted, activity, people, asked, told)
        assert checked.parted
        assert -85 < checked.room < -75
        assert told.count(CheckStep("be quiet", number=3)) == 2
        assert told.count(CheckStep("goes on by itself")) == 1
        muted = Muted(said, mended=False)
        with pytest.raises(SoundError, match="nothing was heard for 50 s, so nothing was changed"):
            await self.check(muted, activity, people, asked, patience=50.0)

    async def test_the_check_of_a_recording_lists_its_phrases(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        told: list[CheckNews] = []
        checked = await self.check(Recording("a.wav", b"\1\0"), activity, people, asked, told)
        assert told[0] == CheckStep("recording holds", "a.wav")
        assert told[1 : len(asked) + 1] == [
            CheckStep("say", one.text, number) for number, one in enumerate(asked, 1)
        ]
        assert reason_words(checked) == "Nothing was stored: only 1 of 6 commands was understood."

    @pytest.mark.parametrize(
        ("figures", "why"),
        [
            (SeparationCounts(6, 5, 0, 3, 1), ""),
            (SeparationCounts(6, 0, 0, 3, 0), "none of 6 commands were understood"),
            (SeparationCounts(6, 2, 2, 3, 0), "only 4 of 6 commands were understood"),
            (SeparationCounts(6, 6, 0, 0, 0), "Tangy heard none of the other sentences"),
            (SeparationCounts(6, 6, 0, 3, 2), "2 of 3 other sentences were taken for a command"),
            (SeparationCounts(6, 6, 0, 1, 1), "1 of 1 other sentences was taken for a command"),
        ],
    )
    def test_an_unstored_result_gives_its_reason(self, figures: SeparationCounts, why: str) -> None:
        chosen = CalibrationResult(USUAL, figures, figures)
        checked = CheckResult(-60, -30, (), chosen, figures.parted and figures.others > 0, ())
        assert checked.parted is (not why)
        assert reason_words(checked) == (f"Nothing was stored: {why}." if why else "")

    async def test_a_failing_microphone_gives_its_reason(
        self, activity: Activity, people: tuple[Person, ...], asked: list[CalibrationPrompt]
    ) -> None:
        with pytest.raises(SoundError, match="unplugged"):
            await self.check(Broken([1, 2]), activity, people, asked)

    @staticmethod
    async def check(
        source: Source,
        activity: Activity,
        people: tuple[Person, ...],
        asked: list[CalibrationPrompt],
        told: list[CheckNews] | None = None,
        patience: float = microphone_check.PATIENCE,
        hears: Hears | None = None,
    ) -> CheckResult:
        def tell(news: CheckNews) -> None:
            if told is not None:
                told.append(news)
            if isinstance(source, Microphone):
                source.told(news)

        book = Phrasebook(activity, people)
        hears = hears or Hears([a.text for a in asked])
        async with asyncio.timeout(20):
            return await MicrophoneCheck(source, book, hears, asked, tell, patience=patience).run()


def test_reading_settings_creates_no_data_folder(tmp_path: Path) -> None:
    with Store.open(tmp_path / "none", write=False) as empty:
        assert settings_for(empty, "arecord") == USUAL
    assert not (tmp_path / "none").exists()
