"""`tangy listen` and `tangy mic check`: results, and refusals in one sentence."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from subprocess import CompletedProcess
from typing import Any

import numpy as np
import pytest

from tangy_hw.audio.meter import NO_SOUND_SECONDS
from tangy_profiles.people_records import MicrophoneChecked
from tangy_profiles.store import Store
from tangy_tui.app.workspace import Workspace, data_folder
from tangy_tui.speech import transcription
from tangy_tui.speech.calibration import CalibrationResult, SeparationCounts
from tangy_tui.speech.evidence import RATE, DecoderVocabulary, EvidenceSettings
from tangy_tui.speech.loudness import LOUD, loudness
from tangy_tui.speech.microphone_check import PATIENCE, CheckResult, MicrophoneCheck
from tangy_tui.speech.other_voices import SIZE, STREAMS, voice_text
from tangy_tui.speech.recogniser import Recogniser
from tangy_tui.speech.recordings import consent, consented
from tangy_tui.text.command_line import WHAT_TO_LISTEN_TO
from tangy_tui.verbs import hearing, mic_check
from tangy_tui.verbs.mic_check import ALONE
from tests.hw.sounds import pcm, tone, wav
from tests.support.append_body import append_body

VOICE = voice_text("usual", np.zeros((STREAMS, SIZE, 1 + SIZE)))
Tangy = Callable[..., CompletedProcess[str]]
Tell = Callable[[int, list[dict[str, Any]]], None]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ((), WHAT_TO_LISTEN_TO),
        (("a.wav", "--bench", "."), WHAT_TO_LISTEN_TO),
        (("a.wav", "--text", "said.txt"), WHAT_TO_LISTEN_TO),
        (("--text", "nowhere.txt"), "nowhere.txt: there is no such file."),
        (("--bench", "nowhere"), "nowhere: there is no such folder."),
        (("a.wav", "--mode", "papr"), "--mode 'papr' is not known; did you mean 'paper'?"),
        (("nowhere.wav",), "nowhere.wav: there is no such file."),
    ],
)
def test_an_unusable_recording_is_refused_in_one_sentence(
    arguments: tuple[str, ...], sentence: str, tangy: Tangy, tmp_path: Path
) -> None:
    done = tangy("listen", *arguments, "--data", tmp_path / "data")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"tangy: {sentence}\n"
    assert not (tmp_path / "data").exists()


def test_each_line_of_text_is_understood_like_speech(tangy: Tangy, tmp_path: Path) -> None:
    said = tmp_path / "said.txt"
    said.write_text("call the next number\nGo to user 2\n\nthe soup was salty\nstop the robot\n")
    done = tangy("listen", "--text", said, "--json", "--data", tmp_path / "data")
    rows = json.loads(done.stdout)
    assert [row["tier"] for row in rows] == ["sure", "sure", "nothing", "nothing", "stop"]
    assert [row["behaviour"] for row in rows[:2]] == ["call number", "navigate to user"]
    assert rows[1]["arguments"] == {"user": "user2"}
    assert rows[1]["choices"][0] == {
        "behaviour": "navigate to user",
        "arguments": {"user": "user2"},
    }
    assert all(
        {"file", "heard", "tier", "behaviour", "arguments", "confidence", "choices"} == row.keys()
        for row in rows
    )


def test_lines_of_text_are_reported_in_words(tangy: Tangy, tmp_path: Path) -> None:
    said = tmp_path / "said.txt"
    said.write_text("tell a joke")
    done = tangy("listen", "--text", said, "--data", tmp_path / "data")
    assert done.stdout.startswith("'tell a joke' -> tell a joke, ")


def test_an_empty_folder_explains_how_to_name_recordings(tangy: Tangy, tmp_path: Path) -> None:
    (tmp_path / "set").mkdir()
    done = tangy("listen", "--bench", tmp_path / "set", "--data", tmp_path / "data")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "call_number-1.wav" in done.stderr


@pytest.mark.parametrize(
    ("files", "says"),
    [
        (["joke.wav"], "its one recording cannot be heard; joke.wav is not a WAV file."),
        (["joke-1.wav", "joke-2.wav"], "none of its 2 recordings can be heard; "),
    ],
)
def test_a_folder_without_usable_recordings_is_refused(
    files: list[str], says: str, tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def start(self: Recogniser, wanted: DecoderVocabulary) -> None:
        """Start nothing: there is nothing to decode."""

    monkeypatch.setattr(Recogniser, "start", start)
    for name in files:
        (tmp_path / name).write_text("no sound")
    (tmp_path / "notes.txt").write_text("x")
    done = tangy("listen", "--bench", tmp_path, "--data", tmp_path / "data")
    assert (done.returncode, done.stdout) == (2, "")
    assert says in done.stderr


def test_lines_show_the_tier_and_the_choices(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    go = {"behaviour": "navigate to user", "arguments": {"user": "user2"}}
    joke = {"behaviour": "joke", "arguments": {}}
    rows = [
        {"file": name, "heard": "x", "tier": tier, "confidence": 0.5, "choices": choices}
        for name, tier, choices in (
            ("a.wav", "sure", [go]),
            ("b.wav", "unsure", [joke, go]),
            ("c.wav", "nothing", []),
            ("d\x1b.wav", "stop", []),
        )
    ]
    printed: list[str] = []

    def hear(files: object, book: object, settings: object, tell: Tell) -> list[dict[str, Any]]:
        for done, row in enumerate(rows, 1):
            tell(done, [row])
            assert len(printed) == done, "each is printed as soon as it was heard"
        return rows

    def line(text: str) -> None:
        printed.append(text)
        print(text)

    monkeypatch.setattr("tangy_tui.verbs.listen.print_line", line)

    monkeypatch.setattr(transcription, "listen", hear)
    tangy("people", "rename", "user2", "Rosa", "--data", tmp_path / "data")
    done = tangy("listen", "a.wav", "--data", tmp_path / "data")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        "a.wav: 'x' -> go to the user (Rosa), 50% sure",
        "b.wav: 'x' -> perhaps tell a joke or go to the user (Rosa), 50% sure",
        "c.wav: 'x' -> not understood",
        "d\N{REPLACEMENT CHARACTER}.wav: 'x' -> stop, at once",
    ]


def test_progress_is_shown_only_on_a_terminal(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[int, int]] = []

    @contextmanager
    def progress() -> Iterator[Callable[[int, int], None]]:
        yield lambda done, of: seen.append((done, of))

    def hear(files: list[Path], book: object, settings: object, tell: Tell) -> list[object]:
        for done, _ in enumerate(files, 1):
            tell(done, [])
        return []

    monkeypatch.setattr(transcription, "listen", hear)
    monkeypatch.setattr("tangy_tui.verbs.listen.told_progress", progress)
    done = tangy("listen", "a.wav", "b.wav", "--json", "--data", tmp_path / "data")
    assert json.loads(done.stdout) == []
    assert seen == [(1, 2), (2, 2)]


def test_a_truncated_file_is_decoded_and_reported(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(transcription, "listen", lambda files, book, settings, tell: [])
    whole, cut = tmp_path / "whole.wav", tmp_path / "cut.wav"
    whole.write_bytes(wav(pcm(tone(1.0))))
    cut.write_bytes(wav(pcm(tone(1.0)))[:-16_000])
    done = tangy("listen", whole, cut, cut, "--data", tmp_path / "data")
    assert done.returncode == 0
    assert done.stderr == f"tangy: {cut}: ends 0.5 s early; what is there was heard.\n"


def test_default_settings_of_an_unchecked_microphone_are_reported(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(transcription, "listen", lambda files, book, settings, tell: [])
    folder = tmp_path / "two words"
    told = tangy("listen", "a.wav", "--mic", "arecord", "--data", folder).stderr
    assert told.count("\n") == 1
    assert "arecord was never checked, so the usual settings are used: " in told
    assert told.endswith(f": tangy mic check --mic arecord --data '{folder}'\n")
    assert not tangy("listen", "a.wav", "--data", folder).stderr
    with Store.open(folder) as store:
        body = {"source": "arecord", "settings": {"garbage": 0.9, "shift": 0.5}}
        append_body(store, "microphone checked", body)
    assert not tangy("listen", "a.wav", "--mic", "arecord", "--data", folder).stderr
    assert (
        "socket was never" in tangy("listen", "a.wav", "--mic", "socket", "--data", folder).stderr
    )


@pytest.mark.parametrize(("teacher", "voice"), [("ann", VOICE), ("bob", "")])
def test_the_voice_of_the_teacher_is_used(
    tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, teacher: str, voice: str
) -> None:
    heard: list[str] = []

    def listen(files: object, book: object, settings: EvidenceSettings, tell: object) -> list[Any]:
        heard.append(settings.voice)
        return []

    def ears(mic: str, book: object, *, settings: EvidenceSettings, **_: object) -> None:
        heard.append(settings.voice)

    monkeypatch.setattr(transcription, "listen", listen)
    monkeypatch.setattr("tangy_tui.speech.input.SpeechInput", ears)
    monkeypatch.setenv("USER", teacher)
    with Store.open(tmp_path / "data") as store:
        settings = {"garbage": 0.9, "shift": 0.5, "voice": VOICE}
        body = {"source": "arecord", "settings": settings, "teacher": "ann"}
        append_body(store, "microphone checked", body)
    tangy("listen", "a.wav", "--mic", "arecord", "--data", tmp_path / "data")
    with closing(Workspace(tmp_path / "data")) as workspace:
        hearing.Listening("arecord").ears(workspace, workspace.phrasebook(), teacher, sound=0)
    assert heard == [voice, voice]


def test_the_question_for_consent_explains_how_to_delete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def confirm(question: str, **more: object) -> bool:
        asked.append(question)
        return False

    monkeypatch.setattr(sys.stdin, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.confirm", confirm)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    for folder in (tmp_path / "two words", data_folder(None)):
        workspace = Workspace(folder)
        assert hearing.recorder_for(workspace, "rosa") is None
        workspace.close()
    assert f"`tangy listen --forget-recordings --data '{tmp_path / 'two words'}'`" in asked[0]
    assert "`tangy listen --forget-recordings`" in asked[1]


def test_deleting_recordings_withdraws_consent(tangy: Tangy, tmp_path: Path) -> None:
    folder = tmp_path / "data"
    with Store.open(folder) as store:
        consent(store, "rosa", True)
    sound = folder / "recordings" / "joke" / "20260102T120000-1.wav"
    sound.parent.mkdir(parents=True)
    sound.write_bytes(wav(pcm(tone(0.2))))
    done = tangy("listen", "--forget-recordings", "--json", "--data", folder)
    assert json.loads(done.stdout) == {"deleted": 1, "left": 0}
    assert not sound.parent.parent.exists()
    with Store.open(folder, write=False) as store:
        assert not consented(store, "rosa")


@pytest.mark.parametrize(
    ("recordings", "others", "told"),
    [
        (0, 0, ["0 recordings deleted."]),
        (1, 1, ["1 recording deleted.", "1 other file is left in "]),
        (2, 2, ["2 recordings deleted.", "2 other files are left in "]),
    ],
)
def test_deleted_and_kept_files_are_counted(
    recordings: int, others: int, told: list[str], tangy: Tangy, tmp_path: Path
) -> None:
    folder = tmp_path / "recordings" / "joke"
    folder.mkdir(parents=True)
    for number in range(recordings):
        (folder / f"20260102T120000-{number}.wav").write_bytes(b"")
    for number in range(others):
        (folder / f"mine-{number}.txt").write_bytes(b"")
    done = tangy("listen", "--forget-recordings", "--data", tmp_path)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == len(told)
    assert all(line.startswith(words) for line, words in zip(lines, told, strict=True))


class TestCheckingAMicrophone:
    def test_an_invalid_source_is_refused(self, tangy: Tangy, tmp_path: Path) -> None:
        done = tangy("mic", "check", "--mic", "nowhere.wav", "--data", tmp_path / "data")
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == "tangy: nowhere.wav: there is no such file.\n"

    @pytest.mark.slow
    def test_the_phrases_for_a_recording_are_listed(self, tangy: Tangy, tmp_path: Path) -> None:
        folder = tmp_path / "data"
        lines = tangy("mic", "check", "--list", "--data", folder).stdout.splitlines()
        said = json.loads(tangy("mic", "check", "--list", "--json", "--data", folder).stdout)
        assert lines == [f"{number}. {one['say']}" for number, one in enumerate(said, 1)]
        assert [one["command"] for one in said] == [True] * 6 + [False] * 3
        assert not folder.exists()
        assert "what --list prints" in " ".join(tangy("mic", "check", "--help").stdout.split())

    @pytest.mark.parametrize(
        ("mic", "terminal", "seconds"),
        [
            ("arecord", True, PATIENCE),
            ("-", True, PATIENCE),
            ("socket", False, PATIENCE),
            ("socket:/tmp/mine", False, PATIENCE),
            ("arecord", False, ALONE),
        ],
    )
    def test_the_patience_for_silence_depends_on_the_terminal(
        self, mic: str, terminal: bool, seconds: float, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(sys.stderr, "isatty", lambda: terminal)
        assert mic_check.patience(mic) == seconds
        assert NO_SOUND_SECONDS < ALONE < PATIENCE, "it is said before it is given up"

    @pytest.mark.slow
    @pytest.mark.parametrize(("understood", "status"), [(6, 0), (2, 1)])
    def test_a_failed_check_stores_nothing_and_sets_the_exit_status(
        self,
        understood: int,
        status: int,
        tangy: Tangy,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        figures = SeparationCounts(6, understood, 0, 3, 0)
        chosen = CalibrationResult(EvidenceSettings(garbage=0.9), figures, figures)

        async def run(check: MicrophoneCheck) -> CheckResult:
            return CheckResult(-60.0, -30.0, (), chosen, figures.parted, ())

        monkeypatch.setattr(MicrophoneCheck, "run", run)
        (tmp_path / "a.wav").write_bytes(wav(pcm(tone(0.2))))
        check = ("mic", "check", "--mic", tmp_path / "a.wav", "--data", tmp_path / "data")
        done = tangy(*check)
        assert done.returncode == status
        assert done.stderr == (
            "tangy: Nothing was stored: only 2 of 6 commands were understood.\n" if status else ""
        )
        assert ("stored for" in done.stdout) is not bool(status)
        told = tangy(*check, "--json")
        assert told.returncode == status
        assert json.loads(told.stdout)["stored"] is not bool(status)
        with Store.open(tmp_path / "data", write=False) as store:
            assert any(store.events("microphone checked")) is not bool(status)

    @pytest.mark.slow
    def test_unmeasured_values_are_not_printed_as_figures(
        self, tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        chosen = CalibrationResult(
            EvidenceSettings(), SeparationCounts(6, 5, 0, 0, 0), SeparationCounts(6, 5, 0, 0, 0)
        )
        room = loudness(bytes(2 * RATE), LOUD)  # zeros alone

        async def run(check: MicrophoneCheck) -> CheckResult:
            return CheckResult(room, -17.0, (), chosen, False, ())

        monkeypatch.setattr(MicrophoneCheck, "run", run)
        (tmp_path / "a.wav").write_bytes(wav(pcm(tone(0.2))))
        check = ("mic", "check", "--mic", tmp_path / "a.wav", "--data", tmp_path / "data")
        done = tangy(*check)
        assert "no room noise at all (digital silence)" in done.stdout
        assert " dB" not in done.stdout
        assert "5 of 6 commands understood; no other sentence was heard." in done.stdout
        assert json.loads(tangy(*check, "--json").stdout)["room_db"] is None

    @pytest.mark.slow
    def test_the_voice_is_stored_for_the_teacher_who_spoke(
        self, tangy: Tangy, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        figures = SeparationCounts(6, 6, 0, 3, 0)
        chosen = CalibrationResult(EvidenceSettings(voice=VOICE), figures, figures)

        async def run(check: MicrophoneCheck) -> CheckResult:
            return CheckResult(-60.0, -30.0, (), chosen, True, ())

        monkeypatch.setattr(MicrophoneCheck, "run", run)
        (tmp_path / "a.wav").write_bytes(wav(pcm(tone(0.2))))
        check = ("mic", "check", "--mic", tmp_path / "a.wav", "--data", tmp_path / "data")
        assert "so it has learnt yours" in tangy(*check, "--teacher", "ann").stdout
        with Store.open(tmp_path / "data", write=False) as store:
            (checked,) = (event.record for event in store.events(MicrophoneChecked))
        assert (checked.teacher, checked.settings["voice"]) == ("ann", VOICE)

    def test_forgetting_reports_whether_settings_existed(
        self, tangy: Tangy, tmp_path: Path
    ) -> None:
        folder = tmp_path / "data"
        arguments = ("mic", "check", "--mic", "socket", "--forget", "--data", folder)
        assert tangy(*arguments).stdout == "socket: nothing was stored.\n"
        with Store.open(folder) as store:
            body = {"source": "socket", "settings": {"garbage": 0.9, "shift": 0.5}}
            append_body(store, "microphone checked", body)
        assert tangy(*arguments).stdout == "socket: forgotten.\n"
        assert tangy(*arguments).stdout == "socket: nothing was stored.\n"

    def test_help_explains_the_check_and_what_is_stored(self, tangy: Tangy) -> None:
        done = tangy("mic", "check", "--help")
        assert done.returncode == 0
        said = " ".join(done.stdout.split())
        assert "Be quiet for 3 seconds" in said
        assert "Tangy keeps no sound." in said
        assert "how your voice differs" in said
