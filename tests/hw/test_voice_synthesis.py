"""From text to WAV: rendered once and cached, or refused in a helpful sentence."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tangy_hw.audio.synthesis import (
    ABSENT,
    NoSuchVoice,
    Synthesiser,
    VoiceError,
    examine_voice,
)
from tangy_profiles.voice import VoicePreference
from tangy_profiles.wav_length import wav_seconds
from tests.hw.speakers import Speaker, from_pipe, program

TRICKY = "<speak>-v de &lt;b&gt; &amp; \"q\" 'é' 你好</speak>"


@pytest.fixture
def speaker(tmp_path: Path) -> Speaker:
    return Speaker(tmp_path / "speaker")


@pytest.fixture
def synthesiser(speaker: Speaker, tmp_path: Path) -> Synthesiser:
    return Synthesiser(tmp_path / "cache" / "voice", which=speaker.which)


def kept(synthesiser: Synthesiser) -> list[Path]:
    return sorted(synthesiser.folder.iterdir())


def test_a_text_is_rendered_once(synthesiser: Synthesiser, speaker: Speaker) -> None:
    first = synthesiser.render(TRICKY)
    assert synthesiser.render(TRICKY) == first
    assert kept(synthesiser) == [first]
    assert len(speaker.asked) == 1
    assert wav_seconds(first) == pytest.approx(2.0), "the true length is written into it"


def test_a_text_is_never_parsed_as_an_option(synthesiser: Synthesiser, speaker: Speaker) -> None:
    synthesiser.render(TRICKY)
    assert speaker.heard == [TRICKY]
    assert speaker.asked == ["--stdin --stdout -m -z -b 1 -v en-us -s 140"]


def test_text_voice_rate_and_version_identify_a_cached_file(
    synthesiser: Synthesiser, speaker: Speaker
) -> None:
    made = {
        synthesiser.render(text, preference)
        for text in ("<speak>a</speak>", "<speak>b</speak>")
        for preference in (
            VoicePreference(),
            VoicePreference(100),
            VoicePreference(None, "en-gb+f3"),
            VoicePreference(140, "en-us"),
        )
    }
    assert len(made) == len(speaker.asked) == 6
    text = speaker.path.read_text().replace("9.9", "10.0")
    speaker.path.write_text(text)
    newer = Synthesiser(synthesiser.folder, which=speaker.which)
    assert newer.render("<speak>a</speak>") not in made


def test_cached_speech_is_readable_only_by_its_user(synthesiser: Synthesiser) -> None:
    path = synthesiser.render(TRICKY)
    assert path.stat().st_mode & 0o777 == 0o600
    assert synthesiser.folder.stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("broken", [b"", b"RIFF", from_pipe(0.1), b"\0" * 500])
def test_a_broken_cached_file_is_rendered_again(
    synthesiser: Synthesiser, speaker: Speaker, broken: bytes
) -> None:
    path = synthesiser.render(TRICKY)
    whole = path.read_bytes()
    for content in (broken, whole[:-2]):
        path.write_bytes(content)
        assert synthesiser.render(TRICKY).read_bytes() == whole
    assert len(speaker.asked) == 3


@pytest.mark.parametrize(
    ("voice", "says"),
    [
        ("en-uk", "no voice 'en-uk': did you mean 'en-us'?"),
        ("xyz", "tangy say --voices lists all."),
        ("en-us+f33", "no voice has a variant 'f33': did you mean 'f3'?"),
        ("f3", "no voice 'f3'"),
    ],
)
def test_an_unknown_voice_is_refused(
    synthesiser: Synthesiser, speaker: Speaker, voice: str, says: str
) -> None:
    with pytest.raises(NoSuchVoice) as refused:
        synthesiser.render(TRICKY, VoicePreference(None, voice))
    assert says.lower() in str(refused.value).lower()
    assert not speaker.asked


def test_regional_languages_are_voices_too(synthesiser: Synthesiser) -> None:
    assert synthesiser.voices["en"] == "English (Great Britain)", "the one with the lowest number"
    synthesiser.render(TRICKY, VoicePreference(None, "en+f3"))


def test_a_missing_synthesiser_is_the_reason(tmp_path: Path) -> None:
    synthesiser = Synthesiser(tmp_path / "cache", which=lambda _: None)
    assert synthesiser.reason == ABSENT
    with pytest.raises(VoiceError, match="not installed"):
        synthesiser.render(TRICKY)
    assert not synthesiser.folder.exists()


@pytest.mark.parametrize(
    ("does", "says"),
    [
        ("echo 'no data here' >&2; exit 3", "espeak-ng failed: no data here."),
        ("exit 3", "espeak-ng failed: status 3."),
        ("kill -SEGV $$", "espeak-ng failed: status -11."),
        ("cat", "espeak-ng made no sound of it."),
        ("printf RIFF", "espeak-ng made no sound of it."),
    ],
)
def test_a_failing_synthesiser_is_reported_in_one_sentence(
    speaker: Speaker, tmp_path: Path, does: str, says: str
) -> None:
    synthesiser = Synthesiser(tmp_path / "cache", which=speaker.which)
    assert synthesiser.version == "9.9"
    assert synthesiser.voices
    program(speaker.path, does)
    with pytest.raises(VoiceError) as failed:
        synthesiser.render(TRICKY)
    assert str(failed.value) == says
    assert not synthesiser.folder.exists() or not kept(synthesiser)


def test_a_hanging_synthesiser_is_killed_with_its_children(
    speaker: Speaker, tmp_path: Path
) -> None:
    os.mkfifo(tmp_path / "held")
    held = os.open(tmp_path / "held", os.O_RDONLY | os.O_NONBLOCK)
    program(speaker.path, f"exec 3> '{tmp_path}/held'; sleep 600 & sleep 600")
    synthesiser = Synthesiser(tmp_path / "cache", which=speaker.which, seconds=0.2)
    with pytest.raises(VoiceError, match=r"did not answer in 0\.2 s"):
        synthesiser.render(TRICKY)
    os.set_blocking(held, True)
    assert os.read(held, 1) == b"", "nobody holds the other end any more"
    os.close(held)


def test_a_running_synthesis_can_be_ended(speaker: Speaker, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "started")
    program(speaker.path, f"echo > '{tmp_path}/started'; exec sleep 60")
    synthesiser = Synthesiser(tmp_path / "cache", which=speaker.which)
    failed: list[VoiceError] = []

    def speak() -> None:
        try:
            synthesiser.render(TRICKY)
        except VoiceError as error:
            failed.append(error)

    thread = threading.Thread(target=speak)
    thread.start()
    (tmp_path / "started").read_text()
    synthesiser.end()
    thread.join(10)
    assert len(failed) == 1


def test_an_unwritable_cache_folder_is_reported(speaker: Speaker, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    synthesiser = Synthesiser(tmp_path / "file" / "in it", which=speaker.which)
    with pytest.raises(VoiceError, match="cannot be kept there"):
        synthesiser.render(TRICKY)


def test_the_oldest_files_are_removed_from_a_full_cache(speaker: Speaker, tmp_path: Path) -> None:
    one = 44 + len(from_pipe(2.0)) - 44
    synthesiser = Synthesiser(tmp_path / "cache", which=speaker.which, most_bytes=10 * one)
    made = [synthesiser.render(f"<speak>{n}</speak>") for n in range(10)]
    for age, path in enumerate(reversed(made)):
        os.utime(path, (1e9 - age, 1e9 - age))
    synthesiser.render("<speak>0</speak>")  # used again: it is no longer the oldest
    newest = synthesiser.render("<speak>new</speak>")
    left = set(kept(synthesiser))
    assert sum(path.stat().st_size for path in left) <= 10 * one
    assert {made[0], made[9], newest} <= left
    assert not {made[1], made[2]} & left


def test_unfinished_files_count_and_are_removed_too(speaker: Speaker, tmp_path: Path) -> None:
    synthesiser = Synthesiser(tmp_path / "cache", which=speaker.which, most_bytes=100_000)
    synthesiser.folder.mkdir()
    unfinished = synthesiser.folder / "x.tmp"
    unfinished.write_bytes(bytes(50_000))
    os.utime(unfinished, (1e9, 1e9))
    path = synthesiser.render(TRICKY)
    assert kept(synthesiser) == [path]


def test_cached_speech_with_names_can_be_deleted(synthesiser: Synthesiser) -> None:
    synthesiser.clear()
    synthesiser.render(TRICKY)
    synthesiser.clear()
    assert kept(synthesiser) == []
    assert synthesiser.render(TRICKY).exists()


def test_two_programs_and_many_threads_share_a_folder(speaker: Speaker, tmp_path: Path) -> None:
    room = 3 * len(from_pipe(2.0))  # so that they keep dropping each other's files
    both = [Synthesiser(tmp_path / "c", which=speaker.which, most_bytes=room) for _ in range(2)]

    def speak(number: int) -> float:
        return wav_seconds(both[number % 2].render(f"<speak>{number % 5}</speak>"))

    with ThreadPoolExecutor(4) as threads:
        lengths = list(threads.map(speak, range(40)))
    assert {round(length, 1) for length in lengths} <= {0.0, 2.0}, "whole, or dropped already"
    assert lengths.count(0.0) < 20
    assert not [path for path in (tmp_path / "c").iterdir() if path.suffix == ".tmp"]


@pytest.mark.parametrize(
    ("which", "found"),
    [
        (lambda speaker: speaker.which, ("espeak-ng 9.9", "")),
        (lambda speaker: lambda _: None, ("", ABSENT)),
    ],
)
def test_the_voice_is_tested_with_a_word(
    speaker: Speaker,
    which: Callable[[Speaker], Callable[[str], str | None]],
    found: tuple[str, str],
) -> None:
    assert examine_voice(which(speaker)) == found


def test_a_failing_voice_is_noticed(speaker: Speaker) -> None:
    program(speaker.path, "exit 1")
    named, problem = examine_voice(speaker.which)
    assert named == "espeak-ng"
    assert problem == "espeak-ng failed: status 1; what Tangy says is shown as text."


def test_a_program_that_cannot_start_is_reported(tmp_path: Path) -> None:
    synthesiser = Synthesiser(tmp_path, which=lambda _: str(tmp_path))
    with pytest.raises(VoiceError, match="cannot be started"):
        synthesiser.render(TRICKY)


def test_an_invalid_wav_has_length_zero(tmp_path: Path) -> None:
    (tmp_path / "x.wav").write_bytes(b"RIFF")
    assert wav_seconds(tmp_path / "x.wav") == wav_seconds(tmp_path / "none.wav") == 0.0


def test_an_overlong_text_is_refused(synthesiser: Synthesiser) -> None:
    with pytest.raises(VoiceError, match="5,000 characters"):
        synthesiser.render(f"<speak>{'a' * 5_000}</speak>")
