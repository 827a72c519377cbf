"""Child processes that speak JSON lines: every failure is reported and bounded in time."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from concurrent.futures import TimeoutError as TooLate
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from typing import Any

import cv2
import numpy as np
import pytest

from tangy_hw.drivers import camera_child, chest_child
from tangy_hw.drivers.camera import Camera
from tangy_hw.drivers.camera_source import CameraSource, find_camera
from tangy_hw.drivers.chest import WebChestScreen
from tangy_hw.drivers.chest_pairing import Pairing
from tangy_hw.worker_process import WorkerError, WorkerProcess, cpu_seconds
from tangy_profiles.codec import encode
from tangy_profiles.worker_lines import LONGEST_LINE
from tangy_tui.app import device_simulator
from tangy_tui.speech import recogniser
from tests.hw.waiting import until
from tests.support.processes import runs

PATIENCE = 30.0
AT_ONCE = 2.0
DEEP = b"[" * 100_000
GARBAGE = (b"hello", b"\xff\xfe", b"[1, 2]", b'"a"', DEEP, b'{"a": ' + DEEP, b"", b"{}")
PICTURE = {"text": "", "number": "", "before": [], "asks": ""}

ECHO = """
import os, signal, sys, time
from tangy_profiles.worker_lines import AnswerWriter, requests
answers = AnswerWriter()
print("noise on standard output")
for asked in requests(answers.refuse):
    match asked:
        case {"say": str(text)}: answers._pipe.write(text.encode()); answers._pipe.flush()
        case {"flood": int(size)}: answers._pipe.write(b"x" * size + b"\\n"); answers._pipe.flush()
        case {"hang": True}: signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)
        case {"die": int(status)}: os._exit(status)
        case {"deaf": True}: os.close(0); answers._pipe.close(); os.close(1); time.sleep(60)
        case {"after": int(size)}: answers.write({**asked, "bytes": size}, b"A" * size)
        case _: answers.write(asked)
