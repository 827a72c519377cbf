"""A sweep on a real Dask scheduler with two workers gives the same results as on this machine."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from time import monotonic, sleep

import pytest

from tangy_profiles.errors import TangyError
from tangy_tui.experiments import cluster
from tangy_tui.experiments.persuading import play
from tangy_tui.experiments.sweep import Sweep, Where

pytestmark = [
    pytest.mark.xdist_group("cluster"),
    pytest.mark.skipif(
        find_spec("distributed") is None,  # so that not every worker imports it
        reason="the extra tangy[cluster] is not installed",
    ),
]

SCHEDULER = ["-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0"]
WORKER = ["-m", "distributed.cli.dask_worker", "--host", "127.0.0.1", "--nthreads", "1"]
PATIENCE = 60.0


class Cluster:
    """A scheduler and its workers as child processes, on the loopback only."""

    def __init__(self, folder: Path, workers: int) -> None:
        self._folder = folder
        self._file = folder / "scheduler.json"
        about = ["--no-dashboard", "--scheduler-file", str(self._file)]
        self.scheduler = self._start(*SCHEDULER, *about)
        deadline = monotonic() + PATIENCE
        while not self._file.exists() or not self._file.read_text():
            assert monotonic() < deadline and self.scheduler.poll() is None
            sleep(0.05)
        self.address: str = json.loads(self._file.read_text())["address"]
        self.workers = [
            self._start(*WORKER, "--no-nanny", "--local-directory", str(folder / f"w{n}"), *about)
            for n in range(workers)
        ]
        if workers:
            self._wait_for(workers)

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        return subprocess.Popen(  # noqa: S603 - our own interpreter
            [sys.executable, *words],
            cwd=self._folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def _wait_for(self, workers: int) -> None:
        from distributed import Client

        with Client(self.address, set_as_default=False) as client:  # type: ignore[no-untyped-call]
            client.wait_for_workers(workers, PATIENCE)

    def end(self) -> None:
        """End the child processes."""
        for process in (*self.workers, self.scheduler):
            process.kill()  # they hold nothing worth saving
            process.wait()


@pytest.fixture(scope="module")
def two_workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A cluster with two workers."""
    made = Cluster(tmp_path_factory.mktemp("cluster"), 2)
    yield made
    made.end()


def sweep(groups: int = 6) -> Sweep:
    settings = {"activity": "bingo", "users": 2}
    return Sweep("persuading", play, settings, [(9000 + at, 1) for at in range(groups)])


@pytest.mark.slow
def test_a_cluster_gives_the_same_results_as_this_machine(
    two_workers: Cluster, tmp_path: Path
) -> None:
    told: list[int] = []
    there = Where(
        tmp_path, cluster=two_workers.address, tell=lambda name, done, total: told.append(done)
    )
    here = sweep().run(Where(jobs=1))
    assert sweep().run(there) == here
    assert told == list(range(7))
    told.clear()
    assert sweep(8).run(there) == sweep(8).run(Where(jobs=1))
    assert told[0] == 6, "what this machine kept is not done again"
    assert all(p.poll() is None for p in (two_workers.scheduler, *two_workers.workers))


@pytest.mark.slow
def test_the_command_line_works_there(two_workers: Cluster, tmp_path: Path) -> None:
    words = ["experiment", "2", "--people", "4", "--json", "--data", str(tmp_path / "there")]
    done = subprocess.run(  # noqa: S603 - our own interpreter
        [sys.executable, "-c", "from tangy_tui.cli import main; main()", *words,
         "--dask", two_workers.address],
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(done.stdout)["experiment"] == 2


def test_workers_with_other_code_are_refused(
    two_workers: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cluster, "versions_there", lambda client: {"a worker": "other"})
    with pytest.raises(TangyError, match="do not have this version"):
        sweep().run(Where(cluster=two_workers.address))


@pytest.mark.slow
def test_a_cluster_without_workers_is_reported(tmp_path: Path) -> None:
    empty = Cluster(tmp_path, 0)
    try:
        with pytest.raises(TangyError, match="has no workers yet"):
            sweep().run(Where(cluster=empty.address))
    finally:
        empty.end()


@pytest.mark.slow
def test_a_lost_cluster_is_reported_and_its_results_kept(tmp_path: Path) -> None:
    short_lived = Cluster(tmp_path, 1)
    data = tmp_path / "data"

    def tell(name: str, done: int, total: int) -> None:
        if done == 2:
            short_lived.scheduler.kill()
            short_lived.workers[0].kill()

    try:
        with pytest.raises(TangyError, match="the cluster was lost"):
            sweep(200).run(Where(data, cluster=short_lived.address, tell=tell))
    finally:
        short_lived.end()
    told: list[int] = []
    sweep(3).run(Where(data, 1, tell=lambda name, done, total: told.append(done)))
    assert told[0] >= 2


@pytest.mark.slow
def test_a_missing_scheduler_is_reported_within_seconds(
    tangy_in_process: Callable[..., subprocess.CompletedProcess[str]],
) -> None:
    begun = monotonic()
    done = tangy_in_process("experiment", "2", "--people", "4", "--dask", "tcp://127.0.0.1:9")
    assert monotonic() - begun < 15
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.count("\n") == 1
    assert "no Dask scheduler answers there" in done.stderr


@pytest.mark.slow
def test_missing_dask_is_reported_with_the_extra_to_install(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(TangyError, match=r"tangy\[cluster\]"):
        sweep().run(Where(cluster="tcp://127.0.0.1:8786"))


@pytest.fixture
def tangy_in_process(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run the program as another process (`tangy` is its path in this folder)."""

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(  # noqa: S603 - our own interpreter
            [sys.executable, "-c", "from tangy_tui.cli import main; main()", *words,
             "--data", str(tmp_path)],
            capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip

    return run
