"""`tangy doctor`: the parts of a machine that work, are missing, or are broken."""

from __future__ import annotations

import os
import socket
import stat
from collections.abc import Callable
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tangy_hw.audio.arecord import list_microphones
from tangy_hw.audio.wav import SoundError
from tangy_hw.drivers.chest_pairing import keep_pairing
from tangy_hw.robot_process import isolated_test
from tangy_hw.robot_process.self_test import SelfTestResult
from tangy_profiles import log_file
from tangy_profiles.activity import load_activity
from tangy_profiles.process_log import LEVEL
from tangy_profiles.robot import load_robot
from tangy_profiles.store import Store
from tangy_tui.doctor import Finding, examine, examine_contacts, examine_robot
from tangy_tui.text.maps import recorded_words
from tests.hw.speakers import Speaker, program


def data_folder(folder: Path) -> Finding:
    """Return the finding about a data folder."""
    return next(f for f in examine(folder, lambda _: None) if f.part == "data folder")


def test_an_uninstalled_program_is_missing_and_not_broken(tmp_path: Path) -> None:
    states = {f.part: f.state for f in examine(tmp_path, lambda _: None)}
    parts = ("voice", "sound output", "microphone")
    assert {states[part] for part in parts} == {"missing"}


def test_the_voice_is_tested_and_not_only_found(tmp_path: Path) -> None:
    speaker = Speaker(tmp_path / "speaker")

    def voice() -> Finding:
        return next(f for f in examine(tmp_path, speaker.which) if f.part == "voice")

    assert voice() == Finding("voice", True, "Tangy can speak, with espeak-ng 9.9.")
    program(speaker.path, "echo 'no data here' >&2; exit 1")
    assert (voice().state, "failed: no data here;" in voice().text) == ("broken", True)


def test_a_player_without_a_sound_card_is_no_sound_output(tmp_path: Path) -> None:
    player = program(tmp_path / "aplay", "echo 'aplay: main:831: no card' >&2; exit 1")

    def output() -> Finding:
        found = examine(tmp_path, {"aplay": str(player)}.get)
        return next(f for f in found if f.part == "sound output")

    assert output().state == "missing"
    assert output().text.endswith("(no card); what Tangy says is shown as text.")
    program(player, "exit 0")
    assert output() == Finding("sound output", True, "aplay plays what Tangy says.")


LISTED = """**** List of CAPTURE Hardware Devices ****
card 1: PCH [HDA Intel PCH], device 0: ALC257 Analog [ALC257 Analog]
card 2: Mic [USB Microphone], device 0: USB Audio [USB Audio]"""


@pytest.mark.parametrize(
    ("does", "state", "says"),
    [
        (f"echo '{LISTED}'", "ok", "HDA Intel PCH, USB Microphone can be used"),
        ("echo 'arecord: device_list:274: no soundcards found...' >&2", "missing", "plug one in"),
        ("echo '**** List of CAPTURE Hardware Devices ****'", "missing", "tangy mic --help"),
    ],
    ids=["two", "no cards", "cards that only play"],
)
def test_a_recorder_is_no_microphone(tmp_path: Path, does: str, state: str, says: str) -> None:
    recorder = tmp_path / "arecord"
    recorder.touch(mode=0o755)
    recorder.write_text(f"#!/bin/sh\n{does}\n")
    (found,) = (f for f in examine(tmp_path, lambda _: str(recorder)) if f.part == "microphone")
    assert (found.state, says in found.text) == (state, True), found.text


def test_a_recorder_that_cannot_start_is_broken(tmp_path: Path) -> None:
    with pytest.raises(SoundError, match="install alsa-utils anew"):
        list_microphones(str(tmp_path / "none"))


def test_missing_access_to_the_sound_cards_is_reported(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "controlC0").touch()
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(SoundError, match="join the group audio"):
        list_microphones("arecord", tmp_path)


def test_a_valid_or_new_data_folder_is_ok(tmp_path: Path) -> None:
    Store.open(tmp_path).close()
    assert data_folder(tmp_path) == Finding("data folder", True, f"{tmp_path} is sound.")
    new = tmp_path / "a" / "b"
    found = data_folder(new)
    assert found.state == "ok"
    assert "is made as soon as there is something to keep" in found.text
    assert not new.exists(), "looking makes nothing"


