"""Extensions: other packages add drivers, activities and methods without changing our code."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import venv
import zipfile
from base64 import urlsafe_b64encode
from pathlib import Path

import pytest

from tangy_profiles.activity import shipped_activities
from tangy_profiles.robot import load_robot

pytestmark = pytest.mark.slow

RADIO = '''
"""A voice that keeps what it is to say in a file."""

from pathlib import Path

from tangy_hw.drivers.registry import DriverKind
from tangy_profiles.health import OK, Reading


class Radio:
    def __init__(self, name, file):
        self.name, self._file = name, file

    async def start(self):
        self._file.write_text("")

    async def close(self):
        pass

    def reading(self):
        return Reading(self.name, 0.0, OK)

    async def say(self, text):
        self._file.write_text(self._file.read_text() + text)

    async def play(self, sound):
        pass

    async def hush(self):
        pass


def opens(wiring, settings):
    return Radio(settings.device, Path(settings.text("file")))


KIND = DriverKind(("voice",), opens)
NO_KIND = "radio"
'''

TURNS = '''
"""A method that uses the strategies in turn."""

from tangy_tui.interaction.methods import BetaBernoulliMethod


class Turns(BetaBernoulliMethod):
    words = "each in turn"

    def scores(self, beliefs, rng):
        return {name: -float(belief.trials) for name, belief in beliefs.items()}


class Half:
    words = "half a method"
'''

POINTS = """
[tangy.drivers]
radio = tangy_radio.driver:KIND
scip = tangy_radio.driver:KIND
static = tangy_radio.driver:NO_KIND
[tangy.activities]
lotto = tangy_radio
keno = tangy_radio
tombola = tangy_radio
[tangy.methods]
turns = tangy_radio.turns:Turns
half = tangy_radio.turns:Half
gone = tangy_radio.nowhere:Method
"""


def wheel(folder: Path) -> Path:
    """Build the wheel of a small package, as with any build tool."""
    lotto = shipped_activities()["bingo"].read_text(encoding="utf-8")
    info = "tangy_radio-1.2.dist-info"
    files = {
        "tangy_radio/__init__.py": "",
        "tangy_radio/driver.py": RADIO,
        "tangy_radio/turns.py": TURNS,
        "tangy_radio/lotto.toml": lotto.replace('name = "bingo"', 'name = "lotto"', 1),
        "tangy_radio/tombola.toml": lotto,
        f"{info}/METADATA": "Metadata-Version: 2.1\nName: tangy-radio\nVersion: 1.2\n",
        f"{info}/WHEEL": "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
        f"{info}/entry_points.txt": POINTS,
    }
    rows = []
    path = folder / "tangy_radio-1.2-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as packed:
        for name, text in files.items():
            packed.writestr(name, text)
            digest = urlsafe_b64encode(hashlib.sha256(text.encode()).digest()).rstrip(b"=")
            rows.append(f"{name},sha256={digest.decode()},{len(text.encode())}")
        packed.writestr(f"{info}/RECORD", "\n".join([*rows, f"{info}/RECORD,,", ""]))
    return path


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The Python of a temporary environment with Tangy and that package."""
    folder = tmp_path_factory.mktemp("others")
    venv.create(folder / "env", with_pip=False)
    python = folder / "env" / "bin" / "python"
    (site,) = (folder / "env" / "lib").glob("python3*/site-packages")
    ours = [path for path in sys.path if path and Path(path).is_dir()]
    (site / "tangy.pth").write_text("\n".join([str(Path(__file__).parents[2]), *ours]))
    command = [sys.executable, "-m", "pip", "install", "--no-deps", "--no-index", "--quiet"]
    command += ["--disable-pip-version-check", "--target", str(site), str(wheel(folder))]
    subprocess.run(command, check=True, capture_output=True)  # noqa: S603 - our own wheel
    return python


