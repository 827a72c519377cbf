"""The bench: a process in which the devices of a robot and the people round it are simulated.

The robot process speaks to its devices over their own wires. Here is only what somebody at the
bench would do by hand: deal cards, bring a fault about, lift it, and look how things really are.
"""

from __future__ import annotations

import json
import select
import subprocess
import sys
import threading
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from tangy_hw.cancellation import Cancellation
from tangy_profiles.errors import TangyError
from tangy_profiles.worker_log import open_log

CHILD = (sys.executable, "-P", "-m", "tangy_sim.device_simulator")
END_SECONDS = 3.0
ANSWER_SECONDS = 60.0  # for what it does at once; much less than that on a machine at rest


class BenchError(TangyError):
    """The bench cannot be had, or does not do what it was told."""


@dataclass(frozen=True)
class Wires:
    """Where the devices of the bench are, as addresses.

    `corners` are those of the table in the infrared picture; `faces` says which drawn person sits
    where, by id.
    """

    rosbridge: str
    scip: str
    head: str
    infrared: str
    corners: tuple[tuple[float, float], ...]
    faces: dict[str, int]


class DeviceSimulator:
    """A bench that runs. `do` things at it, and `close` it."""

    def __init__(
        self,
        *,
        seed: int,
        people: Mapping[str, str],
        stepped: bool,
        activity: str,
        robot: str,
        room: str = "common-room",
        log: Path | None = None,
        cancellation: Cancellation | None = None,
    ) -> None:
        """Start a bench.

        Args:
            seed: another seed, other people and games.
            people: who sits there, in this order: names by id.
            stepped: its time passes only when the robot lets it.
            activity: what is played: its name, or its file.
            robot: whose devices are simulated: the name of its profile.
            room: the name of its profile.
            log: where what goes wrong in it is written.
            cancellation: of the opening that it is part of.

        Raises:
            BenchError: it does not begin.
            Cancelled: it was called off.
        """
        cancellation = cancellation or Cancellation()
        cancellation.check()
        command = [*CHILD, "--seed", str(seed), "--room", room]
        command += [f"--person={id}={name}" for id, name in people.items()]
        command += ["--activity", activity, "--robot", robot, *(["--stepped"] if stepped else [])]
        err: IO[bytes] | int = subprocess.DEVNULL
        if log is not None:
            with suppress(OSError):
                err = open_log(log)
        self._process = subprocess.Popen(  # noqa: S603 - it is our own program
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=err,
            start_new_session=True,
        )
        if not isinstance(err, int):
            err.close()
        cancellation.register(self._process.kill)  # there is nothing in it to be put in order
        self._lock = threading.Lock()
        try:
            ready = self._read()["ready"]
            self.wires = Wires(
                ready["rosbridge"],
                ready["scip"],
                ready["head"],
                ready["infrared"],
                tuple((float(x), float(y)) for x, y in ready["corners"]),
                {str(person): int(number) for person, number in ready["faces"].items()},
            )
        except (KeyError, TypeError, BenchError):
            self.close()
            cancellation.check()
            where = f": see {log}" if log is not None else ""
            raise BenchError(f"The bench does not begin{where}.") from None

    def do(self, do: str, **what: Any) -> dict[str, Any]:
        """Let it do something, and return its answer.

        Raises:
            BenchError: it cannot, or it has ended.
        """
        with self._lock:
            try:
                assert self._process.stdin is not None  # noqa: S101 - it was asked for
                self._process.stdin.write(json.dumps({"do": do, **what}).encode() + b"\n")
                self._process.stdin.flush()
            except (OSError, ValueError):
                raise BenchError("The bench has ended.") from None
            answer = self._read()
        if "failed" in answer:
            raise BenchError(str(answer["failed"]))
        return answer

    def close(self) -> None:
        """End it."""
        with suppress(OSError):
            assert self._process.stdin is not None  # noqa: S101 - it was asked for
            self._process.stdin.close()
        try:
            self._process.wait(END_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()

    def _read(self) -> dict[str, Any]:
        assert self._process.stdout is not None  # noqa: S101 - it was asked for
        if not select.select([self._process.stdout], [], [], ANSWER_SECONDS)[0]:
            raise BenchError("The bench does not answer.")
        line = self._process.stdout.readline()
        try:
            answer = json.loads(line)
        except ValueError:
            raise BenchError("The bench has ended.") from None
        return dict(answer)
