"""The recogniser and its worker processes: nothing is lost if a worker dies or hangs."""

from __future__ import annotations

import asyncio
import os
from collections.abc import AsyncIterator, Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from tangy_hw.audio.wav import RATE
from tangy_profiles.worker_log import KEPT, MOST
from tangy_tui.speech import recogniser as room
from tangy_tui.speech.evidence import LONGEST, AcousticEvidence, DecoderVocabulary
from tangy_tui.speech.recogniser import (
    END_SECONDS,
    Recogniser,
    SpeechUnavailable,
)
from tests.learning.speech_fakes import PATIENCE, Workers, soon

WANTED = DecoderVocabulary(("call number",))
CHUNKS = [bytes([number]) * 640 for number in range(1, 9)]
WHOLE = b"".join(CHUNKS)


class Heard:
    """A recogniser with scripted workers, and its reports."""

    def __init__(self, folder: Path) -> None:
        self.told: list[str] = []
        self.partials: list[str] = []
        self.workers = Workers(folder)
        self.recogniser = Recogniser(notify=self.told.append)
        self.recogniser.partial = self._partial
        self._answered = asyncio.Event()
        self.sound: asyncio.Queue[bytes] = asyncio.Queue()

    def say(self, *chunks: bytes) -> None:
        for chunk in chunks:
            self.sound.put_nowait(chunk)

    async def hear(self, *, endpoint: bool = False) -> AcousticEvidence:
        async with asyncio.timeout(PATIENCE):
            return await self.recogniser.hear(self.sound, endpoint=endpoint)

    async def said(self, count: int, times: int = 1) -> None:
        """Wait until a number of bytes was answered a number of times."""
        async with asyncio.timeout(PATIENCE):
            while self.partials.count(f"{count} bytes") < times:
                self._answered.clear()
                await self._answered.wait()

    def _partial(self, words: str) -> None:
        self.partials.append(words)
        self._answered.set()


Begin = Callable[..., Heard]


@pytest.fixture
async def begin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Begin]:
    made: list[Heard] = []

    def one(*plans: dict[str, Any]) -> Heard:
        heard = Heard(tmp_path)
        heard.workers = Workers(tmp_path, *plans)
        monkeypatch.setattr(room, "WORKER", heard.workers.command)
        made.append(heard)
        return heard

    yield one
    for heard in made:
        await heard.recogniser.close()
        assert heard.recogniser.pid is None
    assert asyncio.all_tasks() == {asyncio.current_task()}


