"""`tangy say`: spoken if a voice is available, and always printed as text."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_profiles.wav_length import wav_seconds
from tests.hw.speakers import Speaker, program

Tangy = Callable[..., CompletedProcess[str]]
KEYS = {"text", "said", "voice", "rate", "seconds", "sink", "out", "problem"}


@pytest.fixture
def speaker(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Speaker:
    """A machine with a synthesiser, but without a sound card."""
    made = Speaker(tmp_path / "speaker")
    monkeypatch.setenv("PATH", f"{made.path.parent}:/bin:/usr/bin")
    for name in ("aplay", "pw-play", "paplay", "afplay"):
        program(made.path.parent / name, f"echo '{name}: main:8: no card' >&2; exit 1")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return made


@pytest.fixture
def heard(speaker: Speaker, tmp_path: Path) -> Path:
    """Give the machine a sound card; this file records its sound."""
    program(speaker.path.parent / "aplay", f'cat "$2" >> "{tmp_path}/heard"')
    return tmp_path / "heard"


@pytest.fixture
def mute(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine without a synthesiser."""
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_a_text_is_spoken_and_printed(tangy: Tangy, speaker: Speaker, heard: Path) -> None:
    done = tangy("say", "It is B 5 & more <b>.", "--rate", "100", "--voice", "en-gb+f3")
    assert (done.returncode, done.stdout, done.stderr) == (0, "It is B 5 & more <b>.\n", "")
    assert wav_seconds(heard) == 2.0
    assert speaker.asked[0].endswith("-v en-gb+f3 -s 100")
    assert speaker.heard[0].count("B, 5.") == 2
    assert "&amp; more &lt;b&gt;" in speaker.heard[0]


def test_the_json_contains_the_spoken_text(tangy: Tangy, heard: Path, tmp_path: Path) -> None:
    found = json.loads(tangy("say", "O 69", "--json").stdout)
    assert found.keys() == KEYS
    assert (found["text"], found["said"]) == ("O 69", "O, 69. O, 6 9.")
    assert (found["sink"], found["seconds"], found["problem"]) == ("aplay", 2.0, None)


def test_a_wav_is_written_without_playing(tangy: Tangy, heard: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.wav"
    done = tangy("say", "hello", "--out", out, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["out"] == str(out)
    assert wav_seconds(out) == 2.0
    assert not heard.exists()


@pytest.mark.usefixtures("speaker")
@pytest.mark.parametrize(("sink", "status"), [("auto", 0), ("aplay", 1)])
def test_a_missing_sound_card_still_prints_the_text(tangy: Tangy, sink: str, status: int) -> None:
    done = tangy("say", "hello", "--sink", sink)
    assert (done.returncode, done.stdout) == (status, "hello\n")
    assert done.stderr.startswith("tangy: No sound comes out of ")
    assert done.stderr.endswith(": no card.\n")


@pytest.mark.usefixtures("mute")
@pytest.mark.parametrize(
    ("more", "status"),
    [((), 0), (("--json",), 0), (("--out", "x.wav"), 1), (("--sink", "null"), 1)],
)
def test_missing_espeak_still_prints_the_text(
    tangy: Tangy, more: tuple[str, ...], status: int
) -> None:
    done = tangy("say", "hello", *more)
    assert done.returncode == status
    assert "hello" in done.stdout
    assert done.stderr.startswith("tangy: espeak-ng is not installed; ")
    assert done.stderr.count("\n") == 1


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((), "nothing to say"),
        (("  ",), "nothing to say"),
        (("hi", "--rate", "79"), "from 80 to 260"),
        (("hi", "--rate", "x"), "--rate"),
        (("hi", "--voice", "en-uk"), "did you mean 'en-us'?"),
        (("hi", "--voice", "-x"), "cannot be a voice"),
        (("hi", "--sink", "aply"), "did you mean 'aplay'?"),
        (("hi", "--activity", "bingoo"), "did you mean 'bingo'?"),
        (("hi", "--out", "/nowhere/at all/x.wav"), "cannot be written"),
    ],
)
def test_bad_input_is_status_two(tangy: Tangy, arguments: tuple[str, ...], says: str) -> None:
    done = tangy("say", *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("tangy: ")
    assert says in done.stderr


@pytest.mark.usefixtures("speaker")
def test_the_voices_are_listed(tangy: Tangy) -> None:
    listed = tangy("say", "--voices").stdout
    assert "en-us                 English (America)\n" in listed
    assert listed.endswith("as in en-gb+f3: f3.\n")
    found = json.loads(tangy("say", "--voices", "--json").stdout)
    assert {"voice": "de", "title": "German"} in found["voices"]
    assert found["variants"] == ["f3"]


def lines_kept(cache: Path) -> int:
    return len(list(cache.rglob("*.wav")))


@pytest.mark.usefixtures("speaker")
def test_cached_lines_are_deleted_and_counted(tangy: Tangy, tmp_path: Path) -> None:
    assert tangy("say", "--forget").stdout == "0 spoken lines deleted.\n"
    assert not (tmp_path / "cache").exists()
    for text in ("one", "two", "three"):
        tangy("say", text, "--out", tmp_path / "out.wav")
    assert lines_kept(tmp_path / "cache") == 3
    assert json.loads(tangy("say", "--forget", "--json").stdout) == {"deleted": 3}
    assert lines_kept(tmp_path / "cache") == 0


def refused(path: Path, missing_ok: bool = False) -> None:
    raise PermissionError(13, "Permission denied")


@pytest.mark.slow
@pytest.mark.usefixtures("speaker")
def test_renaming_a_person_deletes_cached_speech(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def rename(name: str) -> int:
        return tangy("people", "rename", "user1", name, "--data", tmp_path / "data").returncode

    assert rename("Rosa") == 0
    assert not (tmp_path / "cache").exists()
    tangy("say", "Rosa, it is your turn", "--out", tmp_path / "out.wav")
    assert rename("Rosa") == 0
    assert lines_kept(tmp_path / "cache") == 1, "it is the same name"
    with monkeypatch.context() as patch:
        patch.setattr(Path, "unlink", refused)
        assert rename("Maria") == 0
        assert "cannot be deleted (Permission denied)" in tangy("say", "--forget").stderr
    assert rename("Anna") == 0
    assert lines_kept(tmp_path / "cache") == 0


@pytest.mark.usefixtures("mute")
def test_a_failed_list_of_voices_is_an_error(tangy: Tangy) -> None:
    done = tangy("say", "--voices")
    assert (done.returncode, done.stdout) == (1, "")
    assert "espeak-ng is not installed" in done.stderr
