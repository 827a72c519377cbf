"""The bench: a process in which the devices of a robot and the people round it are simulated.

The robot process speaks to its devices over their own wires. Here is only what somebody at the
bench would do by hand: deal cards, bring a fault about, lift it, and look how things really are.
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
        cancellation.starts("bench")
        command = [*CHILD, "--seed", str(seed), "--room", room]
        command += [f"--person={id}={name}" for id, name in people.items()]
        command += ["--activity", activity, "--robot", robot, *(["--stepped"] if stepped else [])]
        try:
            self._worker = WorkerProcess(command, read=_answer, lost=_ended, log=log)
        except WorkerError as error:
            raise BenchError(f"The bench cannot be started ({error}).") from None
        cancellation.register(self._worker.kill)  # there is nothing in it to be put in order
        try:
            self.wires = _wires(self._await(self._worker.first)["ready"])
        except (KeyError, TypeError, ValueError, BenchError):
            self.close()
            cancellation.check()
            how = f" ({self._worker.how})" if self._worker.how else ""
            where = f": see {log}" if log is not None else ""
            raise BenchError(f"The bench does not begin{how}{where}.") from None

    def do(self, do: str, **what: Any) -> dict[str, Any]:
        """Let it do something, and return its answer.

        Raises:
            BenchError: it cannot, or it has ended.
        """
        return self._await(self._worker.ask({"do": do, **what}))

    def close(self) -> None:
        """End it."""
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
        BenchError: it could not do it.
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
