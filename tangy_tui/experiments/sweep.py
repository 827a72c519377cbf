"""A sweep: independent pieces of work on all cores or on a cluster, each stored when done.

A piece is a function of settings and one case, and deterministic. Each result is a line in a file
of the data folder, so an interrupted sweep resumes where it stopped, and neither the number of jobs
nor the order of completion changes the results.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeAlias

from tangy_profiles.errors import TangyError
from tangy_profiles.reading import plain
from tangy_tui.experiments.provenance import code_digest, digest_of

Settings: TypeAlias = Mapping[str, Any]
Case: TypeAlias = Sequence[Any]
"""The case of a piece, as JSON values, such as ("guided", 4, 17): kind of games, people, seed."""

Piece: TypeAlias = Callable[[Settings, Case], Any]
"""A function at module level that returns JSON; it uses neither the clock nor unseeded chance."""

Tell: TypeAlias = Callable[[str, int, int], None]
"""Called with the name of the sweep, the number of finished pieces, and of all pieces."""


@dataclass(frozen=True)
class Where:
    """Where sweeps run, and where their results are stored.

    `jobs`: processes on this machine (-1: one per core). `cluster`: the address of a Dask scheduler
    to use instead. `folder`: where to store results (None: nowhere). `fresh`: discard earlier
    results.
    """

    folder: Path | None = None
    jobs: int = -1
    cluster: str | None = None
    fresh: bool = False
    tell: Tell = field(default=lambda name, done, total: None)


@dataclass(frozen=True)
class Sweep:
    """A named function, the settings that all its pieces share, and its cases."""

    name: str
    piece: Piece
    settings: Settings
    cases: Sequence[Case]

    @property
    def digest(self) -> str:
        """The digest of the settings and the code, without the cases."""
        return digest_of([self.name, dict(self.settings), code_digest()])

    def run(self, where: Where) -> list[Any]:
        """Return the results in the order of the cases.

        Raises:
            TangyError: the folder is not writable, or the cluster not reachable.
        """
        kept = StoredResults(
            where.folder, f"{self.name}-{self.digest[:12]}.jsonl", fresh=where.fresh
        )
        done = {
            key: kept.results[key] for case in self.cases if (key := _key(case)) in kept.results
        }
        left = {key: case for case in self.cases if (key := _key(case)) not in done}
        total = len(done) + len(left)
        where.tell(self.name, len(done), total)
        for key, result in _work(self, list(left.values()), where):
            kept.add(key, result)
            done[key] = result
            where.tell(self.name, len(done), total)
        return [done[_key(case)] for case in self.cases]


class StoredResults:
    """The stored results of a sweep, one JSON line each.

    A line is written at once; a line truncated by a kill or a full disk is ignored, and the next
    one starts on a new line.
    """

    def __init__(self, folder: Path | None, name: str, *, fresh: bool = False) -> None:
        """Read the stored results.

        Raises:
            TangyError: the file cannot be read or written.
        """
        self.path = None if folder is None else folder / "experiments" / name
        self.results: dict[str, Any] = {}
        if self.path is None:
            return
        try:
            if folder is not None and not folder.exists():
                folder.mkdir(parents=True)
                folder.chmod(0o700)  # the mode of a log's folder
            self.path.parent.mkdir(exist_ok=True)
            if fresh:
                self.path.unlink(missing_ok=True)
            data = self.path.read_bytes() if self.path.exists() else b""
            if data and not data.endswith(b"\n"):
                _append(self.path, b"\n")
        except OSError as error:
            raise _unusable(self.path, error) from None
        for line in data.splitlines():
            try:
                case, result = json.loads(line)
            except ValueError:
                continue
            self.results[_key(case)] = result

    def add(self, key: str, result: Any) -> None:
        """Store a result.

        Raises:
            TangyError: the file cannot be written.
        """
        if self.path is not None:
            line = f"[{key},{json.dumps(result, ensure_ascii=False, separators=(',', ':'))}]\n"
            try:
                _append(self.path, line.encode())
            except OSError as error:
                raise _unusable(self.path, error) from None


def _append(path: Path, data: bytes) -> None:
    file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o600)
    try:
        os.write(file, data)
    finally:
        os.close(file)


def _unusable(path: Path, error: OSError) -> TangyError:
    return TangyError(plain(f"{path}: cannot be used ({error.strerror}); choose another --data."))


def _key(case: Case) -> str:
    return json.dumps(list(case), ensure_ascii=False, separators=(",", ":"))


def _work(sweep: Sweep, cases: list[Case], where: Where) -> Iterator[tuple[str, Any]]:
    """Yield the results of cases as they finish, locally or on a cluster."""
    if not cases:
        return
    if where.cluster is not None:
        from tangy_tui.experiments.cluster import on_cluster

        results = on_cluster(where.cluster, sweep.piece, sweep.settings, cases)
    elif where.jobs == 1 or len(cases) == 1:
        results = ((index, sweep.piece(sweep.settings, case)) for index, case in enumerate(cases))
    else:
        results = _on_cores(where.jobs, sweep, cases)
    for index, result in results:
        # Through JSON, so that new results equal stored ones.
        yield _key(cases[index]), json.loads(json.dumps(result))


def _on_cores(jobs: int, sweep: Sweep, cases: list[Case]) -> Iterator[tuple[int, Any]]:
    from joblib import Parallel, delayed

    parallel = Parallel(n_jobs=jobs, return_as="generator_unordered", batch_size=1)
    yield from parallel(
        delayed(_one)(os.getpid(), index, sweep.piece, sweep.settings, case)
        for index, case in enumerate(cases)
    )


def _one(of: int, index: int, piece: Piece, settings: Settings, case: Case) -> tuple[int, Any]:
    """Do one piece of work for the process `of`, which may be this one."""
    import signal

    if os.getpid() != of:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # only the parent handles Ctrl-C
    return index, piece(settings, case)
