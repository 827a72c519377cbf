"""Speech as text: the vocabulary, the answers of the decoder process, and their meaning."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_hw.audio.wav import read_wav
from tangy_profiles.activity import load_activity
from tangy_profiles.codec import decode, encode
from tangy_profiles.errors import TangyError
from tangy_profiles.person import load_people
from tangy_profiles.phones import PHONES
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.steering import IN_GAMES, WHILE_TEACHING, steering_texts
from tangy_tui.language.stop_sentence import STOPS, stops
from tangy_tui.learning.verification import Reply, Say, StopCommand
from tangy_tui.speech import decoder as speech_decoder
from tangy_tui.speech import transcription, voice_adaptation
from tangy_tui.speech import worker as room
from tangy_tui.speech.evidence import (
    LONGEST,
    RATE,
    USUAL,
    AcousticEvidence,
    DecoderVocabulary,
    EvidenceSettings,
    Expecting,
)
from tangy_tui.speech.language import dictionary, grammar, open_model, phrase_model
from tangy_tui.speech.understanding import (
    SURE,
    UNDERSTOOD,
    UNSURE,
    answer,
    best_words,
    likelihood,
    understand,
    wanted,
)
from tangy_tui.speech.voice_adaptation import KnownSound
from tangy_tui.speech.worker import LARGEST_PIECE, STANDS, Worker
from tests.hw.sounds import wav
from tests.learning.speech_fakes import FakeRecogniser, sound

BOOK = Phrasebook(load_activity("bingo"), load_people(4))
PAPER = replace(USUAL, mode="paper")

WORD = st.text("abcdeghijklmnoprstuw", min_size=1, max_size=6)
PHRASES = st.lists(st.lists(WORD, min_size=1, max_size=4).map(" ".join), min_size=1, max_size=8)
PROBABILITIES = st.floats(1e-6, 0.05)
ALL_PHONES = st.lists(st.sampled_from(sorted(PHONES)), min_size=1, max_size=5).map(" ".join)
SAID = (
    st.lists(
        st.sampled_from(
            [*sorted({w for p in BOOK.spoken() for w in p.split()}), "soup", "was", "my"]
        ),
        max_size=6,
    )
    .map(" ".join)
    .filter(lambda words: not stops(words, BOOK.game))
)


def evidence(words: str, confidence: float = 1.0, margin: float = 0.0) -> AcousticEvidence:
    return AcousticEvidence(words, "", margin, confidence, 1.0)


class TestLanguage:
    @given(st.dictionaries(WORD, st.lists(ALL_PHONES, min_size=1, max_size=3)), st.booleans())
    def test_the_dictionary_has_every_word(self, said: dict[str, list[str]], phones: bool) -> None:
        found: dict[str, list[str]] = {}
        for line in dictionary(said, phones=phones).splitlines():
            word, _, ways = line.partition(" ")
            found.setdefault(re.sub(r"\(\d+\)$", "", word), []).append(ways)
        own = {word: ways for word, ways in found.items() if not word.startswith("_")}
        assert own == said
        assert len(found) - len(own) == (len(PHONES) if phones else 0)

    @given(PHRASES, st.floats(1e-6, 100))
    def test_the_grammar_has_the_phrases_and_a_weighted_garbage_branch(
        self, phrases: list[str], weight: float
    ) -> None:
        rules = dict(re.findall(r"<(\w+)> = (.*?);", grammar(phrases, weight), re.DOTALL))
        assert [p.strip() for p in rules["command"].split("|")] == phrases
        branches = re.fullmatch(r"/1/ <command> \| /(.+)/ <garbage>", rules["said"])
        assert branches is not None
        assert float(branches[1]) == pytest.approx(weight, rel=1e-4)
        assert "/" not in rules["phone"]  # weights there would be shared among the phones
        assert len(rules["phone"].split("|")) == len(PHONES)

    @given(PHRASES, st.dictionaries(WORD, PROBABILITIES, min_size=1, max_size=9), st.floats(0, 0.9))
    def test_the_open_language_model_is_normalised(
        self, phrases: list[str], everyday: dict[str, float], share: float
    ) -> None:
        model = open_model(phrases, everyday, share)
        plain = entries(phrase_model(phrases))
        found = entries(model)
        for order, count in re.findall(r"ngram (\d)=(\d+)", model):
            assert len(found[int(order)]) == int(count)
        spoken = {w for p in phrases for w in p.split()}
        words = set(found[1]) - {"<s>", "</s>"}
        assert words == (spoken | set(everyday) if share else spoken)
        chances = {word: 10 ** found[1][word] for word in found[1] if word != "<s>"}
        assert sum(chances.values()) <= 1.001
        whole = sum(everyday.values())
        for word in words:
            own = 10 ** plain[1][word] if word in spoken else 0.0
            mixed = (1 - share) * own + share * everyday.get(word, 0.0) / whole
            assert chances[word] == pytest.approx(mixed, rel=1e-3)
        assert found[2] == plain[2]
        assert found[3] == plain[3]
        assert model.endswith("\\end\\\n")

    def test_the_vocabulary_has_phrases_stops_steering_words_and_answers(self) -> None:
        found = wanted(BOOK, USUAL)
        teaching = steering_texts(WHILE_TEACHING)
        assert found.phrases == (*BOOK.spoken(), *STOPS, *teaching)
        assert {*STOPS, *steering_texts(IN_GAMES)} < set(found.answers)
        assert found.urgent == STOPS
        assert wanted(BOOK, USUAL, ["tell a joke"]).phrases == ("tell a joke", *STOPS, *teaching)
        assert wanted(BOOK, PAPER).phrases == (*BOOK.spoken(), *STOPS)

    @pytest.mark.slow
    @given(
        st.builds(
            DecoderVocabulary,
            PHRASES.map(tuple),
            PHRASES.map(tuple),
            PHRASES.map(tuple),
            st.dictionaries(WORD, st.lists(ALL_PHONES, min_size=1, max_size=2).map(tuple)),
            st.builds(
                EvidenceSettings, st.sampled_from(["tiers", "paper"]), PROBABILITIES, PROBABILITIES
            ),
        )
    )
    def test_the_vocabulary_is_encoded_and_decoded_unchanged(self, one: DecoderVocabulary) -> None:
        assert decode(DecoderVocabulary, json.loads(json.dumps(encode(one)))) == one

    def test_importing_the_speech_modules_loads_no_heavy_package(self) -> None:
        code = (
            "import sys, tangy_tui.language.commands, tangy_tui.speech.input\n"
            "import tangy_tui.speech.transcription, tangy_tui.speech.worker\n"
            "heavy = {'numpy', 'pocketsphinx', 'textual', 'rich'} & set(sys.modules)\n"
            "sys.exit(str(heavy) if heavy else 0)"
        )
        subprocess.run([sys.executable, "-c", code], check=True)  # noqa: S603 - our own code


def entries(model: str) -> dict[int, dict[str, float]]:
    """Return the logarithms of an ARPA model, by order and words."""
    found: dict[int, dict[str, float]] = {}
    for order, section in re.findall(r"\\(\d)-grams:\n(.*?)(?=\n\n|\n\\)", model, re.DOTALL):
        lines = [line.split() for line in section.splitlines()]
        found[int(order)] = {
            " ".join(line[1 : 1 + int(order)]): float(line[0]) for line in lines if line
        }
    return found


class TestUnderstanding:
    @pytest.mark.parametrize("phrase", BOOK.spoken())
    def test_every_phrase_is_sure_when_it_is_clear(self, phrase: str) -> None:
        said = understand(evidence(phrase), BOOK, USUAL)
        command = BOOK.understand(phrase)
        assert isinstance(said, Say)
        assert command is not None
        assert said.sure
        assert said.commands
        assert (said.commands[0].behaviour, said.commands[0].arguments) == (
            command.behaviour,
            command.arguments,
        )
        assert said.text == phrase

    @pytest.mark.parametrize(
        ("words", "phrase", "margin", "meant"),
        [
            ("go to user on", "go to user one", -0.8, "go to user one"),
            ("go to user on", "go to user one", 0.3, "go to user on"),  # explain it better
            ("bring me a glass of water", "bring the card closer", -1.1, None),
            ("go to user two", "go to user three", -0.5, None),  # both are phrases
            ("we have a problem", "", -0.8, None),
        ],
    )
    def test_words_are_replaced_by_a_similar_sounding_phrase(
        self, words: str, phrase: str, margin: float, meant: str | None
    ) -> None:
        found = best_words(AcousticEvidence(words, phrase, margin, 1.0, 1.0), BOOK)
        assert found[0] == (meant or words)

    @given(SAID, st.floats(-3, 0), st.floats(-3, 3))
    def test_the_confidence_alone_determines_the_tier(
        self, words: str, margin: float, shift: float
    ) -> None:
        said = understand(evidence(words, margin=margin), BOOK, replace(USUAL, shift=shift))
        assert isinstance(said, Say)
        assert said.text == words
        assert said.commands is not None
        assert 0 <= said.confidence <= 1
        assert len(said.commands) <= 3
        if said.commands:
            assert said.confidence >= UNSURE - 0.001
            assert said.sure == (said.confidence >= SURE) or abs(said.confidence - SURE) < 0.001
            behaviours = [(c.behaviour, dict(c.arguments)) for c in said.commands]
            assert all(behaviours.count(one) == 1 for one in behaviours)
        else:
            assert said.confidence < UNSURE

    @given(SAID, st.floats(-3, 0), st.floats(-2, 2), st.floats(0, 2))
    def test_a_stricter_threshold_never_raises_the_confidence(
        self, words: str, margin: float, shift: float, more: float
    ) -> None:
        one, other = (
            understand(evidence(words, margin=margin), BOOK, replace(USUAL, shift=by))
            for by in (shift, shift + more)
        )
        assert isinstance(one, Say)
        assert isinstance(other, Say)
        assert other.confidence <= one.confidence
        assert len(other.commands or ()) <= len(one.commands or ())
        assert one.sure or not other.sure or not other.commands

    def test_the_strictest_threshold_accepts_no_command(self) -> None:
        said = understand(evidence("call the next number"), BOOK, replace(USUAL, shift=50.0))
        assert isinstance(said, Say)
        assert said.commands == ()

    @given(st.floats(0, 1), st.floats(0, 1), st.integers(0, 9), st.integers(0, 9), st.floats(-5, 5))
    def test_the_likelihood_is_monotonic(
        self, less: float, more: float, few: int, many: int, margin: float
    ) -> None:
        less, more, few, many = min(less, more), max(less, more), min(few, many), max(few, many)
        found = likelihood(less, few, margin)
        assert 0 <= found <= likelihood(more, few, margin) <= 1
        assert found <= likelihood(less, many, margin)
        assert found <= likelihood(less, few, margin + 1)

    @pytest.mark.parametrize(
        ("words", "user"),
        [("go to user to", "user2"), ("go to user for", "user4"), ("help user won", "user1")],
    )
    def test_a_number_is_understood_in_any_spelling(self, words: str, user: str) -> None:
        said = understand(evidence(words), BOOK, USUAL)
        assert isinstance(said, Say) and said.commands and said.sure
        assert dict(said.commands[0].arguments) == {"user": user}

    def test_other_speech_and_silence_are_no_command(self) -> None:
        for words in ("", "the soup was too salty", "the to a", "my sister lives in canada"):
            said = understand(evidence(words, margin=-0.5), BOOK, USUAL)
            assert isinstance(said, Say)
            assert said.commands == ()

    @pytest.mark.parametrize("settings", [USUAL, PAPER, replace(USUAL, shift=9.0)])
    @pytest.mark.parametrize(
        "words",
        [
            *(*STOPS, "Stop!", "tangy stop now", "stop right there", "I said stop!", "whoa, stop"),
            *("stop what you are doing", "you must stop", "stop where you are", "stop people"),
        ],
    )
    def test_a_stop_is_understood_in_every_mode(
        self, words: str, settings: EvidenceSettings
    ) -> None:
        found = understand(AcousticEvidence(words, "", -9.0, 0.0, 0.3), BOOK, settings)
        assert found == StopCommand(words)
        assert answer(evidence(words), settings) == StopCommand(words)
        assert stops(words)

    @pytest.mark.parametrize(
        "words",
        [
            *("", "don't stop", "do not stop", "where does the bus stop", "non stop", "please"),
            *("stop the music please", "stop now the music", "he said that they stop here"),
        ],
    )
    def test_a_mention_of_stopping_is_no_stop(self, words: str) -> None:
        assert not stops(words)

    @pytest.mark.parametrize(
        ("words", "meant"),
        [
            ("yes", Reply(True)),
            ("yes please", Reply(True)),
            ("no", Reply(False)),
            ("no that is wrong", Reply(False)),
            ("yes no", None),
            ("yesterday", None),
            ("no one called", None),
            ("call number", None),
            ("", None),
        ],
    )
    def test_yes_and_no_phrases_are_answers(self, words: str, meant: Reply | None) -> None:
        sure = replace(evidence(words), phrase=words, margin=-0.4)
        assert answer(sure, USUAL) == meant

    @pytest.mark.parametrize("words", ["yes", "no"])
    def test_words_that_only_sound_like_an_answer_are_none(self, words: str) -> None:
        sure = replace(evidence(words), phrase=words, margin=-0.4)
        assert answer(replace(sure, phrase=""), USUAL) is not None
        assert answer(replace(sure, phrase="", margin=-0.7), USUAL) is None  # any phones fit better
        other = {"yes": "no do not", "no": "yes please"}[words]
        assert answer(replace(sure, phrase=other, margin=0.5), USUAL) is None
        assert answer(replace(sure, margin=-1.3), USUAL) is None
        assert answer(sure, replace(USUAL, shift=1.0)) is None
        assert answer(sure, PAPER) is None

    def test_the_confidence_of_the_paper_combines_sound_and_match(self) -> None:
        exact = understand(evidence("go to the front", 0.9), BOOK, PAPER)
        keyword = understand(evidence("front", 0.9), BOOK, PAPER)
        assert isinstance(exact, Say)
        assert isinstance(keyword, Say)
        assert exact.confidence == 0.9
        assert UNDERSTOOD < keyword.confidence < 0.9
        assert exact.sure
        assert [c.confidence for c in exact.commands or ()] == [0.9]

    @given(SAID, st.floats(0, 1), st.floats(0, 1))
    def test_the_paper_mode_has_one_tier(self, words: str, less: float, more: float) -> None:
        less, more = min(less, more), max(less, more)
        one, other = (understand(evidence(words, c), BOOK, PAPER) for c in (less, more))
        assert isinstance(one, Say)
        assert isinstance(other, Say)
        assert one.sure
        assert other.sure
        assert len(one.commands or ()) <= len(other.commands or ()) <= 1
        if one.commands:
            assert one.confidence <= other.confidence
            assert one.confidence >= UNDERSTOOD


class LetterDecoder:
    """A decoder whose words are the letters of the sound, each once and in order."""

    left_out = ("xhqzr",)

    def __init__(self) -> None:
        self.so_far: list[str] = []
        self.broken = ""

    def _take(self, pcm: bytes) -> str:
        if self.broken in ("partial", "decode"):
            raise RuntimeError("it broke\nin two lines")
        for letter in pcm.decode()[::2]:
            if [letter] != self.so_far[-1:]:
                self.so_far.append(letter)
        return " ".join(self.so_far)

    def close(self) -> None:
        """Do nothing, as nothing was started."""

    def begin(self, expecting: Expecting) -> None:
        self.so_far = []

    def partial(self, pcm: bytes) -> str:
        return self._take(pcm) if self.broken != "decode" else ""

    def decode(self, pcm: bytes, expecting: Expecting) -> AcousticEvidence:
        self.so_far = []
        return AcousticEvidence(self._take(pcm), "", 0.0, 1.0, len(pcm) / 2 / RATE)


@pytest.fixture
def ask(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[dict[str, Any]]]:
    """Ask a worker with a given decoder; "s" is urgent. Returns its answers."""
    answers: list[dict[str, Any]] = []
    monkeypatch.setattr(room, "SILENCE", -1)  # a letter is as flat as silence
    worker = Worker(answers.append)
    worker.decoder = LetterDecoder()
    worker.urgent = frozenset("s")

    def send(*requests: object, broken: str = "") -> list[dict[str, Any]]:
        answers.clear()
        worker.decoder.broken = broken
        for request in requests:
            worker.take(request)
        return list(answers)

    return send


def said(pcm: bytes) -> dict[str, str]:
    import base64

    return {"pcm": base64.b64encode(pcm).decode()}


Ask = Callable[..., list[dict[str, Any]]]
BEGIN = {"id": 7, "begin": "commands"}
END = {"id": 7, "end": True}


class TestWorker:
    @pytest.mark.parametrize(
        "request_",
        [None, [], 7, {}, {"id": 1}, {"wanted": [1]}, {"begin": "songs"}, {"pcm": 1}, {"end": 1}],
    )
    def test_invalid_requests_are_answered_with_an_error(self, ask: Ask, request_: object) -> None:
        (answer_,) = ask(request_)
        assert "must hold" in answer_["error"]

    def test_a_voice_is_learnt_from_sound_and_its_words(
        self, ask: Ask, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def learn(known: list[KnownSound], words: str) -> str:
            return f"{[(one.pcm, one.text) for one in known]} {words}"

        monkeypatch.setattr(voice_adaptation, "voice_of", learn)
        read = {"id": 4, "said": [[said(b"abcd")["pcm"], "hello xhqzr"]]}
        assert "before" in ask(read)[0]["error"]
        monkeypatch.setattr(speech_decoder, "make_decoder", lambda _: LetterDecoder())
        wanted_ = {"phrases": ["hello"], "pronunciations": {"xhqzr": ["EH K S"]}}
        _, answer_ = ask({"id": 3, "wanted": wanted_}, read)
        assert answer_["id"] == 4
        sound, words = answer_["voice"].split("] ")
        assert sound == "[(b'abcd', 'hello xhqzr')"
        assert words.splitlines()[0] == "hello HH AH L OW"
        assert words.splitlines()[-1] == "xhqzr EH K S"

    @pytest.mark.parametrize(
        "odd", [{}, {"phrases": 1}, {"phrases": ["a"], "settings": {"loud": 1}}]
    )
    def test_an_unreadable_vocabulary_is_an_error(self, ask: Ask, odd: object) -> None:
        (answer_,) = ask({"id": 1, "wanted": odd})
        assert "cannot be read" in answer_["error"]

    def test_sound_before_phrases_is_an_error(self) -> None:
        answers: list[dict[str, Any]] = []
        Worker(answers.append).take(BEGIN)
        assert answers[0]["id"] == 7
        assert "phrases must come before" in answers[0]["error"]

    def test_partial_words_are_sent_on_change_and_the_evidence_at_the_end(self, ask: Ask) -> None:
        parts = [sound(letter, 0.1) for letter in "aab"]
        answers = ask(BEGIN, *map(said, parts), END)
        assert [a["partial"] for a in answers[:-1]] == ["a", "a b"]
        assert answers[-1]["heard"]["words"] == "a b"
        assert answers[-1]["used"] == len(b"".join(parts))
        assert {a["id"] for a in answers} == {7}

    def test_large_chunks_give_no_partial_words(self, ask: Ask) -> None:
        answers = ask(BEGIN, said(sound("a", 2 * LARGEST_PIECE)), END)
        assert [sorted(a) for a in answers] == [["heard", "id", "used"]]

    def test_urgent_words_alone_end_an_utterance(self, ask: Ask) -> None:
        parts = [said(sound("s", STANDS / 3))] * 6
        answers = ask(BEGIN, *parts, END)
        assert [a for a in answers if "heard" in a] == answers[-1:]
        assert answers[-1]["heard"]["seconds"] == pytest.approx(STANDS / 3 * 4, abs=0.001)

    def test_urgent_words_within_a_sentence_do_not_end_it(self, ask: Ask) -> None:
        parts = [said(sound(letter, STANDS / 2)) for letter in "ssaaaass"]
        answers = ask(BEGIN, *parts, END)
        assert answers[-1]["heard"]["seconds"] == pytest.approx(4 * STANDS, abs=0.001)

    def test_an_overlong_utterance_is_cut(self, ask: Ask) -> None:
        answers = ask(BEGIN, *[said(sound("a", 1))] * (LONGEST + 3), END)
        assert answers[-1]["heard"]["seconds"] == LONGEST

    def test_the_end_of_another_utterance_ends_nothing(self, ask: Ask) -> None:
        answers = ask(BEGIN, said(sound("a", 0.1)), {"id": 6, "end": True})
        assert [sorted(a) for a in answers] == [["id", "partial"]]
        assert ask(END)[0]["heard"]["words"] == "a"
        assert ask(END, said(sound("a", 0.1))) == []

    @pytest.mark.parametrize("broken", ["partial", "decode"])
    def test_a_decoder_error_is_sent_to_its_request_only(self, ask: Ask, broken: str) -> None:
        answers = ask(BEGIN, said(sound("a", 0.1)), END, broken=broken)
        errors = [a for a in answers if "error" in a]
        assert [a["id"] for a in errors] == [7]
        assert errors[0]["error"] == "The speech decoder failed: it broke in two lines."
        assert ask(BEGIN, said(sound("a", 0.1)), END)[-1]["heard"]["words"] == "a"

    @pytest.mark.parametrize("pcm", [b"", b"\0", bytes(2 * RATE), sound("a"), b"\1\0\0\0" * RATE])
    def test_silence_has_no_words(
        self, ask: Ask, pcm: bytes, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(room, "SILENCE", 8)
        found = ask(BEGIN, said(pcm), END)[-1]["heard"]
        assert (found["words"], found["confidence"]) == ("", 0.0)
        assert found["seconds"] == pytest.approx(len(pcm) // 2 / RATE)

    def test_invalid_sound_is_an_error_of_its_request(self, ask: Ask) -> None:
        (answer_,) = ask(BEGIN, {"pcm": "not base64!"}, END)
        assert answer_ == {"id": 7, "error": "The sound is not base64."}


class TestListening:
    @pytest.fixture(autouse=True)
    def _fake(self, monkeypatch: pytest.MonkeyPatch) -> None:
        FakeRecogniser.made = []
        monkeypatch.setattr(transcription, "Recogniser", FakeRecogniser)

    def test_a_file_is_one_command(self, tmp_path: Path) -> None:
        files = [tmp_path / f"{letter}.wav" for letter in "csx"]
        for file in files:
            file.write_bytes(wav(sound(file.stem)))
        rows = transcription.listen(files, BOOK)
        assert [row["file"] for row in rows] == [str(file) for file in files]
        assert [row["tier"] for row in rows] == ["sure", "stop", "nothing"]
        assert [row["behaviour"] for row in rows] == ["call number", None, None]
        assert [row["heard"] for row in rows] == ["call number", "stop", "salad"]
        assert rows[0]["choices"][0] == {"behaviour": "call number", "arguments": {}}
        assert all(math.isfinite(row["confidence"]) for row in rows)
        json.dumps(rows)
        assert FakeRecogniser.made[0].closed

    def test_files_are_read_and_reported_one_by_one(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        happened: list[str] = []

        def noted(file: Path) -> bytes:
            happened.append(f"read {file.stem}")
            return read_wav(file)

        monkeypatch.setattr(transcription, "read_wav", noted)
        files = [tmp_path / f"{letter}.wav" for letter in "cj"]
        for file in files:
            file.write_bytes(wav(sound(file.stem)))
        transcription.listen(
            files,
            BOOK,
            tell=lambda done, rows: happened.append(f"{done}: {rows[0]['behaviour']}"),
        )
        assert happened == ["read c", "1: call number", "read j", "2: joke"]

    def test_a_long_file_is_split_at_its_pauses(self, tmp_path: Path) -> None:
        file = tmp_path / "two.wav"
        file.write_bytes(wav(sound("c") + sound(" ", 1) + sound("j")))
        rows = transcription.listen([file], BOOK)
        assert [row["behaviour"] for row in rows] == ["call number", "joke"]

    def test_sound_after_the_longest_utterance_is_decoded_too(self, tmp_path: Path) -> None:
        file = tmp_path / "long.wav"
        file.write_bytes(wav(sound("c", LONGEST) + sound(" ", 0.5) + sound("j")))
        rows = transcription.listen([file], BOOK)
        assert [row["behaviour"] for row in rows] == ["call number", "joke"]

    def test_no_files_give_no_rows(self) -> None:
        assert transcription.listen([], BOOK) == []
        assert FakeRecogniser.made == []

    def test_a_file_that_cannot_be_read_is_named_before_anything_is_decoded(
        self, tmp_path: Path
    ) -> None:
        (tmp_path / "text.wav").write_text("hello")
        good = tmp_path / "c.wav"
        good.write_bytes(wav(sound("c")))
        for name in ("none.wav", "text.wav"):
            with pytest.raises(TangyError, match=name):
                transcription.listen([good, tmp_path / name], BOOK)
        assert FakeRecogniser.made == []
