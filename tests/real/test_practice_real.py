"""Practice and microphone checks through the real decoder, with synthetic voices."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from subprocess import CompletedProcess

import numpy as np
import pytest

from tangy_hw.audio.wav import RATE, read_wav
from tangy_profiles.activity import Activity
from tangy_profiles.person import Person
from tangy_profiles.room import load_room
from tangy_profiles.store import Store
from tangy_tui.app.microphones import settings_for
from tangy_tui.language.commands import Phrasebook
from tangy_tui.language.lexicon import Lexicon
from tangy_tui.speech.microphone_check import to_say
from tests.hw.sounds import wav

pytestmark = pytest.mark.skipif(
    shutil.which("flite") is None, reason="flite is not installed: nobody to speak the commands"
)


def run(program: str, *arguments: object) -> CompletedProcess[str]:
    command = [program, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120)  # noqa: S603


def say(text: str, file: Path) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    run("flite", "-voice", "slt", "-t", text, "-o", file).check_returncode()
    return file


@pytest.mark.slow
def test_a_folder_of_recordings_is_evaluated(tangy: str, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    say("call the next number", folder / "call number" / "slt-001.wav")
    say("tell a joke", folder / "tell a joke-slt.wav")
    say("go to user two", folder / "navigate_to_user-user2-003.wav")
    say("stop", folder / "stop.wav")
    say("the weather is lovely today", folder / "none" / "1.wav")
    done = run(tangy, "listen", "--bench", folder, "--json", "--data", tmp_path / "data")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    document = json.loads(done.stdout)
    assert document["files"] == 5
    assert document["accuracy"] == 1
    assert document["false_accepts"] == {"sure": 0, "offered": 0, "of": 1}
    assert document["confusion"] == {
        "call number": {"call number": 1},
        "joke": {"joke": 1},
        "navigate to user user2": {"navigate to user user2": 1},
        "no command": {"nothing": 1},
        "stop": {"stop": 1},
    }
    assert all(row["latency"] > 0 for row in document["rows"])


@pytest.fixture
def minute(activity: Activity, people: tuple[Person, ...], tmp_path: Path) -> Path:
    """A recording of all sentences of a check, with pauses."""
    book = Phrasebook(activity, load_room().placed(people))
    quiet = bytes(2 * RATE)
    said = [
        read_wav(say(asked.text, tmp_path / "said.wav")) for asked in to_say(book, Lexicon(book))
    ]
    sound = np.frombuffer(quiet * 2 + b"".join(pcm + quiet for pcm in said), "<i2")
    hiss = np.random.default_rng(1).normal(0, 8, len(sound))
    file = tmp_path / "minute.wav"
    file.write_bytes(wav((sound * 0.9 + hiss).astype("<i2").tobytes()))
    return file


@pytest.mark.slow
def test_the_settings_of_a_recorded_check_are_stored_and_used(
    tangy: str, tmp_path: Path, minute: Path
) -> None:
    folder = tmp_path / "data"
    done = run(tangy, "mic", "check", "--mic", minute, "--data", folder)
    assert done.returncode == 0, done.stderr
    assert "6 of 6 commands understood; 0 of 3 other sentences taken for one." in done.stdout
    with Store.open(folder, write=False) as store:
        events = list(store.events("microphone checked"))
        assert len(events) == 1
        assert settings_for(store, str(minute)).mode == "tiers"
    assert not list(folder.glob("**/*.wav"))
