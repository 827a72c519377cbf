"""A sweep gives the same results with any number of jobs, and resumes after any interruption."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from random import Random
from threading import Thread
from time import monotonic, sleep

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.experiments.sweep import Sweep, Where
from tests.experiments.pieces import draw

CASES = [(number, "a") for number in range(40)]
ROOT = Path(__file__).parent.parent.parent

WORK = """
import sys
from pathlib import Path
from tangy_tui.experiments.sweep import Sweep, Where
from tests.experiments.pieces import draw
sweep = Sweep("drawing", draw, {"salt": 1, "seconds": 0.01}, [(n, "a") for n in range(40)])
print("go", flush=True)
sweep.run(Where(Path(sys.argv[1]), jobs=int(sys.argv[2])))
"""


def sweep(salt: int = 1, seconds: float = 0.0) -> Sweep:
    return Sweep("drawing", draw, {"salt": salt, "seconds": seconds}, CASES)


def the_file(folder: Path) -> Path:
    (file,) = (folder / "experiments").iterdir()
    return file


def test_results_come_in_the_order_of_the_cases_with_any_number_of_jobs(tmp_path: Path) -> None:
    alone = sweep(seconds=0.005).run(Where(jobs=1))
    assert [result["case"][0] for result in alone] == list(range(40))
    assert sweep(seconds=0.005).run(Where(tmp_path, jobs=2)) == alone


def test_finished_cases_are_reported_and_not_repeated(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    where = Where(tmp_path, jobs=1, tell=lambda *words: told.append(words))
    first = sweep().run(where)
    assert told == [("drawing", done, 40) for done in range(41)]
    told.clear()
    kept = the_file(tmp_path).read_bytes()
    assert sweep().run(where) == first
    assert told == [("drawing", 40, 40)]
    assert the_file(tmp_path).read_bytes() == kept


def test_more_cases_reuse_the_finished_ones(tmp_path: Path) -> None:
    few = Sweep("drawing", draw, {"salt": 1, "seconds": 0}, CASES[:5])
    few.run(Where(tmp_path, jobs=1))
    told: list[int] = []
    sweep(seconds=0).run(Where(tmp_path, jobs=1, tell=lambda _, done, __: told.append(done)))
    assert told[0] == 5


def test_other_settings_are_stored_apart_and_fresh_starts_over(tmp_path: Path) -> None:
    sweep(1).run(Where(tmp_path, jobs=1))
    sweep(2).run(Where(tmp_path, jobs=1))
    assert len(list((tmp_path / "experiments").iterdir())) == 2
    told: list[int] = []
    sweep(2).run(Where(tmp_path, 1, fresh=True, tell=lambda _, done, __: told.append(done)))
    assert told[0] == 0


@pytest.mark.parametrize("cut", [1, 7, 30])
def test_only_a_torn_last_line_is_repeated(tmp_path: Path, cut: int) -> None:
    whole = sweep().run(Where(tmp_path, jobs=1))
    file = the_file(tmp_path)
    file.write_bytes(file.read_bytes()[:-cut])
    told: list[int] = []
    again = Where(tmp_path, jobs=1, tell=lambda _, done, __: told.append(done))
    assert sweep().run(again) == whole
    assert told == ([40] if cut == 1 else [39, 40])  # only the line's end was missing
    told.clear()
    assert sweep().run(again) == whole
    assert told == [40]


@pytest.mark.slow
@pytest.mark.parametrize("jobs", [1, 2])
def test_a_killed_sweep_loses_only_running_cases(tmp_path: Path, jobs: int) -> None:
    rng = Random()  # another moment in every run; the law holds for all of them
    for _ in range(3):
        with subprocess.Popen(  # noqa: S603 - our own interpreter
            [sys.executable, "-c", WORK, str(tmp_path), str(jobs)],
            cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, start_new_session=True,
        ) as child:  # fmt: skip
            assert child.stdout is not None and child.stdout.readline() == b"go\n"
            sleep(rng.random() * 0.3)
            os.killpg(child.pid, signal.SIGKILL)
        files = list((tmp_path / "experiments").glob("*"))
        kept = files[0].read_bytes() if files else b""
        for line in kept.split(b"\n")[:-1]:
            json.loads(line)
    assert sweep(seconds=0.01).run(Where(tmp_path, jobs=2)) == sweep(seconds=0.01).run(
        Where(jobs=1)
    )


@pytest.mark.slow
@pytest.mark.parametrize("cores", [1, 2])
def test_ctrl_c_ends_at_once_and_explains_how_to_resume(tmp_path: Path, cores: int) -> None:
    tangy = [sys.executable, "-c", "from tangy_tui.cli import main; main()"]
    words = ["experiment", "1", "--seeds", "200", "--users", "4", "--no-typing"]
    words += ["--jobs", "-1" if cores == 1 else "2"]
    child = subprocess.Popen(  # noqa: S603 - our own interpreter
        [*tangy, *words, "--json", "--data", str(tmp_path)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        env={**os.environ, "LOKY_MAX_CPU_COUNT": str(cores)},
    )  # fmt: skip
    try:
        deadline = monotonic() + 30
        while monotonic() < deadline and not _kept(tmp_path):
            sleep(0.05)
        os.killpg(child.pid, signal.SIGINT)  # a terminal sends it to the whole process group
        begun = monotonic()
        said, complained = child.communicate(timeout=20)
        assert monotonic() - begun < 5
    finally:
        if child.poll() is None:  # it would hold up the following tests
            os.killpg(child.pid, signal.SIGKILL)
            child.communicate()
    assert (child.returncode, said) == (130, "")
    assert complained.count("\n") == 1
    assert "Run the same command again" in complained
    assert _kept(tmp_path)


def _kept(folder: Path) -> bool:
    return any(file.stat().st_size for file in folder.glob("experiments/*.jsonl"))


def test_a_new_folder_is_private(tmp_path: Path) -> None:
    sweep().run(Where(tmp_path / "new" / "data", jobs=1))
    assert (tmp_path / "new" / "data").stat().st_mode & 0o777 == 0o700


def test_an_unusable_folder_is_refused_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "experiments").write_text("a file", encoding="utf-8")
    with pytest.raises(TangyError, match="choose another --data"):
        sweep().run(Where(tmp_path, jobs=1))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--jobs", "0"), "--jobs 0: say how many processes"),
        (("--seeds", "0"), "--seeds"),
        (("--users", "9"), "--users"),
        (("--report", "nowhere/r.html"), "there is no such folder"),
        (("--report", "."), "name a file in it"),
        (("--activity", "chess"), "There is no activity 'chess'"),
        (("--activity", "nowhere.toml"), "nowhere.toml"),
        (("--dask", "tcp://127.0.0.1:1"), "no Dask scheduler answers there"),
        (("--dask", "no address"), "no Dask scheduler answers there"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(
    words: tuple[str, ...], said: str, tangy: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    begun = monotonic()
    done = tangy("experiment", "1", "--no-typing", *words)
    assert (done.returncode, done.stdout) == (2, "")
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert monotonic() - begun < 15


@pytest.mark.parametrize("which", [(), ("1",), ("2",)])
def test_experiments_have_help(
    which: tuple[str, ...], tangy: Callable[..., subprocess.CompletedProcess[str]]
) -> None:
    done = tangy("experiment", *which, "--help")
    assert done.returncode == 0
    assert "Usage: " in done.stdout


@pytest.mark.slow
def test_progress_is_shown_on_a_terminal_and_not_in_the_document(tmp_path: Path) -> None:
    import pty

    mine, theirs = pty.openpty()
    seen = b""

    def watch() -> None:  # else a slow machine's progress fills the terminal and blocks the program
        nonlocal seen
        with suppress(OSError):  # the program has closed it
            while chunk := os.read(mine, 65536):
                seen += chunk

    with subprocess.Popen(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", "from tangy_tui.cli import main; main()", "experiment", "2",
         "--people", "4", "--jobs", "1", "--json", "--data", str(tmp_path)],
        stdout=subprocess.PIPE, stderr=theirs, env={**os.environ, "TERM": "xterm-256color"},
    ) as child:  # fmt: skip
        os.close(theirs)
        watching = Thread(target=watch)
        watching.start()
        try:
            said, _ = child.communicate(timeout=60)
        finally:
            child.kill()
            watching.join()
            os.close(mine)
    assert child.returncode == 0
    assert json.loads(said)["experiment"] == 2
    assert b"persuading" in seen