class TestHearing:
    async def test_partial_words_arrive_during_speech(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        hearing = asyncio.create_task(heard.hear())
        for number, chunk in enumerate(CHUNKS, 1):
            heard.say(chunk)
            await heard.said(640 * number)
            assert not hearing.done()
        heard.say(b"")
        assert await hearing == AcousticEvidence("call number", "", 0.0, 1.0, len(WHOLE) / 2 / RATE)
        assert heard.partials == [f"{640 * number} bytes" for number in range(1, 9)]
        assert heard.recogniser.said == WHOLE
        assert (heard.workers.heard, heard.told) == ([WHOLE], [])

    async def test_utterances_are_decoded_one_after_the_other(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        for chunk in CHUNKS:
            heard.say(chunk, b"")
            await heard.hear()
            assert heard.workers.heard == [chunk]

    async def test_sound_after_an_endpoint_is_left_for_the_next_utterance(
        self, begin: Begin
    ) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        heard.say(b"one.", b"two.three.", b"fo")
        assert (await heard.hear(endpoint=True)).seconds == 4 / 32_000
        rest = heard.recogniser.left + b"".join(
            heard.sound.get_nowait() for _ in range(heard.sound.qsize())
        )
        assert rest == b"two.three.fo"
        assert heard.recogniser.said == b"one."

    async def test_a_stream_without_speech_is_forgotten(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        silence = bytes(2 * RATE)
        heard.say(*[silence] * (3 * LONGEST), b"A" * 2 * RATE + b".")
        await heard.hear(endpoint=True)
        assert len(heard.recogniser.said) <= 2 * RATE * (LONGEST + room.BEHIND)
        assert heard.recogniser.said.endswith(b"A.")

    async def test_an_overlong_utterance_is_cut_to_its_beginning(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        assert (await heard.recogniser.decode(bytes(2 * RATE * (LONGEST + 5)))).seconds == LONGEST
        heard.say(*[b"A" * 2 * RATE] * (LONGEST + 5), b"")
        assert (await heard.hear()).seconds == LONGEST
        assert heard.workers.heard == [b"A" * 2 * RATE * LONGEST]

    async def test_a_cancelled_utterance_does_not_answer_the_next(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        given_up = asyncio.create_task(heard.hear())
        heard.say(*CHUNKS[:3])
        await heard.said(3 * 640)
        given_up.cancel()
        await asyncio.wait({given_up})
        heard.say(CHUNKS[4], b"")
        assert (await heard.hear()).seconds == 320 / RATE
        assert (heard.workers.heard, heard.told) == ([CHUNKS[4]], [])

    async def test_concurrent_requests_are_decoded_in_turn(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        found = await asyncio.gather(*(heard.recogniser.decode(WHOLE[: 2 * n]) for n in (9, 5, 7)))
        assert [evidence.seconds for evidence in found] == [9 / RATE, 5 / RATE, 7 / RATE]

    async def test_a_recording_is_split_into_pieces(self, begin: Begin) -> None:
        many = [[0.001 * number, 0.001 * number + 0.01] for number in range(6_000)]
        heard = begin({"found": many})
        await heard.recogniser.start(WANTED)
        assert len(str(many)) > 1 << 16  # longer than asyncio's default limit of a line
        found = await heard.recogniser.pieces(bytes(2 * RATE * 7))
        assert len(found) == 6_000
        assert {len(piece) for piece in found} == {320}

    async def test_the_voice_of_a_person_is_learnt_from_sentences(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        said = [(WHOLE, "call number"), (WHOLE, "tea")]
        assert await heard.recogniser.voice(said) == "usual call number tea"

    async def test_words_without_pronunciation_are_reported(self, begin: Begin) -> None:
        heard = begin({"left_out": ["xhqzr"]})
        await heard.recogniser.start(WANTED)
        assert heard.recogniser.left_out == ("xhqzr",)


class TestDeath:
    @pytest.mark.parametrize("how", ["die", "exit", "close", "\n", "[]\n", "{nothing\n", "7\n"])
    async def test_a_worker_that_dies_in_mid_utterance_loses_nothing(
        self, begin: Begin, how: str, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("tangy_hw.worker_process.LINGERS_SECONDS", 0.2)
        heard = begin({"chunk 4": how}, {})
        await heard.recogniser.start(WANTED)
        first = heard.recogniser.pid
        hearing = asyncio.create_task(heard.hear())
        for chunk in CHUNKS[:4]:
            heard.say(chunk)
        await heard.said(640, times=2)
        heard.say(*CHUNKS[4:], b"")
        assert (await hearing).seconds == len(WHOLE) / 2 / RATE
        assert heard.workers.heard[1] == WHOLE  # again from its start, and the rest: once
        assert heard.recogniser.said == WHOLE
        assert heard.recogniser.pid not in (None, first)
        (how,) = heard.told
        assert how
        assert "\n" not in how

    @pytest.mark.parametrize("how", ["die", "x" * 100 + "\n", "flood"])
    async def test_a_worker_that_dies_at_the_end_is_replaced_and_asked_again(
        self, begin: Begin, how: str
    ) -> None:
        heard = begin({"end": how}, {})
        await heard.recogniser.start(WANTED)
        heard.say(*CHUNKS, b"")
        assert (await heard.hear()).words == "call number"
        assert heard.workers.heard == [WHOLE, WHOLE]

    async def test_an_utterance_that_kills_two_workers_is_abandoned(self, begin: Begin) -> None:
        heard = begin({"end": "die"}, {"end": "die"}, {})
        await heard.recogniser.start(WANTED)
        heard.say(*CHUNKS, b"")
        with pytest.raises(SpeechUnavailable, match=r"twice .*signal 9"):
            await heard.hear()
        assert len(heard.told) == 2
        heard.say(CHUNKS[0], b"")
        assert (await heard.hear()).words == "call number"
        assert heard.workers.heard == [WHOLE, WHOLE, CHUNKS[0]]

    async def test_a_worker_that_dies_between_utterances_is_reported_and_replaced(
        self, begin: Begin
    ) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        assert heard.recogniser.pid is not None
        os.kill(heard.recogniser.pid, 9)
        heard.say(*CHUNKS, b"")
        assert (await heard.hear()).words == "call number"
        assert len(heard.told) == 1

    async def test_a_worker_that_cannot_start_is_an_error(self, begin: Begin) -> None:
        heard = begin({"start": "exit"})
        with pytest.raises(SpeechUnavailable, match="status 3"):
            await heard.recogniser.start(WANTED)
        heard.say(*CHUNKS, b"")
        with pytest.raises(SpeechUnavailable, match="status 3"):
            await heard.hear()

    async def test_a_missing_worker_program_is_an_error(
        self, begin: Begin, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        heard = begin()
        monkeypatch.setattr(room, "WORKER", (str(tmp_path / "python"),))
        with pytest.raises(SpeechUnavailable, match="No such file"):
            await heard.recogniser.start(WANTED)

    async def test_an_utterance_is_decoded_again_if_its_worker_hangs(
        self, begin: Begin, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(room, "STALLED_SECONDS", 0.05)
        heard = begin({"end": "hang"}, {})
        await heard.recogniser.start(WANTED)
        heard.say(*CHUNKS, b"")
        assert (await heard.hear()).words == "call number"
        assert heard.workers.heard[1] == b"".join(CHUNKS)

    async def test_an_utterance_that_hangs_two_workers_is_abandoned(
        self, begin: Begin, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(room, "STALLED_SECONDS", 0.05)
        heard = begin({"end": "hang"}, {"end": "hang"}, {})
        await heard.recogniser.start(WANTED)
        heard.say(*CHUNKS, b"")
        with pytest.raises(SpeechUnavailable, match="twice over one utterance"):
            await heard.hear()
        heard.say(CHUNKS[0], b"")
        assert (await heard.hear()).words == "call number"

    async def test_a_worker_that_stops_reading_loses_nothing(
        self, begin: Begin, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(room, "DECODE_SECONDS", 0.2)
        heard = begin({"chunk 1": "hang"}, {})
        await heard.recogniser.start(WANTED)
        chunks = [bytes([number]) * 64_000 for number in range(1, 7)]  # more than a pipe holds
        heard.say(*chunks, b"")
        assert (await heard.hear()).seconds == 12
        assert heard.workers.heard[1] == b"".join(chunks)
        assert "signal 9" in heard.told[0]

    async def test_a_failing_display_of_partial_words_does_not_block_the_next_utterance(
        self, begin: Begin
    ) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)

        def refuse(words: str) -> None:
            raise LookupError(words)

        heard.recogniser.partial = refuse
        heard.say(*CHUNKS, b"")
        with pytest.raises(LookupError):
            await heard.hear()
        heard.recogniser.partial = lambda words: None
        heard.sound = asyncio.Queue()
        heard.say(*CHUNKS, b"")
        assert (await heard.hear()).words == "call number"
        assert heard.told == []


async def test_the_log_of_the_workers_is_bounded(begin: Begin, tmp_path: Path) -> None:
    log = tmp_path / "speech.log"
    log.write_bytes(b"an old line\n" * (MOST // 6))
    begin()
    recogniser = Recogniser(log=log)
    try:
        await recogniser.start(WANTED)
        assert 0 < log.stat().st_size <= KEPT
    finally:
        await recogniser.close()


class TestClosing:
    async def test_nothing_is_decoded_before_the_start_or_after_the_end(self, begin: Begin) -> None:
        heard = begin()
        with pytest.raises(SpeechUnavailable, match="not started"):
            await heard.recogniser.decode(WHOLE)
        await heard.recogniser.start(WANTED)
        await heard.recogniser.close()
        with pytest.raises(SpeechUnavailable, match="not started"):
            await heard.recogniser.decode(WHOLE)
        assert len(heard.workers.heard) == 1
        assert heard.told == []

    @pytest.mark.parametrize("plan", [{}, {"chunk 2": "hang"}, {"end": "hang"}])
    async def test_closing_does_not_wait_for_an_utterance(
        self, begin: Begin, plan: dict[str, Any]
    ) -> None:
        heard = begin(plan)
        await heard.recogniser.start(WANTED)
        hearing = asyncio.create_task(heard.hear())
        heard.say(*CHUNKS[:2], *([b""] if "end" in plan else []))
        await heard.said(1280)
        pid = heard.recogniser.pid
        assert pid is not None
        await asyncio.wait_for(heard.recogniser.close(), END_SECONDS)
        with pytest.raises(SpeechUnavailable):
            await hearing
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)
        assert (len(heard.workers.heard), heard.told) == (1, [])

    async def test_the_recogniser_can_be_closed_during_its_start(self, begin: Begin) -> None:
        for moment in ("start", "wanted"):
            heard = begin({moment: "hang"})
            starting = asyncio.create_task(heard.recogniser.start(WANTED))
            await soon(partial(_runs, heard.recogniser))
            await asyncio.wait_for(heard.recogniser.close(), END_SECONDS)
            with pytest.raises(SpeechUnavailable):
                await starting
            assert heard.told == []

    async def test_a_closed_recogniser_can_be_started_again(self, begin: Begin) -> None:
        heard = begin()
        await heard.recogniser.start(WANTED)
        await heard.recogniser.close()
        await heard.recogniser.start(WANTED)
        assert (await heard.recogniser.decode(WHOLE)).words == "call number"


def _runs(recogniser: Recogniser) -> bool:
    return recogniser.pid is not None
