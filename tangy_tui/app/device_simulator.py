"""The bench: a process that simulates the devices of a robot and the people around it.

The robot process talks to the devices over their own protocols. This module only does what a
person at the bench would do by hand: deal cards, inject and lift faults, look up the truth.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from concurrent.futures import Future
from concurrent.futures import TimeoutError as TooLate
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tangy_hw.cancellation import Cancellation
from tangy_hw.worker_process import WorkerError, WorkerProcess
from tangy_profiles.errors import TangyError
from tangy_sim.servers.link_relay import LinkQuality

CHILD = (sys.executable, "-P", "-m", "tangy_sim.device_simulator")
END_SECONDS = 3.0
ANSWER_SECONDS = 60.0  # for one command; an idle machine needs much less


class BenchError(TangyError):
    """The bench cannot be started, or a command failed."""


@dataclass(frozen=True)
class Wires:
    """The addresses of the simulated devices.

    `corners` are those of the table in the infrared picture (px); `faces` maps the id of each
    person to the number of their drawn face.
    """

    rosbridge: str
    scip: str
    head: str
    infrared: str
    corners: tuple[tuple[float, float], ...]
    faces: dict[str, int]


class DeviceSimulator:
    """A running bench; `do` commands, then `close` it."""

    def __init__(
        self,
        *,
        seed: int,
        people: Mapping[str, str],
        stepped: bool,
        activity: str,
        robot: str,
        room: str = "common-room",
        link: LinkQuality | None = None,
        log: Path | None = None,
        cancellation: Cancellation | None = None,
    ) -> None:
        """Start a bench.

        Args:
            seed: determines the people and the games.
            people: who sits there, in this order: names by id.
            stepped: simulated time advances only when the robot process steps it.
            activity: the activity's name, or its file.
            robot: the name of the simulated robot's profile.
            room: the name of the room's profile.
            link: the quality of the robot's link to its devices, unless the bench is stepped.
            log: file for the errors of the process.
            cancellation: cancels the start.

        Raises:
            BenchError: the process does not start.
            Cancelled: the start was cancelled.
        """
        cancellation = cancellation or Cancellation()
        cancellation.check()
        cancellation.starts("bench")
        command = [*CHILD, "--seed", str(seed), "--room", room]
        command += [f"--person={id}={name}" for id, name in people.items()]
        command += ["--activity", activity, "--robot", robot, *(["--stepped"] if stepped else [])]
        if link is not None:
            command += ["--link-delay", str(link.delay), "--link-loss", str(link.loss)]
        try:
            self._worker = WorkerProcess(command, read=_answer, lost=_ended, log=log)
        except WorkerError as error:
            raise BenchError(f"The bench cannot be started ({error}).") from None
        cancellation.register(self._worker.kill)  # it holds no state to save
        try:
            self.wires = _wires(self._await(self._worker.first)["ready"])
        except (KeyError, TypeError, ValueError, BenchError):
            self.close()
            cancellation.check()
            how = f" ({self._worker.how})" if self._worker.how else ""
            where = f": see {log}" if log is not None else ""
            raise BenchError(f"The bench does not begin{how}{where}.") from None

    def do(self, do: str, **what: Any) -> dict[str, Any]:
        """Carry out a command, and return its answer.

        Raises:
            BenchError: the command failed, or the process has ended.
        """
        return self._await(self._worker.ask({"do": do, **what}))

    def close(self) -> None:
        """Stop the process."""
        self._worker.stop(END_SECONDS)

    @staticmethod
    def _await(asked: Future[dict[str, Any]]) -> dict[str, Any]:
        try:
            return asked.result(ANSWER_SECONDS)
        except TooLate:
            asked.cancel()
            raise BenchError("The bench does not answer.") from None


def _ended(how: str) -> BenchError:
    return BenchError(f"The bench has ended ({how}).")


def _answer(said: dict[str, Any]) -> dict[str, Any]:
    """Return an answer.

    Raises:
        BenchError: the command failed.
    """
    if "failed" in said:
        raise BenchError(str(said["failed"]))
    return said


def _wires(ready: Mapping[str, Any]) -> Wires:
    return Wires(
        ready["rosbridge"],
        ready["scip"],
        ready["head"],
        ready["infrared"],
        tuple((float(x), float(y)) for x, y in ready["corners"]),
        {str(person): int(number) for person, number in ready["faces"].items()},
    )