def test_a_log_of_an_older_version_is_ok(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(log_file, "MIGRATIONS", log_file.MIGRATIONS[:1])
        Store.open(tmp_path).close()
    held, _ = log_file.hold(tmp_path / "tangy.lock")
    assert data_folder(tmp_path) == Finding("data folder", True, f"{tmp_path} is sound.")
    held.close()
    assert data_folder(tmp_path) == Finding("data folder", True, f"{tmp_path} is sound.")


def test_a_damaged_log_is_broken(tmp_path: Path) -> None:
    (tmp_path / "tangy.db").write_bytes(b"no log at all" * 1000)
    found = data_folder(tmp_path)
    assert (found.ok, found.state) == (False, "broken")
    assert "tangy.db" in found.text


def test_a_data_folder_that_is_no_folder_is_broken(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    for path, why in ((file, "is no folder"), (file / "in" / "it", "cannot be made, for ")):
        found = data_folder(path)
        assert found.state == "broken"
        assert why in found.text
        assert found.text.endswith("choose another folder with --data.")


def test_an_unwritable_data_folder_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: Path(path) != tmp_path)
    for path in (tmp_path, tmp_path / "new" / "one"):
        found = data_folder(path)
        assert found.state == "broken"
        assert "cannot be written to" in found.text
    assert not (tmp_path / "new").exists()


def test_an_unreadable_data_folder_is_broken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    exists = Path.exists

    def barred(path: Path) -> bool:
        if tmp_path in path.parents:
            raise PermissionError
        return exists(path)

    monkeypatch.setattr(Path, "exists", barred)
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    assert data_folder(tmp_path / "new").state == "broken"


@pytest.mark.slow
def test_the_devices_of_a_robot_are_tested_and_undriven_ones_missing(tmp_path: Path) -> None:
    robot = tmp_path / "mine.toml"
    driver = 'laser = { kind = "scip", at = "/dev/no-such-port" }'
    shipped = load_robot().file.read_text(encoding="utf-8")
    robot.write_text(f"{shipped}\n[drivers]\n{driver}\n", encoding="utf-8")
    found = {
        one.part: one
        for one in examine_robot(load_robot(str(robot)), load_activity("bingo"), {}, 0.3)
    }
    laser = found["Tangy's laser scanner"]
    assert (laser.state, "/dev/no-such-port cannot be opened" in laser.text) == ("broken", True)
    assert found["Tangy's wheels"].state == "broken"  # named drivers, but no base
    assert found["Tangy's arms"].state == "missing"


@pytest.mark.slow
def test_the_code_of_the_chest_screen_is_shown_and_constant(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(LEVEL, "INFO")
    monkeypatch.delenv(LEVEL)
    file, folder = tmp_path / "mine.toml", tmp_path / "data"
    shipped = load_robot().file.read_text(encoding="utf-8")
    file.write_text(f'{shipped}\n[drivers]\nscreen = {{ kind = "page", port = 0 }}\n')
    robot, activity = load_robot(str(file)), load_activity("bingo")

    def told() -> Finding:
        found = examine_robot(robot, activity, {}, 0.1, folder=folder)
        return next(one for one in found if one.part == "Tangy's chest screen")

    first, second = told(), told()
    codes = {one.text.partition("the code that pairs it is ")[2] for one in (first, second)}
    assert codes == {f"{keep_pairing(folder).shown}."}
    assert first.state == "missing" and "http://127.0.0.1:" in first.text
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert capfd.readouterr().err == ""  # the page's process logs nothing among the findings


def test_a_requested_broken_part_sets_the_exit_status(
    tangy: Callable[..., CompletedProcess[str]], tmp_path: Path
) -> None:
    data = ("--data", tmp_path / "data")
    assert tangy("doctor", *data).returncode == 0, "what is missing, Tangy does without"
    with socket.socket() as closed:  # bound, but not listening: nobody else can take the port
        closed.bind(("127.0.0.1", 0))
        shipped = load_robot().file.read_text(encoding="utf-8")
        laser = f'laser = {{ kind = "scip", at = "tcp://127.0.0.1:{closed.getsockname()[1]}" }}'
        robot = tmp_path / "robot.toml"
        robot.write_text(f"{shipped}\n[drivers]\n{laser}\n", encoding="utf-8")
        done = tangy("doctor", "--robot", robot, *data)
    assert done.returncode == 1
    assert "broken   Tangy's laser scanner" in done.stdout


def test_a_robot_that_works_does_not_set_the_exit_status(
    tangy: Callable[..., CompletedProcess[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def works(*_: object, **__: object) -> list[SelfTestResult]:
        return [
            SelfTestResult("laser", True, "mine works."),
            SelfTestResult("arms", False, "", True),
        ]

    monkeypatch.setattr(isolated_test, "try_robot_apart", works)
    done = tangy("doctor", "--robot", "tangy", "--data", tmp_path / "data")
    assert "ok       Tangy's laser scanner: mine works." in done.stdout
    assert done.returncode == 0


def test_a_robot_that_calls_nobody_tells_what_to_add() -> None:
    texts = {one.part: (one.state, one.text) for one in examine_contacts(load_robot())}
    assert texts["Tangy's staff"][0] == "missing"
    assert "add [staff] to the robot's file" in texts["Tangy's staff"][1]


@pytest.mark.parametrize(("scans", "says"), [(1, "1 scan recorded"), (2, "2 scans recorded")])
def test_one_recorded_scan_is_no_plural(scans: int, says: str) -> None:
    assert recorded_words(scans, 0.0).startswith(f"{says},")