"""


@pytest.fixture
def echo() -> Iterator[Callable[..., WorkerProcess]]:
    """Child processes that echo their lines, or misbehave on request."""
    made: list[WorkerProcess] = []

    def one(**how: Any) -> WorkerProcess:
        made.append(WorkerProcess((sys.executable, "-c", ECHO), **how))
        return made[-1]

    yield one
    for worker in made:
        worker.stop(0)
        assert worker.pid is None
        assert not any(thread.is_alive() for thread in worker.threads)


def answer_of(asked: Future[Any]) -> Any:
    return asked.result(PATIENCE)


Echo = Callable[..., WorkerProcess]


class TestSupervisor:
    def test_answers_are_matched_by_id_in_any_order(self, echo: Echo) -> None:
        heard: list[tuple[dict[str, Any], bytes]] = []
        worker = echo(hear=lambda said, after: heard.append((said, after)))
        first, second = worker.ask({"number": 1}), worker.ask({"after": 1 << 20})
        assert answer_of(second)["bytes"] == 1 << 20
        assert answer_of(first) == {"id": 1, "number": 1}
        assert heard[1][1] == b"A" * (1 << 20)

    def test_a_child_leads_its_own_session_and_process_group(self, echo: Echo) -> None:
        worker = echo()
        assert worker.pid is not None
        assert os.getsid(worker.pid) == os.getpgid(worker.pid) == worker.pid

    def test_a_late_answer_is_dropped(self, echo: Echo) -> None:
        worker = echo()
        asked = worker.ask({"say": ""})
        with pytest.raises(TooLate):
            asked.result(0.05)
        asked.cancel()
        assert worker.asked.keys() == {0}
        worker.tell({"id": 1, "late": True})
        assert answer_of(worker.ask({"next": 1}))["next"] == 1

    def test_the_reader_of_an_answer_may_raise(self, echo: Echo) -> None:
        def read(said: dict[str, Any]) -> Any:
            if "failed" in said:
                raise LookupError(said["failed"])
            return said["done"]

        worker = echo(read=read)
        assert answer_of(worker.ask({"done": 7})) == 7
        with pytest.raises(LookupError, match="no"):
            answer_of(worker.ask({"failed": "no"}))
        with pytest.raises(KeyError):
            answer_of(worker.ask({}))

    @pytest.mark.parametrize(
        "says", ["hello\n", "[7]\n", '"a"\n', "[" * 100_000 + "\n", '{"bytes": -1}\n', '{"bytes":']
    )
    def test_garbage_ends_the_child_and_its_pending_requests(self, echo: Echo, says: str) -> None:
        worker = echo()
        asked = worker.ask({"say": says})
        worker.tell({"die": 0}) if says.endswith(":") else None
        with pytest.raises(WorkerError):
            answer_of(asked)
        assert worker.pid is None
        with pytest.raises(WorkerError):
            answer_of(worker.ask({"after": 1}))
        assert worker.over.result(PATIENCE) == worker.how != ""

    @pytest.mark.parametrize("asks", [{"say": "hello\n"}, {"flood": 3 << 20}, {"say": "[7]\n"}])
    def test_garbage_from_a_forgiving_child_is_ignored(
        self, echo: Echo, asks: dict[str, Any]
    ) -> None:
        worker = echo(forgiving=True, longest=1 << 20)
        worker.tell(asks)
        assert answer_of(worker.ask({"still": "there"}))["still"] == "there"

    def test_an_endless_line_ends_the_child(self, echo: Echo) -> None:
        worker = echo(longest=1 << 20)
        with pytest.raises(WorkerError, match="signal 9"):
            answer_of(worker.ask({"flood": 3 << 20}))

    @pytest.mark.parametrize(("die", "how"), [({"die": 3}, "status 3"), ({"deaf": True}, "signal")])
    def test_the_end_of_a_child_is_reported_with_its_status(
        self, echo: Echo, die: dict[str, Any], how: str, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr("tangy_hw.worker_process.LINGERS_SECONDS", 0.1)
        told: list[str] = []
        worker = echo(ended=told.append, lost=LookupError)
        asked = [worker.ask({"say": ""}), worker.ask(die)]
        for one in [*asked, worker.first]:
            with pytest.raises(LookupError, match=how):
                answer_of(one)
        assert worker.over.result(PATIENCE).startswith(how)
        assert told == [worker.how]
        assert worker.tell({"too": "late"}) is None

    def test_a_child_that_cannot_start_raises_the_reason(self, tmp_path: Path) -> None:
        with pytest.raises(WorkerError, match="No such file"):
            WorkerProcess((str(tmp_path / "none"),))

    def test_a_hanging_child_is_killed_after_the_timeout(self, echo: Echo) -> None:
        worker = echo()
        worker.tell({"hang": True})
        written = worker.tell("x" * (1 << 20))  # more than its pipe holds
        assert written is not None
        with pytest.raises(TooLate):
            written.result(0.1)
        began = time.monotonic()
        worker.stop(0.2)
        assert time.monotonic() - began < AT_ONCE
        assert worker.how == "signal 9" and written.result(PATIENCE) is None

    def test_requests_sent_before_the_end_are_still_answered(self, echo: Echo) -> None:
        worker = echo()
        asked = [worker.ask({"number": number}) for number in range(100)]
        worker.stop(PATIENCE)
        assert [answer_of(one)["number"] for one in asked] == list(range(100))
        assert worker.how == "status 0"

    async def test_callbacks_run_in_the_given_loop(self, echo: Echo) -> None:
        threads: list[int] = []
        loop = asyncio.get_running_loop()
        worker = echo(
            hear=lambda *_: threads.append(threading.get_ident()),
            ended=lambda _: threads.append(threading.get_ident()),
            loop=loop,
        )
        async with asyncio.timeout(PATIENCE):
            await asyncio.wrap_future(worker.ask({"hello": 1}))
            await worker.stopped(PATIENCE)
        assert threads == [threading.get_ident()] * 2
        assert worker.how == "status 0"

    async def test_a_cancelled_stop_kills_the_child(self, echo: Echo) -> None:
        worker = echo(loop=asyncio.get_running_loop())
        worker.tell({"hang": True})
        stopping = asyncio.create_task(worker.stopped(PATIENCE))
        await asyncio.sleep(0)
        stopping.cancel()
        await until(lambda: worker.how == "signal 9")

    def test_the_log_takes_standard_output_and_is_optional(
        self, echo: Echo, tmp_path: Path
    ) -> None:
        for log in (tmp_path / "log", tmp_path / "none" / "log"):
            worker = echo(log=log)
            assert answer_of(worker.ask({"x": 1}))["x"] == 1
            worker.stop(PATIENCE)
        assert (tmp_path / "log").read_text() == "noise on standard output\n"


@dataclass(frozen=True)
class Child:
    """One of the child processes: its first lines, a request, and the answer."""

    command: Sequence[str]
    begins: Sequence[Mapping[str, Any]]
    asks: Mapping[str, Any]
    answers: str
    """A key of the answer."""


@pytest.fixture(params=["camera", "chest", "speech", "device simulator"])
def child(request: pytest.FixtureRequest, tmp_path: Path) -> Child:
    """Each of the children in turn."""
    module = "-P", "-m"
    if request.param == "speech":
        return Child(recogniser.WORKER, [], {"id": 8, "pieces": ""}, "found")
    if request.param == "device simulator":
        bench = (*device_simulator.CHILD, "--activity", "bingo", "--stepped")
        return Child(bench, [], {"id": 8, "do": "truth"}, "truth")
    if request.param == "camera":
        cv2.imwrite(str(tmp_path / "a.png"), np.zeros((4, 4, 3), np.uint8))
        source = encode(find_camera(str(tmp_path), each=True))
        begins = {"source": source, "first": 0}
        command = (sys.executable, *module, camera_child.__name__)
        return Child(command, [begins], {"frame": 3, "after": -1}, "frame")
    place = {"host": "127.0.0.1", "port": 0, "names": [], "pairing": Pairing().to_json()}
    command = (sys.executable, *module, chest_child.__name__)
    return Child(command, [place], {"show": 1, "picture": PICTURE}, "port")


class TestChildren:
    @pytest.mark.slow
    def test_each_invalid_line_is_answered_with_an_error(self, child: Child) -> None:
        said: Queue[dict[str, Any]] = Queue()
        worker = WorkerProcess(child.command, hear=lambda told, _: said.put(told))

        def heard(*keys: str) -> dict[str, Any]:
            while True:
                told = said.get(timeout=PATIENCE)
                if any(key in told for key in keys):
                    return told

        try:
            for before in (True, False):
                assert worker.process.stdin is not None
                for bad in GARBAGE:
                    os.write(worker.process.stdin.fileno(), bad + b"\n")
                    assert heard("failed", "error").get("id") is None
                worker.tell("x" * (2 * LONGEST_LINE))
                assert "too long" in str(heard("failed", "error"))
                if before:
                    for line in child.begins:
                        written = worker.tell(line)
                        assert written is not None
                        written.result(PATIENCE)  # else the next line would come between its parts
            worker.tell(child.asks)
            assert heard(child.answers)
        finally:
            worker.stop(PATIENCE)
        assert worker.how == "status 0"
        assert not [told for told in said.queue if "failed" in told]

    @pytest.mark.slow
    def test_a_child_logs_its_work(self, child: Child, tmp_path: Path) -> None:
        worker = WorkerProcess(child.command, log=tmp_path / "log")
        for line in [*child.begins, child.asks]:
            worker.tell(line)
        worker.stop(PATIENCE)
        assert " INFO    tangy_" in (tmp_path / "log").read_text()

    def test_a_child_ends_when_its_program_is_killed(self, child: Child) -> None:
        program = (
            "import json, sys, time\n"
            "from tangy_hw.worker_process import WorkerProcess\n"
            "worker = WorkerProcess(json.loads(sys.argv[1]))\n"
            "for line in json.loads(sys.argv[2]): worker.tell(line)\n"
            "print(worker.pid, flush=True)\n"
            "time.sleep(60)\n"
        )
        told = json.dumps(list(child.command)), json.dumps([*child.begins, child.asks])
        with subprocess.Popen(  # noqa: S603 - our own interpreter
            [sys.executable, "-c", program, *told], stdout=subprocess.PIPE
        ) as parent:
            assert parent.stdout is not None
            pid = int(parent.stdout.readline())
            assert runs(pid)
            parent.kill()
        ends = time.monotonic() + PATIENCE
        while runs(pid):
            assert time.monotonic() < ends
            time.sleep(0.01)


SCRIPTS = {
    "dies": "import sys; sys.exit(3)",
    "says garbage": "print('hello', flush=True); import time; time.sleep(60)",
    "says no end": "print('x' * 9_000_000, flush=True); import time; time.sleep(60)",
    "is deaf": "import os, signal, time; signal.signal(15, signal.SIG_IGN); time.sleep(60)",
}
"""Unreliable children."""


@pytest.fixture(params=["camera", "chest"])
def owner(request: pytest.FixtureRequest) -> Any:
    """Each owner of a child in turn."""
    if request.param == "camera":
        return Camera(CameraSource("none", "file", "/none"))
    return WebChestScreen(port=0)


def why(owner: Any) -> str:
    return str(owner.sight.why if isinstance(owner, Camera) else owner.why)


class TestOwners:
    """The owner of a child reports its end, and starts another."""

    @pytest.mark.slow
    @pytest.mark.parametrize(
        ("does", "told"),
        [("dies", "status 3"), ("says garbage", "signal 9"), ("says no end", "signal 9")],
    )
    async def test_an_unreliable_child_is_reported_and_replaced(
        self, owner: Any, does: str, told: str, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        module = sys.modules[type(owner).__module__]
        monkeypatch.setattr(module, "CHILD", (sys.executable, "-c", SCRIPTS[does]))
        monkeypatch.setattr(module, "START_SECONDS", PATIENCE)
        starting = asyncio.create_task(owner.start())
        await until(lambda: told in why(owner), PATIENCE)
        monkeypatch.setattr(module, "CHILD", (sys.executable, "-c", SCRIPTS["is deaf"]))
        await until(lambda: owner.pid is not None, PATIENCE)
        await self.closes(owner, starting)

    async def closes(self, owner: Any, starting: asyncio.Task[None]) -> None:
        pid = owner.pid
        starting.cancel()
        await asyncio.wait({starting})
        began = time.monotonic()
        await owner.close()
        assert time.monotonic() - began < AT_ONCE
        assert not runs(pid)

    async def test_a_killed_child_is_reported_and_replaced(
        self, owner: Any, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        module = sys.modules[type(owner).__module__]
        monkeypatch.setattr(module, "CHILD", (sys.executable, "-c", SCRIPTS["is deaf"]))
        starting = asyncio.create_task(owner.start())
        await until(lambda: owner.pid is not None, PATIENCE)
        first = owner.pid
        os.kill(first, signal.SIGKILL)
        await until(lambda: "signal 9" in why(owner), PATIENCE)
        await until(lambda: owner.pid not in (None, first), PATIENCE)
        await self.closes(owner, starting)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell")
async def test_the_cpu_time_of_a_process_includes_its_children() -> None:
    busy = "import subprocess, sys; subprocess.run([sys.executable, '-c', 'while True: pass'])"
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", busy, start_new_session=True
    )
    try:
        await until(lambda: (cpu_seconds(process.pid) or 0.0) > 1.0)
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        await process.wait()
