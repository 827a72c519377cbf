"""The program's end of the link to the robot process, however that process misbehaves."""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any, cast

import pytest

from tangy_hw.cancellation import Cancellation, Cancelled
from tangy_hw.device_protocols import DeviceError
from tangy_hw.robot_client import client
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_process.stop_latch import FAULT, STAFF, Preempted
from tangy_hw.robot_setup import RobotSetup
from tangy_hw.write_queue import WriteQueue

SETUP = RobotSetup("tangy", "bingo", ("user1",))
PIPE = 1 << 16  # bytes that a pipe holds
READY = "import sys, time; sys.stdin.readline(); print('{\"ready\": true}', flush=True); "
TELLS = """
import os
told = open(f'{path}/{os.getpid()}', 'w', 1)
for line in sys.stdin:
    if '"do"' in line:
        told.write(line)
"""
AT_ONCE = 0.5


def holds(condition: Callable[[], object], seconds: float = 5.0) -> bool:
    until = time.monotonic() + seconds
    while not condition() and time.monotonic() < until:
        time.sleep(0.005)
    return bool(condition())


def linked(monkeypatch: pytest.MonkeyPatch, does: str) -> RobotLink:
    monkeypatch.setattr(client, "CHILD", (sys.executable, "-c", READY + does))
    link = RobotLink(SETUP)
    link.start()
    return link


class Pipe:
    """A pipe that stays unread until `read`, and an outbox that writes to it."""

    def __init__(self) -> None:
        self.out, into = os.pipe()
        self.outbox = WriteQueue(os.fdopen(into, "wb"))
        self.thread = threading.Thread(target=self.outbox.run, daemon=True)
        self.thread.start()

    def read(self) -> list[str]:
        """Read all until its end."""
        self.outbox.close()
        with os.fdopen(self.out, "rb") as out:
            lines = out.read().decode().splitlines()
        self.thread.join()
        return lines


class TestOutbox:
    def test_lines_are_written_in_order_and_the_last_before_the_end(self) -> None:
        pipe = Pipe()
        lines = [f"line {number}" for number in range(100)]
        assert all(map(pipe.outbox.put, lines))
        assert pipe.read() == lines
        assert not pipe.outbox.put("too late")

    def test_a_full_pipe_blocks_no_writer_and_drops_beats(self) -> None:
        pipe = Pipe()
        pipe.outbox.put("x" * 2 * PIPE)
        assert holds(lambda: pipe.outbox.writing)
        began = time.monotonic()
        for number in range(1000):
            pipe.outbox.beat(f"beat {number}")
        assert pipe.outbox.put("stop")
        assert time.monotonic() - began < AT_ONCE
        assert pipe.read()[1:] == ["stop"]

    def test_a_beat_is_written_into_an_empty_queue(self) -> None:
        pipe = Pipe()
        pipe.outbox.beat("beat")
        assert holds(lambda: not pipe.outbox.lines)
        assert pipe.read() == ["beat"]

    def test_the_outbox_ends_without_a_reader(self) -> None:
        pipe = Pipe()
        os.close(pipe.out)
        pipe.outbox.put("to nobody")
        assert holds(lambda: not pipe.outbox.put("nor this"))
        pipe.thread.join(AT_ONCE)
        assert not pipe.thread.is_alive()


