"""Ears: they decode exactly the speech that arrives while they listen."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from pathlib import Path
from threading import get_ident
from typing import cast

import pytest

from tangy_hw.audio.wav import RATE, SoundError
from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.person import load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.intent_model import IntentModel
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech import input as room
from tangy_tui.speech.hearing_notes import HearingNote
from tangy_tui.speech.input import Heard, SpeechInput
from tangy_tui.speech.recogniser import SpeechUnavailable
from tangy_tui.speech.recordings import Recorder
from tangy_tui.speech.utterance import LONGEST_TALK, MOST_WAITING, QUIET, STALLED, Utterance
from tests.learning.speech_fakes import PATIENCE, FakeRecogniser, FakeSource, soon, sound

BOOK = Phrasebook(load_activity("bingo"), load_people(4))


class Room:
    """Ears, a speaker, and a consumer of the utterances."""

    def __init__(self, source: FakeSource, **options: object) -> None:
        self.source = source
        self.ears = SpeechInput("socket", BOOK, **options)  # type: ignore[arg-type]
        self.told: list[HearingNote] = []
        self.states: list[str] = []
        self.heard: list[Heard] = []
        self.ears.tell = self.told.append
        self.ears.changed = lambda: self.states.append(self.state)
        self.taking = asyncio.create_task(self._take())

    async def _take(self) -> None:
        async for heard in self.ears:
            self.heard.append(heard)

    @property
    def decoder(self) -> FakeRecogniser:
        return FakeRecogniser.made[-1]

    @property
    def state(self) -> str:
        return self.ears.state

    @property
    def listened_for(self) -> tuple[str, ...]:
        return self.decoder.wanted.phrases if self.decoder.wanted else ()

    @property
    def words(self) -> list[str]:
        return [heard.text for heard in self.heard if isinstance(heard, Say | StopCommand)]

    async def ready(self, state: str = "off") -> Room:
        await soon(lambda: self.state == state)
        return self

    async def say(self, *chunks: bytes) -> None:
        """Push to talk, say something, and push again."""
        await self.ready()
        self.ears.talk()
        await self.source.feed(*chunks)
        self.ears.talk()
        await self.ready()

    async def over(self) -> None:
        async with asyncio.timeout(PATIENCE):
            await self.taking


Enter = Callable[..., Room]


@pytest.fixture
async def enter(monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Enter]:
    """Open ears for a given source and decoder; checks that nothing of them remains."""
    opened: list[Room] = []
    FakeRecogniser.made = []
    monkeypatch.setattr(room, "Recogniser", FakeRecogniser)

    def one(*, live: bool = True, **options: object) -> Room:
        source = FakeSource(live=live)
        monkeypatch.setattr(room, "open_source", lambda *_, **__: source)
        opened.append(Room(source, **options))
        return opened[-1]

    yield one
    for each in opened:
        await asyncio.wait_for(each.ears.close(), PATIENCE)
        await asyncio.wait({each.taking}, timeout=PATIENCE)
        assert each.source.closed
        assert each.state in ("over", "starting")
    assert all(decoder.closed for decoder in FakeRecogniser.made)
    assert asyncio.all_tasks() == {asyncio.current_task()}


class TestIntentModel:
    async def test_it_is_loaded_beside_the_screen_when_the_ears_open(self, enter: Enter) -> None:
        loaded: list[int] = []

        def load(activity: Activity) -> IntentModel:
            loaded.append(get_ident())
            return cast(IntentModel, None)

        here = enter()
        here.ears.understand_by(Phrasebook(load_activity("bingo"), load_people(4), load))
        await here.ready()
        assert len(loaded) == 1 and loaded[0] != get_ident()


class TestPushToTalk:
    async def test_speech_between_two_pushes_is_decoded(self, enter: Enter) -> None:
        here = await enter().ready()
        await here.source.feed(sound("x"))
        here.ears.talk()
        assert here.state == "listening"
        await here.source.feed(sound("c"), sound("c", 0.25))
        assert here.ears.words == f"{len(sound('c', 0.75))} bytes"
        here.ears.talk()
        assert here.state == "thinking"
        await here.source.feed(sound("x"))
        await here.ready()
        await here.source.feed(sound("x"))
        assert here.decoder.heard == [(sound("c", 0.75), "commands")]
        assert here.words == ["call number"]
        assert here.ears.sound == sound("c", 0.75)
        assert here.ears.words == ""

    async def test_sound_in_the_same_turn_of_the_loop_is_kept(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.talk()
        here.source.coming.put_nowait(sound("c"))
        await here.source.feed(sound("c"))
        here.ears.talk()
        await here.ready()
        assert here.decoder.heard == [(sound("c", 1), "commands")]

    async def test_push_to_talk_ends_if_no_more_sound_comes(
        self, enter: Enter, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(room, "MOST_TALK", 0.01)
        here = await enter().ready()
        here.ears.talk()
        await here.source.feed(sound("c"))
        await soon(lambda: bool(here.decoder.heard))
        await here.ready()
        await here.source.feed(sound("x"))
        assert here.words == ["call number"]
        assert here.decoder.heard == [(sound("c"), "commands")]

    async def test_a_push_while_decoding_is_answered(self, enter: Enter) -> None:
        here = await enter().ready()
        here.decoder.decoding.clear()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.ears.talk()
        here.ears.talk()
        assert here.told == [HearingNote("still thinking")]
        here.decoder.decoding.set()
        await here.ready()
        assert here.words == ["call number"]

    async def test_two_pushes_in_one_turn_are_an_utterance_without_sound(
        self, enter: Enter
    ) -> None:
        here = await enter().ready()
        here.ears.talk()
        here.ears.talk()
        await soon(lambda: bool(here.decoder.heard))
        await here.ready()
        assert here.decoder.heard == [(b"", "commands")]
        assert (here.heard, here.told) == ([], [])
        await here.say(sound("c"))
        assert here.words == ["call number"]

    @pytest.mark.parametrize("size", [0.02, 0.5, 1.7, 30])
    async def test_push_to_talk_ends_after_six_seconds_of_sound(
        self, enter: Enter, size: float
    ) -> None:
        here = await enter().ready()
        here.ears.talk()
        for _ in range(round(8 / size) or 1):
            await here.source.feed(sound("c", size))
        await here.ready()
        assert [len(pcm) / 2 / RATE for pcm, _ in here.decoder.heard] == [LONGEST_TALK]
        assert here.words == ["call number"]

    async def test_pushing_while_it_thinks_or_starts_does_nothing(self, enter: Enter) -> None:
        here = enter()
        here.ears.talk()
        assert here.state == "starting"
        await here.ready()
        here.decoder.decoding.clear()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.ears.talk()
        for _ in range(3):
            here.ears.talk()
            assert here.state == "thinking"
        here.decoder.decoding.set()
        await here.ready()
        assert here.words == ["call number"]

    async def test_sound_without_words_is_reported(self, enter: Enter) -> None:
        here = await enter().ready()
        await here.say(sound("?"))
        assert here.told == [HearingNote("no words")]
        assert here.heard == []

    async def test_a_failed_utterance_is_reported_and_the_next_is_decoded(
        self, enter: Enter
    ) -> None:
        here = await enter().ready()
        here.decoder.failures += [SpeechUnavailable("It died.")] * 4
        for _ in range(4):
            await here.say(sound("c"))
        assert here.told == [HearingNote("not decoded", "It died.")] * 4
        await here.say(sound("c"))
        assert here.words == ["call number"]

    async def test_late_partial_words_do_not_change_the_state(self, enter: Enter) -> None:
        here = await enter().ready()
        here.decoder.speaking()
        assert here.state == "off"


class TestShutting:
    async def test_speech_of_the_robot_and_its_echo_are_not_decoded(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.shut()
        assert here.state == "shut"
        here.ears.talk()
        await here.source.feed(sound("x"))
        here.ears.open()
        assert here.state == "off"
        await here.say(sound("x", 0.1), sound("x", 0.2) + sound("c", 0.4))
        assert here.decoder.heard == [(sound("c", 0.4), "commands")]

    async def test_muting_drops_the_current_utterance(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.ears.shut()
        here.ears.open()
        await here.ready()
        assert here.heard == []
        await here.say(sound("x", 0.3), sound("j"))
        assert here.words == ["tell a joke"]

    async def test_muting_drops_the_utterance_being_decoded(self, enter: Enter) -> None:
        here = await enter().ready()
        here.decoder.decoding.clear()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.ears.talk()
        here.ears.shut()
        here.decoder.decoding.set()
        await soon(lambda: bool(here.decoder.heard))
        here.ears.open()
        await here.ready()
        assert here.heard == []

    async def test_a_push_muted_in_the_same_turn_stops_listening(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.talk()
        here.ears.shut()
        here.ears.open()
        await here.ready()
        await here.source.feed(sound("c"))
        assert here.decoder.heard == [(b"", "commands")]
        assert here.heard == []

    async def test_muting_does_not_affect_a_recording(self, enter: Enter) -> None:
        here = enter(live=False)
        here.ears.shut()
        assert here.state == "starting"
        await here.source.feed(sound("c"))
        here.source.end()
        await here.over()
        assert here.words == ["call number"]


class TestOtherPhrases:
    @pytest.mark.parametrize("hands_free", [False, True])
    async def test_new_phrases_apply_from_the_next_utterance(
        self, enter: Enter, hands_free: bool
    ) -> None:
        here = await enter(hands_free=hands_free).ready("listening" if hands_free else "off")
        people = (*load_people(3), replace(load_people(4)[3], name="Zoe"))
        other = Phrasebook(load_activity("bingo"), people)
        assert "go to zoe" not in here.listened_for
        here.ears.understand_by(other)
        if hands_free:
            await here.source.feed(sound("c"), sound(" "))
        else:
            await here.say(sound("c"))
        await soon(lambda: "go to zoe" in here.listened_for)
        assert here.words == ["call number"]

    async def test_other_wordings_of_the_same_phrases_apply_too(self, enter: Enter) -> None:
        here = await enter().ready()
        before, activity = here.decoder.wanted, load_activity("bingo")
        worded = replace(activity.behaviours["joke"], wordings=("tickle them a little",))
        behaviours = {**activity.behaviours, "joke": worded}
        here.ears.understand_by(
            Phrasebook(replace(activity, behaviours=behaviours), load_people(4))
        )
        await here.say(sound("c"))
        await soon(lambda: here.decoder.wanted is not before)
        assert before is not None and here.decoder.wanted is not None
        assert here.decoder.wanted.phrases == before.phrases
        assert "tickle them a little" in here.decoder.wanted.no_stops

    async def test_a_phrasebook_that_also_learns_renews_the_decoder(self, enter: Enter) -> None:
        here = await enter().ready()
        learns = Phrasebook(
            load_activity("bingo"), load_people(4), lambda _: cast(IntentModel, None)
        )
        here.ears.understand_by(learns)
        await here.say(sound("c"))
        await soon(lambda: here.decoder.wanted is not None and here.decoder.wanted.sentences != ())

    async def test_speech_during_a_change_of_phrases_is_kept(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        people = (*load_people(3), replace(load_people(4)[3], name="Zoe"))
        here.ears.asking(True)  # ends listening, as a dialog does
        here.ears.understand_by(Phrasebook(load_activity("bingo"), people))
        here.ears.asking(False)
        await here.ready("starting")
        for _ in range(3):
            await here.source.feed(sound("c"), sound(" "))
        await soon(lambda: len(here.words) == 3)

    async def test_unchanged_phrases_do_not_restart_the_decoder(self, enter: Enter) -> None:
        here = await enter().ready()
        before = here.decoder.wanted
        here.ears.understand_by(Phrasebook(load_activity("bingo"), load_people(4)))
        await here.say(sound("c"))
        assert here.decoder.wanted is before


class TestRecording:
    async def test_the_teacher_is_notified_of_recording(self, enter: Enter, tmp_path: Path) -> None:
        here = await enter(recorder=Recorder(tmp_path, "rosa")).ready()
        assert here.ears.records
        assert here.told == [HearingNote("records")]

    async def test_only_the_beginning_of_an_endless_utterance_is_decoded(
        self, enter: Enter
    ) -> None:
        here = enter(live=False)
        await here.source.feed(sound("c", 20))
        here.source.end()
        await here.over()
        assert here.told[0] == HearingNote("cut off", seconds=20)


class TestAsking:
    async def test_spoken_answers_count_if_switched_on(self, enter: Enter) -> None:
        here = await enter(answers=True).ready()
        here.ears.asking(True)
        for letter in "yncs":
            await here.say(sound(letter))
        assert here.heard == [Reply(True), Reply(False), StopCommand("stop")]
        assert [expecting for _, expecting in here.decoder.heard] == ["answers"] * 4
        here.ears.asking(False)
        await here.say(sound("c"))
        assert here.words == ["stop", "call number"]

    async def test_only_stops_count_if_answers_are_off(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.asking(True)
        for letter in "yncs":
            await here.say(sound(letter))
        assert here.heard == [StopCommand("stop")]

    @pytest.mark.parametrize("asks", [True, False])
    async def test_speech_from_before_a_question_is_no_answer(
        self, enter: Enter, asks: bool
    ) -> None:
        here = await enter(answers=True).ready()
        here.ears.asking(not asks)
        here.ears.talk()
        await here.source.feed(sound("y"))
        here.ears.asking(asks)
        await here.ready()
        assert here.heard == []
        await here.say(sound("s"))
        assert here.words == ["stop"]

    async def test_a_command_overtaken_by_a_question_is_reported_as_dropped(
        self, enter: Enter
    ) -> None:
        here = await enter().ready()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.ears.asking(True)
        await here.ready()
        assert here.heard == []
        assert here.told == [HearingNote("question between", "call number")]

    async def test_speech_that_is_no_answer_is_reported(self, enter: Enter) -> None:
        here = await enter(answers=True).ready()
        here.ears.asking(True)
        await here.say(sound("c"))
        assert here.heard == []
        assert here.told == [HearingNote("no answer")]

    @pytest.mark.parametrize("between", ["a question", "the robot speaks"])
    async def test_a_stop_counts_despite_a_question_or_muting(
        self, enter: Enter, between: str
    ) -> None:
        here = await enter(answers=True).ready()
        here.ears.talk()
        await here.source.feed(sound("s"))
        if between == "a question":
            here.ears.asking(True)
        else:
            here.ears.shut()
        await soon(lambda: bool(here.heard))
        assert here.heard == [StopCommand("stop")]

    async def test_each_mute_needs_its_own_unmute(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.shut()
        here.ears.shut()
        here.ears.open()
        assert here.state == "shut"
        here.ears.open()
        assert here.state != "shut"

    async def test_a_stop_is_heard_at_any_time(self, enter: Enter) -> None:
        here = await enter().ready()
        await here.say(sound("s"))
        assert here.heard == [StopCommand("stop")]


class TestTheEnd:
    async def test_a_source_that_ends_during_speech_loses_nothing(self, enter: Enter) -> None:
        here = await enter().ready()
        here.ears.talk()
        await here.source.feed(sound("c"))
        here.source.end()
        await here.over()
        assert here.words == ["call number"]
        assert here.told == [HearingNote("microphone closed")]

    @pytest.mark.parametrize("talks", [True, False])
    async def test_a_failing_source_raises_after_the_last_utterance(
        self, enter: Enter, talks: bool
    ) -> None:
        here = await enter().ready()
        if talks:
            here.ears.talk()
            await here.source.feed(sound("c"))
        here.source.end(SoundError("The cable is out."))
        with pytest.raises(SoundError, match="cable"):
            await here.over()
        assert here.words == ["call number"] * talks
        assert here.state == "over"

    @pytest.mark.parametrize("hands_free", [True, False])
    @pytest.mark.parametrize("moment", ["new", "starting", "waiting", "speaking", "thinking"])
    async def test_the_ears_can_be_closed_at_any_moment(
        self, enter: Enter, moment: str, hands_free: bool
    ) -> None:
        here = enter(hands_free=hands_free)
        if moment != "new":
            await soon(lambda: bool(FakeRecogniser.made))
        if moment in ("waiting", "speaking", "thinking"):
            await here.ready("listening" if hands_free else "off")
        if moment in ("speaking", "thinking"):
            here.ears.talk()
            await here.source.feed(sound("c"))
        if moment == "thinking":
            here.decoder.decoding.clear()
            here.ears.talk()
            await here.source.feed(*[sound(" ", 0.1)] * hands_free)
        await asyncio.wait_for(here.ears.close(), PATIENCE)
        await here.over()
        assert (here.heard, here.told) == ([], [])

    async def test_the_ears_can_be_closed_while_an_utterance_is_handled(self, enter: Enter) -> None:
        here = await enter().ready()
        here.taking.cancel()
        await asyncio.wait({here.taking})
        later = enter()
        later.taking.cancel()
        taking = asyncio.create_task(_first(later.ears))
        await later.ready()
        later.ears.talk()
        await later.source.feed(sound("c"))
        later.ears.talk()
        assert isinstance(await taking, Say)
        await later.ears.close()
        assert later.state == "over"
        with pytest.raises(StopAsyncIteration):
            await anext(later.ears)

    async def test_closed_ears_never_start(self, enter: Enter) -> None:
        here = enter()
        here.taking.cancel()
        await here.ears.close()
        await here.ears.close()
        with pytest.raises(StopAsyncIteration):
            await anext(here.ears)
        assert FakeRecogniser.made == []

    async def test_a_failing_observer_leaves_nothing_running(self, enter: Enter) -> None:
        here = await enter().ready()

        def gone() -> None:
            raise LookupError("the screen has gone")

        here.ears.changed = gone
        here.source.end()
        with pytest.raises(LookupError):
            await here.over()
        assert here.decoder.closed
        here.ears.changed = lambda: None


class TestHandsFree:
    async def test_every_utterance_in_a_stream_is_heard(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        stream = b"".join(sound(" ") + sound(letter) for letter in "cjxc") + sound(" ")
        for place in range(0, len(stream), 640):
            await here.source.feed(stream[place : place + 640])
        await soon(lambda: len(here.heard) == 4)
        assert here.words == ["call number", "tell a joke", "salad", "call number"]
        assert [pcm for pcm, _ in here.decoder.heard] == [sound(letter) for letter in "cjxc"]
        assert "speaking" in here.states

    @pytest.mark.parametrize("end", [True, False])
    async def test_a_stream_faster_than_the_decoder_is_decoded_completely(
        self, enter: Enter, end: bool
    ) -> None:
        here = await enter(hands_free=True).ready("listening")
        here.decoder.decoding.clear()
        gap = sound(" ", 0.02)  # less than a piece, so its piece already holds the following sound
        await here.source.feed(sound("c") + gap + sound("j") + gap + sound("x", 0.3))
        await here.source.feed(sound("x", 0.2) + (b"" if end else sound(" ")))
        if end:
            here.source.end()
            await soon(lambda: here.ears.ended)
        here.decoder.decoding.set()
        await soon(lambda: len(here.heard) == 3)
        assert [pcm for pcm, _ in here.decoder.heard][:3] == [sound(letter) for letter in "cjx"]
        if end:
            await here.over()

    async def test_a_question_drops_earlier_speech(self, enter: Enter) -> None:
        here = await enter(hands_free=True, answers=True).ready("listening")
        await here.source.feed(sound("c"))
        here.ears.asking(True)
        await soon(lambda: len(here.decoder.heard) == 1)
        await here.ready("listening")
        await here.source.feed(sound("y") + sound(" "))
        await soon(lambda: bool(here.heard))
        assert here.heard == [Reply(True)]

    async def test_the_robot_is_not_heard(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        here.ears.shut()
        await here.source.feed(sound("c") + sound(" "))
        here.ears.open()
        await here.source.feed(sound("x", 0.3), sound("j"), sound(" "))
        await soon(lambda: bool(here.heard))
        assert here.words == ["tell a joke"]

    async def test_hands_free_mode_ignores_the_talk_key(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        here.ears.talk()
        assert here.state == "listening"

    async def test_a_decoder_that_keeps_failing_is_abandoned(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        here.decoder.failures += [SpeechUnavailable("It died.")] * 9
        for _ in range(room.FAILURES):
            await here.source.feed(sound("c") + sound(" "))
            await soon(lambda: here.state in ("listening", "over"))
        with pytest.raises(SpeechUnavailable):
            await here.over()
        assert here.told == [HearingNote("not decoded", "It died.")] * (room.FAILURES - 1)

    @pytest.mark.slow
    async def test_an_undecoded_stream_is_bounded(self, enter: Enter) -> None:
        here = await enter(hands_free=True).ready("listening")
        here.decoder.decoding.clear()
        await here.source.feed(sound("c") + sound(" "))
        for _ in range(3 * MOST_WAITING):
            await here.source.feed(sound("x", 1))
        utterance = here.ears.utterance
        assert utterance is not None
        assert utterance.chunks.held <= 2 * RATE * MOST_WAITING


class TestStalls:
    def test_sound_after_a_stall_starts_a_new_utterance(self) -> None:
        utterance = Utterance(found=True)
        utterance.add(sound("a", 0.1), 1.0)
        utterance.add(sound("b", 0.1), 1.0 + STALLED)
        assert utterance.rest() == sound("a", 0.1) + sound("b", 0.1)
        utterance.add(sound("c", 0.1), 1.1 + 2 * STALLED)
        assert utterance.rest() == QUIET + sound("c", 0.1)

    def test_push_to_talk_joins_sound_across_a_stall(self) -> None:
        utterance = Utterance(found=False)
        utterance.add(sound("a", 0.1), 1.0)
        utterance.add(sound("b", 0.1), 2.0 + STALLED)
        assert utterance.rest() == sound("a", 0.1) + sound("b", 0.1)


class TestRecordings:
    async def test_each_utterance_of_a_recording_is_decoded_and_its_end_reported(
        self, enter: Enter
    ) -> None:
        here = enter(live=False)
        await here.source.feed(sound("c") + sound(" ") + sound("j") + sound(" ") + sound("s"))
        here.source.end()
        await here.over()
        assert here.words == ["call number", "tell a joke", "stop"]
        assert here.told == [HearingNote("recording over")]

    async def test_a_failed_utterance_is_reported_and_the_next_is_decoded(
        self, enter: Enter
    ) -> None:
        here = enter(live=False)
        await soon(lambda: bool(FakeRecogniser.made))
        here.decoder.failures.append(SpeechUnavailable("It died."))
        await here.source.feed(sound("c") + sound(" ") + sound("j"))
        here.source.end()
        await here.over()
        assert here.words == ["tell a joke"]
        assert here.told[0] == HearingNote("decoder failed", "It died.")


async def _first(ears: SpeechInput) -> Heard:
    return await anext(ears)