def tangy(python: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    program = "from tangy_tui.cli import main; main()"
    return subprocess.run(  # noqa: S603 - that environment's own Python
        [python, "-c", program, *map(str, arguments)],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"},
    )


def test_doctor_lists_extensions_and_their_problems(installed: Path, tmp_path: Path) -> None:
    done = tangy(installed, "doctor", "--json", "--data", tmp_path)
    found = {one["part"]: (one["state"], one["text"]) for one in json.loads(done.stdout)}
    well = ("ok", "of tangy-radio 1.2 can be used.")
    assert found["driver radio"] == found["activity lotto"] == well
    assert found["method of persuasion turns"] == well
    for part, words in (
        ("driver scip", "this name is taken; ours is used."),
        ("driver static", "is not a DriverKind"),
        ("activity keno", "has no keno.toml"),
        ("activity tombola", "name = 'bingo'"),
        ("method of persuasion half", "has no forgets"),
        ("method of persuasion gone", "cannot be loaded"),
    ):
        state, text = found[part]
        assert state == "broken" and words in text, part


def test_a_driver_of_another_package_is_opened(installed: Path, tmp_path: Path) -> None:
    said = tmp_path / "said.txt"
    body = load_robot().file.read_text(encoding="utf-8")
    mine = tmp_path / "mine.toml"
    mine.write_text(f'{body}\n[drivers]\nvoice = {{ kind = "radio", file = "{said}" }}\n')
    done = tangy(installed, "doctor", "--robot", mine, "--json", "--data", tmp_path)
    (voice,) = (one for one in json.loads(done.stdout) if one["part"] == "Tangy's voice")
    assert voice["ok"] and said.exists()
    mine.write_text(f'{body}\n[drivers]\nvoice = {{ kind = "static" }}\n')
    done = tangy(installed, "doctor", "--robot", mine, "--json", "--data", tmp_path)
    (voice,) = (one for one in json.loads(done.stdout) if one["part"] == "Tangy's voice")
    assert not voice["ok"] and "is not a DriverKind" in voice["text"]


def test_an_activity_of_another_package_is_found_by_name(installed: Path, tmp_path: Path) -> None:
    listed = tangy(installed, "activity", "list", "--json")
    assert {"bingo", "lotto"} <= {one["name"] for one in json.loads(listed.stdout)}
    done = tangy(installed, "activity", "phrases", "lotto", "--data", tmp_path)
    assert "call a number" in done.stdout, done.stderr
    wrong = tangy(installed, "policy", "--activity", "lottto", "--data", tmp_path)
    assert (wrong.returncode, "did you mean 'lotto'?" in wrong.stderr) == (2, True)


def test_a_method_of_another_package_can_be_chosen_for_a_person(
    installed: Path, tmp_path: Path
) -> None:
    done = tangy(installed, "people", "method", "user1", "turns", "--data", tmp_path)
    assert done.returncode == 0, done.stderr
    shown = tangy(installed, "people", "show", "user1", "--data", tmp_path)
    assert "each in turn" in shown.stdout
    without = tangy(Path(sys.executable), "people", "show", "user1", "--data", tmp_path)
    assert without.returncode == 0 and "turns" in without.stderr


def test_a_method_of_another_package_is_named_and_compared(installed: Path, tmp_path: Path) -> None:
    told = tangy(installed, "people", "method", "--help")
    assert all(name in told.stdout for name in ("thompson", "bayes-ucb", "turns"))
    page = tmp_path / "page.html"
    chosen = ("--people", 8, "--json", "--jobs", 1, "--report", page, "--data", tmp_path)
    done = tangy(installed, "experiment", "2", *chosen)
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert set(document["not_compared"]) == {"half", "gone"}
    for crowd in ("algorithms", "uneven", "drifting"):
        assert document[crowd]["turns"]["method"] == "turns"
        assert document[crowd]["turns"]["n"] == document[crowd]["thompson"]["n"]
    assert "turns" in page.read_text(encoding="utf-8")