class TestHungProcess:
    def test_a_stop_to_a_hung_process_never_waits(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(client, "SILENT_SECONDS", 0.1)
        monkeypatch.setattr(client, "BEAT_SECONDS", 0.005)
        link = linked(monkeypatch, "time.sleep(60)")
        try:
            outbox = cast(Any, link.worker).outbox
            assert holds(lambda: link.silent)
            beaten: list[str] = []
            monkeypatch.setattr(outbox, "beat", beaten.append)
            link.tell("perform", text="x" * 2 * PIPE)  # its pipe is full
            assert holds(lambda: outbox.writing)
            began = time.monotonic()
            link.stop("enough")
            assert time.monotonic() - began < AT_ONCE
            assert [json.loads(line)["do"] for line, _ in outbox.lines] == ["stop"]
            time.sleep(0.1)
            assert len(beaten) <= 1  # it may have been on its way
        finally:
            began = time.monotonic()
            link.close()
        assert time.monotonic() - began < AT_ONCE
        assert link.pid is None and not link.beating.is_alive()


class TestEnd:
    @pytest.mark.slow
    def test_requests_to_an_ending_process_are_answered_once(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        for _ in range(3):
            link = linked(monkeypatch, "time.sleep(.1)")
            asked: list[Future[dict[str, Any]]] = []
            while not link.silent:
                asked.append(link.ask("spin"))
            asked.append(link.ask("spin"))
            for one in asked:
                with pytest.raises(Preempted, match="has ended"):
                    one.result(5)
            link.close()

    @pytest.mark.parametrize(
        ("does", "how"), [("sys.exit(3)", "status 3"), ("os.kill(os.getpid(), 9)", "signal 9")]
    )
    def test_a_process_that_ends_at_the_start_reports_its_status(
        self, monkeypatch: pytest.MonkeyPatch, does: str, how: str
    ) -> None:
        monkeypatch.setattr(client, "CHILD", (sys.executable, "-c", "import os, sys; " + does))
        link = RobotLink(SETUP)
        with pytest.raises(DeviceError, match=rf"has ended \({how}\)"):
            link.start()
        assert how in link.silent and link.pid is None
        link.close()

    def test_nonsense_lines_from_the_process_are_ignored(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        does = (
            "print('noise'); print('[' * 100_000); print('x' * 9_000_000); print('{\"beat\": 7}');"
            " line = sys.stdin.readline()\nwhile '\"do\"' not in line: line = sys.stdin.readline()"
            '\nprint(\'{"id": 1, "done": {"found": true}}\', flush=True); time.sleep(60)'
        )
        link = linked(monkeypatch, does)
        try:
            assert link.ask("spin").result(20) == {"found": True}
        finally:
            link.close()


SILENT = "import sys, time; sys.stdin.readline(); "
STUBBORN = "import signal, sys, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); "


class TestRestart:
    def test_a_new_process_is_stopped_by_all_who_stopped_the_one_before(
        self, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
    ) -> None:
        link = linked(monkeypatch, TELLS.replace("{path}", str(tmp_path)))

        def restarted(*by: str) -> bool:
            link.restart()
            link.tell("settle")
            path = tmp_path / str(link.pid)
            assert holds(lambda: "settle" in path.read_text())
            told = map(json.loads, path.read_text().splitlines())
            return [one["by"] for one in told if one["do"] == "stop"] == list(by)

        try:
            link.stop("staff stopped it")
            link.stop("laser-disconnected", by=FAULT)
            assert restarted(STAFF, FAULT)
            link.release(by=FAULT)
            assert restarted(STAFF)
            link.stop("base-failed", by=FAULT)
            link.release()
            assert restarted()
        finally:
            link.close()


class TestCalledOff:
    """A process that is still opening the robot ends when the opening is cancelled."""

    def opening(
        self, monkeypatch: pytest.MonkeyPatch, does: str
    ) -> tuple[RobotLink, Cancellation, Future[None]]:
        """Begin to open a robot that never answers, on a thread."""
        monkeypatch.setattr(client, "CHILD", (sys.executable, "-c", does))
        cancellation = Cancellation()
        link = RobotLink(SETUP, cancellation=cancellation)
        done: Future[None] = Future()

        def start() -> None:
            try:
                link.start()
            except BaseException as error:
                done.set_exception(error)
            else:
                done.set_result(None)
            finally:
                link.close()

        threading.Thread(target=start, daemon=True).start()
        return link, cancellation, done

    @pytest.mark.parametrize("does", [SILENT, STUBBORN], ids=["hears TERM", "hears nothing"])
    def test_cancelling_an_opening_ends_the_process(
        self, monkeypatch: pytest.MonkeyPatch, does: str
    ) -> None:
        monkeypatch.setattr(client, "CALLED_OFF_SECONDS", 0.2)
        link, cancellation, done = self.opening(monkeypatch, does + "time.sleep(60)")
        assert holds(lambda: link.pid is not None)
        worker = link.worker
        assert worker is not None
        cancellation.cancel()
        with pytest.raises(Cancelled):
            done.result(5)
        assert holds(lambda: worker.pid is None)

    def test_a_cancelled_opening_starts_no_process(self, monkeypatch: pytest.MonkeyPatch) -> None:
        started: list[object] = []
        monkeypatch.setattr("subprocess.Popen", lambda *a, **b: started.append(a))
        cancellation = Cancellation()
        cancellation.cancel()
        with pytest.raises(Cancelled):
            RobotLink(SETUP, cancellation=cancellation).start()
        assert started == []

    def test_a_closed_link_is_not_restarted(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """A recovery thread may be about to restart the process when the user quits."""
        link = linked(monkeypatch, "time.sleep(60)")
        link.close()
        with pytest.raises(DeviceError, match="switched off"):
            link.restart()
        assert link.pid is None

    def test_the_link_reports_which_part_is_starting(self, monkeypatch: pytest.MonkeyPatch) -> None:
        does = "import sys, time; " + "".join(
            f'print(\'{{"starts": "{part}"}}\'); ' for part in ("laser", "voice", "voice")
        )
        _, cancellation, done = self.opening(monkeypatch, does + "print('{}', flush=True)")
        done.result(20)
        assert cancellation.parts == ("program", "laser", "voice")
        cancellation.starts("voice", 1, 4)
        assert (cancellation.parts[-1], cancellation.done) == ("voice", (1, 4))

    def test_a_completed_opening_is_not_cancelled(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(client, "CHILD", (sys.executable, "-c", READY + "time.sleep(60)"))
        cancellation = Cancellation()
        link = RobotLink(SETUP, cancellation=cancellation)
        try:
            link.start()
            cancellation.complete()
            cancellation.cancel()
            assert link.pid is not None
        finally:
            link.close()
