"""A second look with the acoustic model's means of other voices: stops and requests."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tangy_hw.audio.wav import RATE, read_wav
from tangy_profiles.activity import load_activity
from tangy_profiles.person import load_people
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.language.words import spoken, words_of
from tangy_tui.learning.verification import Say, StopCommand
from tangy_tui.speech import other_voices, pocketsphinx_search, stop_decoder
from tangy_tui.speech.decoder import make_decoder, spelt
from tangy_tui.speech.evidence import USUAL, AcousticEvidence, OtherHearing
from tangy_tui.speech.microphone_check import to_say
from tangy_tui.speech.other_voices import (
    NO_SPEECH,
    PHONES,
    SIZE,
    STREAMS,
    base_means,
    both_means,
    is_voice,
    moved_means,
    transformed,
    voice_text,
)
from tangy_tui.speech.stop_decoder import FITS, HeardStop, StopDecoder
from tangy_tui.speech.understanding import understand, wanted
from tangy_tui.speech.voice_adaptation import FEWEST, KnownSound, voice_of

BOOK = Phrasebook(load_activity("bingo"), load_people(4))
STOPPING = "somebody stop the robot"

BADLY = FITS - 1.0
FORMANT_STOPS = (
    ("please to stop the robot now", "en-us+f4"),
    ("stand still Tangy", "en-029+m5"),
    ("get off my foot", "en-029+m5"),
)
"""Sentences that the usual means do not hear, and the voices that say them."""
FORMANT_VOICE, REQUEST = "en-us+m3", "what's the next number"


def heard_with(
    monkeypatch: pytest.MonkeyPatch, usual: float, other: float, words: str = "the dog"
) -> tuple[HeardStop, list[str]]:
    """Return what is heard if the other means hear a stop, and the means that were used."""
    paths = {"usual": (words, usual, 0.0), "other": ("hey stop", other, 0.0)}
    used: list[str] = []

    def best_path(search: Any, *_: object) -> tuple[str, float, float]:
        used.append(search.name)
        return paths[search.name]

    def search(*_: object, means: bytes | None = None, **__: object) -> SimpleNamespace:
        return SimpleNamespace(name="usual" if means is None else "other", nbest=lambda: ())

    monkeypatch.setattr(stop_decoder, "make_search", search)
    monkeypatch.setattr(stop_decoder, "add_model", lambda *_: None)
    monkeypatch.setattr(pocketsphinx_search, "best_path", best_path)
    known = {"stop": ("S T AA P",), "the": ("DH AH",)}
    decoder = StopDecoder(["stop"], [], {"the": 1.0}, known, means=(None, b""))
    return decoder.hear(bytes(RATE)), used


def test_sound_that_fits_is_decoded_once(monkeypatch: pytest.MonkeyPatch) -> None:
    assert heard_with(monkeypatch, FITS, 0.0) == (HeardStop(), ["usual"])


def test_a_certain_stop_is_not_decoded_again(monkeypatch: pytest.MonkeyPatch) -> None:
    heard = heard_with(monkeypatch, BADLY, 0.0, "stop the robot")
    assert heard == (HeardStop("stop the robot", sure=True), ["usual"])


@pytest.mark.parametrize(
    ("better", "stops", "unlike"), [(0.2, True, True), (0.05, True, False), (-0.2, False, False)]
)
def test_sound_that_fits_badly_is_heard_with_the_means_that_fit_better(
    monkeypatch: pytest.MonkeyPatch, better: float, stops: bool, unlike: bool
) -> None:
    heard, used = heard_with(monkeypatch, BADLY, BADLY + better)
    assert heard == (HeardStop("hey stop", sure=True, unlike=unlike) if stops else HeardStop())
    assert used == ["usual", "other"]


def unlike_voice(usual: str, other: str, stop: str = "") -> AcousticEvidence:
    """Return the evidence of words that both searches hear clearly."""
    heard = OtherHearing(other, "", 0.5, ())
    return AcousticEvidence(usual, "", 0.5, 1.0, 1.0, stop, (), heard)


@pytest.mark.parametrize(
    ("usual", "other", "sure"),
    [
        ("a bell of choke", "tell a joke", False),
        ("tell a joke", "tell a joke", True),
        ("please tell a joke", "tell a joke", True),  # the same command
        ("call number", "tell a joke", False),
        ("stop the robot", "tell a joke", False),
    ],
)
def test_requests_of_unlike_voices_are_sure_only_if_both_means_agree(
    usual: str, other: str, sure: bool
) -> None:
    said = understand(unlike_voice(usual, other), BOOK, USUAL)
    assert isinstance(said, Say)
    assert [command.behaviour for command in said.commands or ()] == ["joke"]
    assert said.sure == sure


@pytest.mark.parametrize("usual", ["under that", "tell a joke"])
def test_other_means_alone_do_not_steer(usual: str) -> None:
    assert understand(unlike_voice(usual, "undo that"), BOOK, USUAL) == Say("undo that", 0.0, ())
    steered = understand(unlike_voice("undo that", "undo that"), BOOK, USUAL)
    assert steered == Say("undo that", 1.0, None)


@pytest.mark.parametrize(
    ("usual", "stop", "stops"),
    [("some body", "", False), (STOPPING, "", True), ("some body", STOPPING, True)],
)
def test_words_of_unlike_voices_stop_only_if_another_search_hears_a_stop(
    usual: str, stop: str, stops: bool
) -> None:
    said = understand(unlike_voice(usual, STOPPING, stop), BOOK, USUAL)
    assert said == (StopCommand(STOPPING) if stops else Say(STOPPING, 0.0, ()))


def test_each_phone_and_stream_has_its_own_transform() -> None:
    means = np.random.default_rng(0).normal(size=(PHONES, STREAMS, 2, SIZE))
    transforms = np.zeros((PHONES, STREAMS, SIZE, 1 + SIZE))
    transforms[..., 1:] = np.eye(SIZE)
    transforms[7, 1] = 0
    transforms[7, 1, 0, 0] = 3.0  # the constant of the first feature
    transforms[7, 1, 2, 1 + 4] = 2.0  # the third feature is twice the fifth
    moved = transformed(means, transforms)
    assert np.allclose(np.delete(moved, 7, 0), np.delete(means, 7, 0))
    assert np.allclose(moved[7, [0, 2]], means[7, [0, 2]])
    assert np.allclose(moved[7, 1, :, [0, 2, 3]].T, np.c_[[3, 3], 2 * means[7, 1, :, 4], [0, 0]])


def test_silence_and_noises_keep_their_means() -> None:
    import pocketsphinx

    path = Path(pocketsphinx.get_model_path(other_voices.MODEL))
    _, usual = other_voices.read_means(path.read_bytes())
    _, moved = other_voices.read_means(moved_means() + bytes(4))
    same = [phone for phone in range(PHONES) if np.allclose(usual[phone], moved[phone], atol=0.05)]
    assert len(same) == 3
    assert np.abs(moved - usual).max() < 200


def test_the_voice_of_a_person_moves_all_phones_but_noises_and_silence() -> None:
    transform = np.zeros((STREAMS, SIZE, 1 + SIZE))
    transform[..., 1:] = np.eye(SIZE)
    transform[0, 0, 0] = 3.0
    voice = voice_text("usual", transform)
    assert is_voice(voice)
    first, second = both_means(voice)
    assert first is not None and second is None
    _, moved = other_voices.read_means(first + bytes(4))
    usual = base_means("usual")
    apart = moved - usual
    assert np.allclose(apart[:, 1:], 0, atol=1e-3)
    assert np.allclose(apart[list(NO_SPEECH)], 0, atol=1e-3)
    assert np.allclose(np.delete(apart, NO_SPEECH, 0)[:, 0, :, 0], 3.0, atol=1e-3)


def test_without_a_voice_the_second_means_are_those_of_other_voices() -> None:
    assert both_means("") == (None, moved_means())
    with pytest.raises(ValueError, match="no voice"):
        both_means("usual AAAA")


def formant_sound(text: str, voice: str, folder: Path) -> bytes:
    """Return what a voice of espeak says, as a microphone records it."""
    path = folder / "said.wav"
    subprocess.run(["espeak-ng", "-v", voice, "-w", str(path), text], check=True)  # noqa: S603, S607
    samples = np.frombuffer(read_wav(path), "<i2").astype(float)
    noise = np.random.default_rng(0).normal(0, 8, len(samples) + RATE // 2)
    noise[RATE // 4 : -RATE // 4] += samples
    return noise.astype("<i2").tobytes()


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("espeak-ng") is None, reason="needs espeak-ng")
def test_requests_of_a_formant_voice_are_offered_and_sure_once_it_is_known(tmp_path: Path) -> None:
    read = [one.text for one in to_say(BOOK, Lexicon(BOOK))]
    texts = [spoken(words_of(text)) for text in read]
    known = [
        KnownSound(formant_sound(said, FORMANT_VOICE, tmp_path), text)
        for said, text in zip(read, texts, strict=True)
    ]
    voice = voice_of(known, spelt(texts, BOOK.pronunciations()))
    assert is_voice(voice)
    assert voice_of(known[:FEWEST], spelt(texts, {})) != voice
    assert not voice_of(known[: FEWEST - 1], spelt(texts, {}))
    sound = formant_sound(REQUEST, FORMANT_VOICE, tmp_path)
    sure = {}
    for settings in (USUAL, replace(USUAL, voice=voice)):
        decoder = make_decoder(wanted(BOOK, settings))
        try:
            said = understand(decoder.decode(sound, "commands"), BOOK, settings)
        finally:
            decoder.close()
        assert isinstance(said, Say)
        assert [command.behaviour for command in said.commands or ()][:1] == ["call number"]
        sure[settings.voice] = said.sure
    assert sure == {"": False, voice: True}


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("espeak-ng") is None, reason="needs espeak-ng")
def test_a_formant_voice_stops_the_robot(tmp_path: Path) -> None:
    decoder = make_decoder(wanted(BOOK, USUAL))
    said = {}
    try:
        for text, voice in FORMANT_STOPS:
            said[text] = decoder.decode(formant_sound(text, voice, tmp_path), "commands").stop
    finally:
        decoder.close()
    assert all(said.values()), said
